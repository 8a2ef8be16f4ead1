"""A height field in the 3D view, by our own Coin node and by Coin's stock nodes."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtGui
from pivy import coin

from beltgrinding import InputError, core
from beltgrinding.gui.scene import field_view
from beltgrinding.gui.scene.field_view import DEVIATION, FACE, FieldView, REMOVED
from support.hands import settle, widgets


def plate(x, y, spacing):
    shape = core.Shape.from_brep(Part.makeBox(x, y, 5).exportBrepToString())
    return core.sample_faces(shape, [5], spacing)[0]


def same(seen, packed, slack=6):
    wanted = [int(packed) >> shift & 255 for shift in (24, 16, 8)]
    assert np.abs(seen - wanted).max() <= slack, (seen, wanted)


class Shown:
    """A plate in a new document's 3D view, drawn by nodes of a kind, seen from above."""

    def __init__(self, kind):
        if kind == "environment":
            os.environ["BELTGRINDING_STOCK_NODES"] = "1"
        self.field = plate(60, 40, 1.0)
        self.show = FieldView(self.field, stock_nodes=kind == "stock")
        assert self.show.own_node == (kind == "own"), "the node is not the one that was asked for"
        FreeCAD.newDocument("field")
        self.look_through(Gui.ActiveDocument.ActiveView)
        self.scene = self.view.getSceneGraph()
        self.scene.addChild(self.show.node)
        self.view.fitAll()
        settle()

    def look_through(self, view):
        """Colours are seen in this view from now on."""
        self.view = view
        view.setAnimationEnabled(False)
        view.setCameraType("Orthographic")
        view.viewTop()
        settle()

    def pixel(self, x, y, z=5.0):
        return self.view.getPointOnScreen(FreeCAD.Vector(x, y, z))

    def colour_at(self, x, y):
        """What is drawn at a point of the plate, (3,) from 0 to 255."""
        settle()
        width, height = self.view.getSize()
        self.view.saveImage("seen.png", width, height, "White")
        at = self.pixel(x, y)
        c = QtGui.QColor(QtGui.QImage("seen.png").pixel(int(at[0]), height - 1 - int(at[1])))
        return np.array([c.red(), c.green(), c.blue()])


@pytest.mark.parametrize("kind", ("own", "stock", "environment"))
@pytest.mark.freecad(window=True)
def test_colours_and_heights_are_drawn(kind):
    here = Shown(kind)
    colour_at, field, show, view = here.colour_at, here.field, here.show, here.view
    left = show.points[:, 0] < 30
    colours = np.where(left, 0xFF2020FF, 0x2040FFFF).astype(np.uint32)
    show.set_colours(colours)
    same(colour_at(15, 20), 0xFF2020FF)
    same(colour_at(45, 20), 0x2040FFFF)
    # Bytes, and only a part of them other than before.
    bytes_ = np.zeros((len(colours), 4), np.uint8)
    bytes_[:, 1] = 200
    bytes_[left, 0] = 255
    bytes_[left, 1] = 32
    bytes_[left, 2] = 32
    show.set_colours(bytes_)
    same(colour_at(15, 20), 0xFF2020FF)
    same(colour_at(45, 20), 0x00C800FF)

    heights = np.where(left, 0.4, -0.4)
    show.set_heights(heights.astype(np.float32))
    show.colour_by("deviation", -0.05, 0.05, 0.5)
    above, below = core.colour_scale(-0.05, 0.05, 0.5, [0.4, -0.4])
    same(colour_at(15, 20), above)
    same(colour_at(45, 20), below)
    show.colour_by("removed depth", 1.0)
    removed = core.uncertainty_scale(1.0, [-0.4, 0.4])
    same(colour_at(15, 20), removed[0])
    same(colour_at(45, 20), removed[1])
    show.colour_by("pressure", 2.0, values=np.where(left, 2.0, 0.0))
    same(colour_at(15, 20), core.uncertainty_scale(2.0, [2.0])[0])
    show.colour_by("face")
    same(colour_at(15, 20), core.face_colours(field.faces)[0])
    for wrong in (
        lambda: show.colour_by("smell"),
        lambda: show.colour_by("pressure", 1.0),
        lambda: show.set_heights(heights[1:]),
        lambda: show.set_colours(colours[1:]),
    ):
        try:
            wrong()
        except InputError:
            continue
        raise AssertionError("a mistake was not refused")

    # A slanting view has the same colour, whatever the light.
    show.set_colours(np.full(len(colours), 0x2040FFFF, np.uint32))
    same(colour_at(45, 20), 0x2040FFFF)

    # Moved far up in the side view: the picture follows the heights, and so does the box.
    view.viewFront()
    view.fitAll()
    show.set_heights(np.full(len(colours), 30.0))
    box = coin.SoGetBoundingBoxAction(coin.SbViewportRegion(*view.getSize()))
    box.apply(show.node)
    assert abs(box.getBoundingBox().getMax()[2] - 35.0) < 1e-3


