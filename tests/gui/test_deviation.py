"""The coloured deviation in FreeCAD's window: it is drawn, and survives save, close and reopen."""

import math
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import FreeCADGui
import FreeCADGui as Gui
import Part
from PySide import QtGui
from pivy import coin

from beltgrinding.engine import core
from beltgrinding.gui.scene import legend, legend_picture
from beltgrinding.gui.scene.camera import look_at
from beltgrinding.gui.scene.legend import label_values
from beltgrinding.objects import api
from support import pictures
from support.hands import choose, field, menu, prepare, press, settle, start, type_in, wait, widgets
from support.picture import coloured


@pytest.fixture(scope="module")
def demo(freecad, tmp_path_factory):
    out = tmp_path_factory.mktemp("demo")
    freecad.call(blade_document, out, window=True)
    return out


def blade_document(out):
    job = api.open_example(out)
    simulation = api.simulate(job, write_to=out)
    api.make_deviation(job)
    for part, _ in job.DesignFaces:
        part.ViewObject.Visibility = False  # it would hide what is cut below it
    normals = simulation.Proxy.field(simulation).normals
    look_at(FreeCAD.Vector(*normals.mean(axis=0).tolist()))
    view = FreeCADGui.ActiveDocument.ActiveView
    view.saveImage(str(out / "deviation.png"), 1400, 1000, "White")
    job.Document.saveAs(str(out / "deviation.FCStd"))


@pytest.mark.slow
def test_the_picture_shows_both_ramps(freecad, demo):
    brown, blue = coloured(demo / "deviation.png")
    assert brown > 25000 and blue > 12000
    pictures.keep("blade-deviation", (demo / "deviation.png").read_bytes())
    pictures.check(freecad.call(release), ["blade-deviation"])


def release():
    return [int(part) for part in FreeCAD.Version()[:2]]


WIDTH, HEIGHT = 500, 400


def look(view, yaw, pitch):
    turn = coin.SbRotation(coin.SbVec3f(1, 0, 0), math.radians(90 + pitch))
    turn *= coin.SbRotation(coin.SbVec3f(0, 0, 1), math.radians(yaw))
    view.getCameraNode().orientation.setValue(turn)
    view.fitAll()
    settle()
    direction = turn.multVec(coin.SbVec3f(0, 0, 1))  # from the part to the eye
    return np.array(direction.getValue())


def seen(view, points, name):
    view.saveImage(name, WIDTH, HEIGHT, "White")
    image = QtGui.QImage(name)
    volume = view.getCameraNode().getViewVolume(WIDTH / HEIGHT)
    for point in points:
        x, y, _ = volume.projectToScreen(coin.SbVec3f(*(float(v) for v in point))).getValue()
        at = int(x * WIDTH), int((1 - y) * HEIGHT)
        yield np.array(image.pixelColor(*at).getRgb()[:3])


def every_view(view, points, normals, wanted, framed=0.0):
    # framed: the share of the points that the lines of a frame may hide.
    looked = hidden = 0
    for number in range(10):
        eye = look(view, 36 * number, 65 - 14 * number)
        facing = normals @ eye
        for least, most in ((0.08, 0.2), (0.2, 0.6), (0.6, 1.0)):  # at grazing angles, too
            here = np.flatnonzero((facing > least) & (facing <= most))[::7][:20]
            for i, colour in zip(here, seen(view, points[here], f"view{number}.png")):
                looked += 1
                if abs(colour - wanted).max() > 2:
                    hidden += 1
                    assert hidden <= framed * 200, (number, points[i], colour, wanted)
    assert looked > 200, looked


