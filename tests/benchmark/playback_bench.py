"""Run by tools/bench inside FreeCAD with a window: playback of a recording over 1,000,000 samples.

Writes Google Benchmark's JSON to BELTGRINDING_BENCH_OUT. Figures in ms, of the dock as a person uses it:

- scrub: the slider set to a random moment, until the heights and colours of that moment, the wheel and
  the chart's cursor are there (mean and largest of 40 jumps);
- scrub_drawn: the same with the frame that shows it;
- play: a picture of the playback at the real time's speed, with its frame;
- frame: a frame of the real window in which nothing has changed but the view.

Where there is no graphics card (llvmpipe), a frame's time is the rasteriser's.
"""

import json
import os
import tempfile
import time
from pathlib import Path

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import Part
from PySide import QtGui

import beltgrinding
from beltgrinding.engine import core
from beltgrinding.simulation import run as runs
from beltgrinding.gui.docks import playback_dock as playback
from beltgrinding.objects import api, job_inputs

SIDE, SPACING = 500.0, 0.5  # mm; a million samples
LANES = 20
JUMPS = 40
ANSWER = 300.0  # ms that a jump may take


def program(path):
    rows = ["x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"]
    for k in range(LANES):
        y = SIDE * (k + 0.5) / LANES
        for x in (5.0, SIDE - 5.0)[:: 1 if k % 2 == 0 else -1]:
            rows.append(f"{x},{y},10.5,0,1,0,0,50")
    path.write_text("\n".join(rows) + "\n")
    return path


def recorded():
    """A job with a recording of a million samples."""
    doc = FreeCAD.newDocument("playback")
    plate = doc.addObject("Part::Feature", "Plate")
    plate.Shape = Part.makeBox(SIDE, SIDE, 10)
    doc.recompute()
    job = beltgrinding.make_job(plate, ["Face6"], Spacing=SPACING, MaxTravel=1.0)
    beltgrinding.make_stock(job, Allowance=0.5)
    beltgrinding.make_belt_machine(
        job, WheelRadius=100, WheelWidth=40, Force="60 N", Compliance="elastic_foundation"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = beltgrinding.import_program(job, program(Path(folder, "lanes.csv")))
    with job_inputs.scratch_folder() as folder:
        data = job_inputs.to_data(job, folder)
        result = runs.run(data, None, core.Recording())
    api.store_result(job, result, job_inputs.fingerprint(job))
    path.ViewObject.Visibility = False
    return job


def took(work):
    begin = time.perf_counter()
    work()
    return 1000.0 * (time.perf_counter() - begin)


def draw():
    Gui.ActiveDocument.ActiveView.redraw()
    QtGui.QApplication.processEvents()


def main():
    Gui.getMainWindow().showMaximized()
    begin = time.perf_counter()
    job = recorded()
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewIsometric()
    view.fitAll()
    print(f"playback/recorded in {time.perf_counter() - begin:.0f} s")
    opening = took(lambda: playback.show(job))
    dock = Gui.getMainWindow().findChild(QtGui.QDockWidget, "BeltGrinding_PlaybackDock")
    scene = dock.scene
    view.fitAll()
    for _ in range(3):
        draw()
    width, height = view.getSize()
    recording = scene.recording
    print(
        f"playback/samples {recording.samples}, {recording.last} steps, {recording.bytes / 1e6:.0f} MB, "
        f"view {width} x {height}, own node {scene.field.own_node}"
    )
    random = np.random.default_rng(3)

    def jump():
        dock.slider.setValue(int(random.integers(playback.PARTS)))

    answers = [took(jump) for _ in range(JUMPS)]
    drawn = [took(lambda: (jump(), draw())) for _ in range(JUMPS)]
    dock.go(0.3 * scene.duration)
    steps = [
        took(lambda: (dock.go(scene.time + 0.001 * playback.TICK), draw())) for _ in range(JUMPS)
    ]
    frames = []
    turn = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 2)
    for _ in range(9):
        now = FreeCAD.Rotation(*view.getCameraOrientation().Q)
        frames.append(
            took(lambda: (view.setCameraOrientation(turn.multiply(now).Q), draw()))  # noqa: B023
        )
    figures = {
        "open": opening,
        "scrub": np.mean(answers),
        "scrub_largest": np.max(answers),
        "scrub_drawn": np.mean(drawn),
        "scrub_drawn_largest": np.max(drawn),
        "play": np.median(steps),
        "frame": np.median(frames),
    }
    for name, value in figures.items():
        print(f"playback/{name:20} {value:10.1f} ms")
    if figures["scrub_largest"] > ANSWER:
        print(f"playback/TOO SLOW: a jump must answer within {ANSWER:.0f} ms")
    benchmarks = [
        {"name": f"playback/{name}", "real_time": float(value), "time_unit": "ms"}
        for name, value in figures.items()
    ]
    Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
        json.dumps({"context": {}, "benchmarks": benchmarks})
    )


main()