@pytest.mark.parametrize("kind", ("own", "stock"))
@pytest.mark.freecad(window=True)
def test_a_pick_gives_the_sample(kind):
    here = Shown(kind)
    pixel, scene, show, view = here.pixel, here.scene, here.show, here.view
    for x, y in ((10.2, 10.3), (44.7, 31.1), (59.0, 1.0)):
        at = pixel(x, y)
        index = show.pick(view, at)
        point = show.points[index]
        nearest = np.linalg.norm(show.points[:, :2] - (x, y), axis=1)
        # A pixel's width beside the best, for the pick is at whole pixels.
        assert nearest[index] < nearest.min() + 0.2, (x, y, point)
    assert show.pick(view, pixel(80, 20)) is None

    # The heights count: seen at 45 degrees, a raised field is hit elsewhere.
    view.setCameraOrientation(FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 45).Q)
    view.fitAll()
    flat = show.points[show.pick(view, pixel(30, 20))]
    show.set_heights(np.full(len(show.points), 10.0))
    raised = show.points[show.pick(view, pixel(30, 20))]
    assert abs(flat[1] - 20) < 1 and abs(raised[1] - 10) < 1, (flat, raised)

    # Where the scene has it elsewhere, it is picked there.
    show.set_heights(np.zeros(len(show.points)))
    scene.removeChild(show.node)
    group, move = coin.SoSeparator(), coin.SoTranslation()
    move.translation = (100, 0, 0)
    group.addChild(move)
    group.addChild(show.node)
    scene.addChild(group)
    view.viewTop()
    view.fitAll()
    settle()
    point = show.points[show.pick(view, pixel(130, 20))]
    assert np.linalg.norm(point[:2] - (30, 20)) < 1, point


@pytest.mark.freecad(window=True)
def test_several_views_and_the_end_of_one():
    here = Shown("own")
    colour_at, scene, show = here.colour_at, here.scene, here.show
    show.set_colours(np.full(len(show.points), 0x2040FFFF, np.uint32))
    same(colour_at(30, 20), 0x2040FFFF)
    Gui.runCommand("Std_ViewCreate")
    settle()
    views = Gui.ActiveDocument.mdiViewsOfType("Gui::View3DInventor")
    assert len(views) == 2
    other = next(v for v in views if v.getSceneGraph() != scene)

    other.getSceneGraph().addChild(show.node)
    other.fitAll()
    here.look_through(other)
    same(colour_at(30, 20), 0x2040FFFF)
    other.getSceneGraph().removeChild(show.node)
    assert colour_at(30, 20).tolist() == [255, 255, 255]
    window = widgets(QtGui.QMdiArea)[0]
    window.closeActiveSubWindow()
    settle()
    (left,) = Gui.ActiveDocument.mdiViewsOfType("Gui::View3DInventor")
    assert left.getSceneGraph() == scene
    show.set_colours(np.full(len(show.points), 0xFF2020FF, np.uint32))
    here.look_through(left)
    same(colour_at(30, 20), 0xFF2020FF)
    show.set_colours(np.full(len(show.points), 0x20A020FF, np.uint32))
    left.redraw()
    same(colour_at(30, 20), 0x20A020FF)


