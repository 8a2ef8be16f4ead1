"""Run inside FreeCAD with a window, in a checkout of an older commit with its core: writes what the
workbench of that time wrote into the folder OUT. README.md says which commits, and how.
"""

import os
from pathlib import Path

import FreeCAD
import FreeCADGui as Gui
import Part
from beltgrinding.simulation import run as runs
from beltgrinding.objects import api

out = Path(os.environ["OUT"])
out.mkdir(parents=True, exist_ok=True)
os.chdir(out)
rows = [f"{x},6,3.9,0,1,0,0,20" for x in (3, 6, 9, 12, 15)]
Path("pass.csv").write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s\n" + "\n".join(rows) + "\n")

doc = FreeCAD.newDocument("old")
part = doc.addObject("Part::Feature", "Block")
part.Shape = Part.makeBox(18, 12, 4)
doc.recompute()
job = api.make_job(part, ["Face6"], Spacing="2 mm", ToleranceUpper="0.04 mm")
api.make_stock(job, Allowance="0.2 mm")
machine = api.make_belt_machine(job, WheelRadius="30 mm", WheelWidth="6 mm", Force="20 N")
program = api.import_program(job, "pass.csv")
program.Label = "pass"
program.Source = ""  # the place where this was made is nobody's concern
if hasattr(api, "make_belt"):
    job.LawCoefficient, job.WearModel, job.WearScale = 1e-4, "exponential", 5000.0
    api.make_belt(job, RemovedVolume=3.0)
if hasattr(api, "make_raster"):
    raster = api.make_raster(job, StepOver="4 mm")
    raster.Label = "raster"
    job.LawCoefficient = 3e-5  # it is ground twice
    job.Timing = "trapezoidal"
    job.PathAcceleration = 800
if hasattr(api, "make_section"):
    machine.Robot = "abb_irb1200_5_90"
    machine.BaseFromRobot = FreeCAD.Placement(FreeCAD.Vector(-500, 0, -300), FreeCAD.Rotation())
    machine.FlangeFromTcp = FreeCAD.Placement(FreeCAD.Vector(0, 0, 100), FreeCAD.Rotation())
doc.recompute()
recording = {}
simulation = api.simulate(job, write_to=out / "result")
if "recording" in runs.run.__code__.co_varnames:
    from beltgrinding.engine import core
    from beltgrinding.objects import job_inputs

    with job_inputs.scratch_folder() as folder:
        result = runs.run(job_inputs.to_data(job, folder), None, core.Recording())
    simulation = api.store_result(job, result, job_inputs.fingerprint(job))
deviation = api.make_deviation(job)
if hasattr(api, "make_section"):
    deviation.Bounds, deviation.Bands = "by tolerance", 3
    api.make_section(job, point=(0, 6, 0), normal=(0, 1, 0))
doc.recompute()
assert not simulation.OutOfDate and simulation.RemovedVolume.Value > 0.5, simulation.RemovedVolume
api.export_job(job, out / "job.json")
FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Document").SetBool("SaveThumbnail", False)
Gui.updateGui()
doc.saveAs(str(out / "old.FCStd"))
