"""Run by tools/bench inside FreeCAD with a window: a program of 100,000 poses, shown and scrubbed.

Writes Google Benchmark's JSON to BELTGRINDING_BENCH_OUT. Figures in ms: reading the file, laying the
path into the document and drawing it, opening its panel, and a frame while the pose is scrubbed
(median and the worst of 50), beside the same for 1,000 poses as the peer.
"""

import json
import os
import tempfile
import time
from pathlib import Path

import FreeCAD
import FreeCADGui
import Part
from PySide import QtGui

from beltgrinding.gui.panels.program_panel import ProgramPanel
from beltgrinding.objects import api

FRAMES = 50
ROW = 1000  # poses in a pass


def write_program(path, count):
    """Passes over a plate of 300 mm, back and forth, 0.3 mm from pose to pose."""
    lines = ["x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"]
    for i in range(count):
        row, k = divmod(i, ROW)
        x = 0.3 * (k if row % 2 == 0 else ROW - 1 - k)
        lines.append(f"{x:.4f},{2.0 * row:.4f},20,0,1,0,0,50")
    path.write_text("\n".join(lines) + "\n")


def draw():
    for _ in range(2):
        FreeCADGui.updateGui()
        QtGui.QApplication.processEvents()


def measure(folder, count):
    """{figure: ms} of a program with ``count`` poses."""
    file = folder / "program.csv"
    write_program(file, count)
    doc = FreeCAD.newDocument("path")
    part = doc.addObject("Part::Feature", "Plate")
    part.Shape = Part.makeBox(300, 200, 20)
    job = api.make_job(part, ["Face6"])
    api.make_stock(job)
    api.make_belt_machine(job)
    results = {}

    def timed(name, work):
        start = time.perf_counter()
        value = work()
        draw()
        results[name] = 1000.0 * (time.perf_counter() - start)
        return value

    path = timed("import_and_draw", lambda: api.import_program(job, str(file)))
    FreeCADGui.SendMsgToActiveView("ViewFit")
    draw()
    panel = timed("open_panel", lambda: ProgramPanel(path))
    panel.form.show()
    frames = []
    for k in range(FRAMES):
        start = time.perf_counter()
        panel.walk.slider.setValue(1 + k * (count - 1) // (FRAMES - 1))
        FreeCADGui.ActiveDocument.ActiveView.redraw()
        draw()
        frames.append(1000.0 * (time.perf_counter() - start))
    panel.close()
    frames.sort()
    results["scrub_frame"], results["scrub_worst_frame"] = frames[FRAMES // 2], frames[-1]
    FreeCAD.closeDocument(doc.Name)
    return results


def main(folder):
    small, large = measure(folder, 1_000), measure(folder, 100_000)
    benchmarks = []
    for name, value in large.items():
        print(f"path/{name:30} {value:10.2f} ms   ({small[name]:.2f} with 1,000 poses)")
        benchmarks.append({"name": f"path/{name}", "real_time": value, "time_unit": "ms"})
        benchmarks.append({"name": f"path/{name}_1k", "real_time": small[name], "time_unit": "ms"})
    Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
        json.dumps({"context": {}, "benchmarks": benchmarks})
    )


with tempfile.TemporaryDirectory() as name:
    main(Path(name))