@pytest.mark.freecad(window=True)
def test_a_border_between_colours_runs_through_the_triangles():
    import beltgrinding_coin

    here = Shown("own")
    colour_at, field, show, view = here.colour_at, here.field, here.show, here.view
    scale = (-0.05, 0.05, 0.3)
    heights = (
        0.2 * (field.points[:, 0] - 30.0) / 30.0
    )  # over the border at x = 37.5, inside of a cell
    missed = np.abs(field.points[:, 1] - 30) < 3
    show.flags = np.where(missed, field.flags | core.MISSED, field.flags)
    show.set_heights(0.0 * heights)
    show.colour_by(DEVIATION, *scale, values=heights)
    settle()
    view.saveImage("crisp.png", 1600, 1000, "White")
    image = QtGui.QImage("crisp.png")
    row = [image.pixelColor(x, 500).getRgb()[:3] for x in range(300, 1300)]
    good, high = (
        tuple(int(core.colour_scale(*scale, [v])[0]) >> shift & 255 for shift in (24, 16, 8))
        for v in (0.0, 0.0505)
    )
    near = lambda a, b: max(abs(x - y) for x, y in zip(a, b)) <= 12
    at = max(k for k, c in enumerate(row) if near(c, good))
    # A pixel further it is the colour of too much; a cell is 20 pixels wide.
    assert any(near(c, high) for c in row[at + 1 : at + 4]), row[at - 2 : at + 6]
    palette = np.array(
        [
            [int(c) >> shift & 255 for shift in (24, 16, 8)]
            for c in core.colour_scale(*scale, np.linspace(-0.3, 0.3, 4096).tolist())
        ]
    )
    other = lambda c: np.abs(palette - c).max(axis=1).min() > 3 and c != (255, 255, 255)
    rare = [c for c in set(row) if other(c)]
    assert len(rare) <= 4, rare  # pixels on the border that several rays share

    # What was missed has its own colour, and no rainbow around it.
    (grey,) = core.colour_scale(*scale, [np.nan])
    same(colour_at(15, 30), grey)
    column = [image.pixelColor(900, y).getRgb()[:3] for y in range(150, 850)]
    grey = tuple(int(grey) >> shift & 255 for shift in (24, 16, 8))
    rare = [c for c in set(column) if other(c) and not near(c, grey)]
    assert len(rare) <= 6, rare

    # One colour a sample again, and values again.
    show.colour_by(FACE)
    same(colour_at(30, 10), core.face_colours(field.faces)[0])
    show.colour_by(REMOVED, 0.4, values=np.full(field.size, 0.4))
    same(colour_at(30, 10), core.uncertainty_scale(0.4, [0.4])[0])
    show.colour_by(DEVIATION, 0.0, 0.0, 0.0)  # no range: nothing to tell apart, and no error
    one = np.zeros(field.size)
    for values, low, high, palette in (
        (one[:3], 0, 1, [1]),
        (one, 1, 1, [1]),
        (one, 0, 1, []),
        (one, 0, 1, [1] * 5000),
        (one, 0, np.inf, [1]),
    ):
        try:
            beltgrinding_coin.set_values(show.drawn.address, values, low, high, palette, 0)
        except InputError:
            continue
        raise AssertionError((low, high, len(palette)))


@pytest.mark.freecad(window=True)
def test_an_address_that_is_no_node_is_refused():
    import beltgrinding_coin

    assert beltgrinding_coin.register_node()
    cube = coin.SoCube()
    for address in (0, 12345, int(cube.this)):
        try:
            beltgrinding_coin.set_heights(address, [0.0])
        except core.InputError:
            continue
        raise AssertionError("accepted")
    node = coin.SoType.fromName("SoHeightField").createInstance()
    try:
        beltgrinding_coin.set_samples(int(node.this), [[0, 0, 0]], [[0, 0, 1]], [[0, 0, 1]])
    except core.InputError as error:
        assert "names sample 1" in str(error)
    else:
        raise AssertionError("accepted")


def test_a_coin_that_was_not_started_is_not_used():
    """What a bundle with a Coin of its own does: ours is then another one, never started."""
    code = "import beltgrinding_coin as b; assert b.register_node() is False"
    path = os.pathsep.join(sys.path)
    subprocess.run(
        ["/usr/bin/python3", "-c", code], check=True, env={**os.environ, "PYTHONPATH": path}
    )


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_own_node_is_found_beside_the_core():
    """Also where nothing else has put the core's folder on Python's path, or has taken it off again."""
    place = str(Path(core.__file__).parent)
    sys.path[:] = [folder for folder in sys.path if folder != place]
    assert "beltgrinding_coin" not in sys.modules and field_view.has_own_node()
