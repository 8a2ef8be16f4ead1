"""Run inside FreeCAD with a window, by tools/demo: grinds the example tap as a macro would, plans its feeds and the force
that is set by hand, and writes document, pictures, report, program and figures to the folder BELTGRINDING_OUT.
"""

import json
import os
from pathlib import Path

import FreeCAD
import FreeCADGui
from beltgrinding.gui.scene.camera import look_at
from beltgrinding.objects import api
from beltgrinding.objects.plan import TIMING
from beltgrinding.objects.properties import from_job

LEAST_FORCE = "12 N"  # of the 25 N that its program was made for
TOWARDS = FreeCAD.Vector(0.75, -0.55, 0.45)  # where the eye is
OUT = Path(os.environ["BELTGRINDING_OUT"])


def say(text):
    print(f"demo: {text}", flush=True)


def ground(job, name):
    """Simulates the job, saves a picture of what is left, and says how much is good."""
    api.simulate(job, write_to=OUT / name)
    deviation = api.make_deviation(job)
    for part, _ in job.DesignFaces:
        part.ViewObject.Visibility = False  # it would hide what is cut below it
    for path in job.Document.findObjects(Label="tap_spout"):
        path.ViewObject.Visibility = False
    look_at(TOWARDS)
    view = FreeCADGui.ActiveDocument.ActiveView
    view.saveImage(str(OUT / f"{name}.png"), 1400, 1000, "White")
    low, high = deviation.Minimum.Value, deviation.Maximum.Value
    say(f"    {deviation.InTolerance:.1f} % in tolerance, {low:+.2f} to {high:+.2f} mm")


say("1 of 5: makes the tap and its program (tap.step, tap_spout.src)")
job = api.open_example(OUT, "tap")
say("2 of 5: plans feeds, and the force that is set by hand")
plan = api.make_plan(job, ForceMin=LEAST_FORCE, Check=False)
force = min(one for one in plan.NewForces if one >= 0.0)
say(f"    {len(plan.NewFeeds)} feeds; {force:.1f} N")
say("3 of 5: grinds it by its own program, in the robot's time")
own = {key.name: getattr(job, key.name) for key in TIMING}
from_job(job, TIMING, {"simulation": json.loads(plan.TimeLaw)})
ground(job, "before")
for name, value in own.items():  # as it was when it was planned
    setattr(job, name, value)
say("4 of 5: grinds it as planned")
api.apply_plan(plan)
ground(job, "after")
say("5 of 5: writes the program, the report and the document")
(OUT / "planned").mkdir(exist_ok=True)
api.write_plan(plan, OUT / "planned")
api.write_report(job, OUT / "report.html")
job.Document.saveAs(str(OUT / "tap.FCStd"))