@pytest.mark.slow
@pytest.mark.freecad(window=True)
def test_a_colour_reads_the_same_from_every_side():
    """Stock of 0.15 mm around a cylinder that nothing has touched yet but in one place."""
    start()
    doc = FreeCAD.newDocument("round")
    part = doc.addObject("Part::Feature", "Round")
    part.Shape = Part.makeCylinder(20, 50)
    doc.recompute()
    Gui.Selection.addSelection(doc.Name, "Round", "Face1")
    menu("New job")
    type_in("Spacing", "0.7 mm")
    press("OK")
    menu("Stock")
    type_in("Allowance", "0.15 mm")
    press("OK")
    menu("Belt machine")
    press("OK")
    Path("touch.csv").write_text(
        "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s\n"
        + "".join(f"20,0,{z},0.70710678,0,-0.70710678,0,20\n" for z in (20, 22))
    )
    choose("touch.csv")
    menu("Import robot program...")
    press("OK")
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    press("OK")
    deviation = doc.Deviation
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    points = np.array([[p.x, p.y, p.z] for p in deviation.Mesh.Points])
    radius = np.hypot(points[:, 0], points[:, 1])
    untouched = abs(radius - 20.15) < 1e-3
    untouched &= (points[:, 2] > 3) & (points[:, 2] < 47)
    untouched &= (
        abs(np.arctan2(points[:, 1], points[:, 0])) > 0.6
    )  # there is the seam, and the wheel
    assert untouched.sum() > 1000
    normals = points * (1, 1, 0) / radius[:, None]
    scale = (
        deviation.ToleranceLower.Value,
        deviation.ToleranceUpper.Value,
        deviation.ColourLimit.Value,
    )
    packed = int(core.colour_scale(*scale, [0.15])[0])
    wanted = np.array([packed >> shift & 255 for shift in (24, 16, 8)])
    every_view(view, points[untouched], normals[untouched], wanted)

    # Neither the mouse over it nor a selection paints it.
    Gui.Selection.setPreselection(deviation, "", *(float(v) for v in points[untouched][0]))
    settle()
    every_view(view, points[untouched], normals[untouched], wanted, 0.1)
    Gui.Selection.addSelection(deviation)
    settle()
    every_view(view, points[untouched], normals[untouched], wanted, 0.1)
    Gui.Selection.clearSelection()

    # The same in a document of 0.1.0, which painted and shaded it.
    deviation.ViewObject.SelectionStyle = "Shape"
    deviation.ViewObject.addProperty("App::PropertyBool", "Lit", "Deviation", "")
    deviation.ViewObject.Lit = True
    doc.saveAs("lit.FCStd")
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument("lit.FCStd")
    settle()
    deviation = doc.Deviation
    assert not hasattr(deviation.ViewObject, "Lit")
    assert deviation.ViewObject.SelectionStyle == "BoundBox"
    Gui.Selection.addSelection(deviation)
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    every_view(view, points[untouched], normals[untouched], wanted, 0.1)


@pytest.mark.freecad(window=True)
def test_the_colours_survive_reopening(demo):
    picture = demo / "reopened.png"
    doc = FreeCAD.openDocument(str(demo / "deviation.FCStd"))
    deviation = doc.getObject("Deviation")
    assert len(deviation.VertexColors) == deviation.Mesh.CountPoints > 0
    assert deviation.ViewObject.Coloring
    assert deviation.InTolerance > 0 and deviation.Maximum > deviation.Minimum
    assert not doc.getObject("Simulation").OutOfDate
    FreeCADGui.updateGui()
    FreeCADGui.ActiveDocument.ActiveView.saveImage(str(picture), 400, 300, "White")
    brown, blue = coloured(picture)
    assert brown > 1000 and blue > 400


@pytest.mark.freecad(window=True)
def test_the_colours_end_where_the_panel_says():
    job = prepare()
    doc = job.Document
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    press("OK")
    menu("Deviation")
    deviation, field_ = doc.Deviation, doc.Simulation.Proxy.field(doc.Simulation)
    type_in("ColourLimit", "0.3 mm")
    assert deviation.ColourLimit.Value == 0.3
    limits = widgets(QtGui.QWidget, "ColourLimit")
    field("Bounds").setCurrentIndex(1)  # by tolerance
    settle()
    assert not any(w.isVisible() for w in limits)
    assert abs(deviation.ColourLimit.Value - 0.25) < 1e-9  # 5 x 0.05
    type_in("TimesTolerance", "3")
    assert abs(deviation.ColourLimit.Value - 0.15) < 1e-9
    field("Bounds").setCurrentIndex(2)  # by percentile
    settle()
    type_in("Percentile", "30")
    limit = deviation.ColourLimit.Value
    share = field_.areas[np.abs(field_.height) <= limit + 1e-12].sum() / field_.areas.sum()
    assert 0.05 < limit < 0.2 and abs(share - 0.3) < 0.01, (limit, share)
    type_in("Percentile", "10")
    assert abs(deviation.ColourLimit.Value - 1.01 * 0.05) < 1e-9  # outside of the tolerance
    type_in("Percentile", "99")
    smooth = len(set(deviation.VertexColors))
    field("Bands").setValue(4)
    settle()
    assert smooth > 50 and len(set(deviation.VertexColors)) == 5  # four above and the band
    press("OK")
    doc.undo()
    assert deviation.Bounds == "by hand" and deviation.Bands == 0
    assert abs(deviation.ColourLimit.Value - 0.5) < 1e-9

    values = label_values(-0.05, 0.05, 0.25, 4)
    assert {round(v, 9) for v in values} == {
        -0.25,
        -0.2,
        -0.15,
        -0.1,
        -0.05,
        0.05,
        0.1,
        0.15,
        0.2,
        0.25,
    }
    assert len(label_values(-0.001, 0.001, 1.0, 20)) < 32  # not over one another


