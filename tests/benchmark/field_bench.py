"""Run by tools/bench inside FreeCAD with a window: a height field of 1,000,000 samples in the 3D view.

Writes Google Benchmark's JSON to BELTGRINDING_BENCH_OUT. Figures in ms, of SoHeightField, of Coin's
stock nodes and, as the peer, of FreeCAD's own coloured mesh: showing the field for the first time, a
frame while the view turns (median), a change of all colours (the processor's part, and with the frame
that shows it), a change of 1 % of the heights with its frame, a pick.

Where there is no graphics card (llvmpipe), a frame's time is the rasteriser's, for all alike.
"""

import io
import json
import os
import time
from pathlib import Path

import FreeCAD
import FreeCADGui
import Mesh
import numpy as np
import Part
from pivy import coin
from PySide import QtGui

from beltgrinding.engine import core
from beltgrinding.gui.scene.field_view import FieldView

SIDE = 1000.0  # mm; at 1 mm spacing a million samples
FRAMES = 9
SCALE = (-0.05, 0.05, 0.5)


def milliseconds(work, times=5):
    """Median of ``times`` runs."""
    taken = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        taken.append(1000.0 * (time.perf_counter() - start))
    return sorted(taken)[times // 2]


def draw():
    FreeCADGui.ActiveDocument.ActiveView.redraw()
    QtGui.QApplication.processEvents()


def frame(view):
    """Median time of a frame while the view turns."""
    turn = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 2)

    def step():
        now = FreeCAD.Rotation(*view.getCameraOrientation().Q)
        view.setCameraOrientation(turn.multiply(now).Q)
        draw()

    step()
    return milliseconds(step, FRAMES)


def look(view):
    view.setAnimationEnabled(False)
    view.viewIsometric()
    view.fitAll()
    draw()


def pick_ray(node, view):
    """One pick in the middle of the view."""
    width, height = view.getSize()
    root = coin.SoSeparator()
    root.ref()
    root.addChild(view.getCameraNode())
    root.addChild(node)
    action = coin.SoRayPickAction(coin.SbViewportRegion(int(width), int(height)))
    action.setPoint(coin.SbVec2s(int(width) // 2, int(height) // 2))
    action.apply(root)
    assert action.getPickedPoint() is not None
    root.removeAllChildren()
    root.unref()


def measure(field, heights, stock):
    """{figure: ms} of a FieldView."""
    doc = FreeCAD.newDocument("field")
    view = FreeCADGui.ActiveDocument.ActiveView
    results, made = {}, []

    def first():
        show = FieldView(field, stock_nodes=stock)
        show.colour_by("deviation", *SCALE)
        view.getSceneGraph().addChild(show.node)
        look(view)
        made.append(show)

    results["show"] = milliseconds(first, 1)
    show = made[0]
    assert show.own_node != stock
    results["frame"] = frame(view)
    turns = [0]

    def recolour():
        turns[0] += 1
        show.colour_by("deviation", -0.05, 0.05, 0.3 + 0.1 * (turns[0] % 2))

    results["colour_cpu"] = milliseconds(recolour)
    results["colour_and_frame"] = milliseconds(lambda: (recolour(), draw()))
    part = slice(len(heights) // 2, len(heights) // 2 + len(heights) // 100)

    def grind():
        heights[part] -= 0.01
        show.set_heights(heights)

    results["heights_cpu"] = milliseconds(grind)
    results["heights_and_frame"] = milliseconds(lambda: (grind(), draw()))
    pick_ray(show.node, view)
    results["pick"] = milliseconds(lambda: pick_ray(show.node, view))
    view.getSceneGraph().removeChild(show.node)
    FreeCAD.closeDocument(doc.Name)
    return results


def measure_mesh(field):
    """The same of FreeCAD's own mesh, as the deviation in the document is drawn."""
    doc = FreeCAD.newDocument("mesh")
    view = FreeCADGui.ActiveDocument.ActiveView
    obj = doc.addObject("Mesh::FeaturePython", "Mesh")
    obj.addProperty("App::PropertyColorList", "VertexColors")
    obj.ViewObject.Proxy = 0  # without one it is not drawn
    turns = [0]

    def recolour():
        turns[0] += 1
        limit = 0.3 + 0.1 * (turns[0] % 2)
        obj.VertexColors = core.deviation_colours(field, -0.05, 0.05, limit).tolist()
        obj.ViewObject.Coloring = False
        obj.ViewObject.Coloring = True

    def reshape():
        mesh = Mesh.Mesh()
        mesh.read(Stream=io.BytesIO(core.mesh_ply(field, True)), Format="PLY")
        obj.Mesh = mesh
        recolour()

    results = {"show": milliseconds(lambda: (reshape(), look(view)), 1)}
    results["frame"] = frame(view)
    results["colour_cpu"] = milliseconds(recolour, 3)
    results["colour_and_frame"] = milliseconds(lambda: (recolour(), draw()), 3)
    results["heights_cpu"] = milliseconds(reshape, 1)
    results["heights_and_frame"] = milliseconds(lambda: (reshape(), draw()), 1)
    width, height = view.getSize()
    middle = (int(width) // 2, int(height) // 2)
    assert view.getObjectInfo(middle)["Object"] == "Mesh"
    results["pick"] = milliseconds(lambda: view.getObjectInfo(middle), 3)
    FreeCAD.closeDocument(doc.Name)
    return results


def main():
    shape = core.Shape.from_brep(Part.makeBox(SIDE, SIDE, 10).exportBrepToString())
    field, _ = core.sample_faces(shape, [5], 1.0)
    heights = 0.3 * np.sin(field.points[:, 0] / 40.0) * np.cos(field.points[:, 1] / 60.0)
    field.set_height(heights)
    print(f"field/samples {field.size}")
    mesh = measure_mesh(field)
    stock = measure(field, heights.copy(), True)
    benchmarks = []
    for name, value in measure(field, heights.copy(), False).items():
        figures = {"": value, "_mesh": mesh[name], "_stock": stock[name]}
        peers = f"FreeCAD's mesh {mesh[name]:.2f}, stock nodes {stock[name]:.2f}"
        print(f"field/{name:20} {value:10.2f} ms   ({peers})")
        for end, figure in figures.items():
            benchmarks.append(
                {"name": f"field/{name}{end}", "real_time": figure, "time_unit": "ms"}
            )
    Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
        json.dumps({"context": {}, "benchmarks": benchmarks})
    )


main()