@pytest.mark.freecad(window=True)
def test_the_legend_says_what_is_good_and_where_colours_are_clipped():
    def texts(spec):
        return {*spec.labels.values(), *spec.words, spec.title}

    start()
    for lower, upper, limit in ((-0.05, 0.05, 0.3), (-0.02, 0.1, 0.3), (-0.1, 0.0, 0.3)):
        spec = legend.deviation(lower, upper, limit)
        assert {"too much left", "cut too deep", "good"} <= texts(spec), spec
        assert spec.words == ("cut too deep", "too much left") and spec.beyond == (True, True)
    narrow = legend.deviation(-0.005, 0.005, 0.3, beyond=(False, True))
    assert "-0.005 good" in texts(narrow) and "good" not in texts(narrow), narrow
    assert narrow.beyond == (False, True)
    scan = legend.scan(-0.05, 0.05, 0.3, difference=True)  # not left or cut by anybody
    assert not {"too much left", "cut too deep", "good"} & texts(scan)

    job = prepare()
    doc = job.Document
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    type_in("ColourLimit", "0.1 mm")  # there are 0.2 mm of stock
    press("OK")
    assert doc.Deviation.Maximum.Value > 0.1
    drawn = doc.Deviation.ViewObject.Proxy.drawn.spec
    assert drawn.beyond == (doc.Deviation.Minimum.Value < -0.1, True), (
        drawn,
        doc.Deviation.Minimum,
    )


@pytest.mark.freecad(window=True)
def test_the_legend_takes_a_twelfth_and_leaves_the_part_alone():
    job = prepare()
    doc = job.Document
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    press("OK")
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    drawn = doc.Deviation.ViewObject.Proxy.drawn

    def colours(image, box, height):
        found = set()
        for y in range(box[1] + 1, box[3] - 1, 3):
            for x in range(box[0] + 1, box[2] - 1, 3):
                found.add(image.pixelColor(x, height - 1 - y).getRgb()[:3])
        return found

    for width, height in ((1000, 600), (1600, 900), (2400, 1500), (700, 900), (500, 350)):
        view.viewFront()
        view.fitAll()
        view.saveImage("legend.png", width, height, "White")
        left, bottom, right, top = drawn.box
        assert 0 <= left < right <= width and 0 <= bottom < top <= height, (
            drawn.box,
            width,
            height,
        )
        # A narrow view has letters that one can still read, and so a wider legend.
        assert right - left < max(1.25 * width / 12, 100), (drawn.box, width)
        image = QtGui.QImage("legend.png")
        bar = {c for c in colours(image, drawn.box, height) if max(c) - min(c) > 60}
        assert len(bar) > 30, (width, height, len(bar))

    # Where the part fills the left side, it stands at the right.
    camera = view.getCameraNode()
    view.fitAll()
    box = job.DesignFaces[0][0].Shape.BoundBox
    camera.height.setValue(1.02 * box.XLength * view.getSize()[1] / view.getSize()[0])
    x, y, z = camera.position.getValue().getValue()
    camera.position.setValue(x + 0.14 * box.XLength, y, z)
    settle()
    assert drawn.box[0] > 0.5 * view.getSize()[0], (drawn.box, view.getSize())

    # Too small to be read: none. Labels that would lie on one another are left out.
    assert legend_picture.draw(drawn.spec, 200, 60) is None
    thick = dict.fromkeys(k / 100 for k in range(101))
    assert len(legend_picture.placed(thick, 0.1)) == 12


@pytest.mark.freecad(window=True)
def test_two_legends_stand_side_by_side():
    def column(obj):
        return obj.ViewObject.Proxy.drawn.column

    job = prepare()
    doc = job.Document
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    press("OK")
    menu("Ground part as mesh")
    settle()
    deviation, ground = doc.Deviation, doc.GroundPart
    deviation.ViewObject.Visibility = ground.ViewObject.Visibility = True
    assert (column(deviation), column(ground)) == (0, 1)
    deviation.ViewObject.Visibility = False
    assert column(ground) == 0
    deviation.ViewObject.Visibility = True
    job.ToleranceUpper = "0.1 mm"  # makes both anew
    doc.recompute()
    assert (column(deviation), column(ground)) == (0, 1)

    # They stand beside one another, and the arrows have the colours of the bar's ends.
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.saveImage("legends.png", 1000, 800, "White")
    first, second = (obj.ViewObject.Proxy.drawn.box for obj in (deviation, ground))
    assert first[2] <= second[0] and second[2] < 300, (first, second)
    image = QtGui.QImage("legends.png")
    packed = ground.ViewObject.Proxy.drawn.spec.colours
    for colour in (packed[0], packed[-1]):
        wanted = [colour >> shift & 255 for shift in (24, 16, 8)]
        rows = []
        for y in range(second[1], second[3]):
            drawn = [image.pixelColor(x, 799 - y).getRgb()[:3] for x in range(second[0], second[2])]
            rows.append(sum(all(abs(a - b) < 12 for a, b in zip(c, wanted)) for c in drawn))
        tip = [n for n in rows if 1 <= n < max(rows) - 2]
        assert max(rows) >= 8 and len(tip) >= 3, rows
