"""What a job looks like: cameras with a line of sight, paths with arrows, stock, theme, icons."""

import time
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
import Mesh
import Part
from PySide import QtCore, QtGui
from pivy import coin

from beltgrinding.gui.common import theme as themes
from beltgrinding.gui.common.icons import media_icon
from beltgrinding.gui.scene import path_arrows, stock_lines, stock_shell
from beltgrinding.gui.scene.cell_view import CellView
from beltgrinding.gui.scene.part_context import tessellated
from beltgrinding.gui.scene.sight import Sight
from beltgrinding.objects import section
from support.hands import click_at, menu, press, settle, start, view_widget, wait, widgets
from support.playing import prepared

pytestmark = pytest.mark.freecad(window=True)


def test_the_camera_stands_where_a_place_is_seen():
    job, doc, view = prepared()
    # A roof over the ground face, seen from above in the way of everything.
    roof = doc.addObject("Part::Feature", "Roof")
    part = job.DesignFaces[0][0]
    box = part.Shape.BoundBox
    roof.Shape = Part.makeBox(box.XLength, box.YLength, 5)
    roof.Placement.Base = FreeCAD.Vector(box.XMin, box.YMin, box.ZMax + 15)
    whole = doc.addObject("Part::Feature", "Whole")
    whole.Shape = Part.Compound([part.Shape, roof.Shape])
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    field_ = doc.Simulation.Proxy.field(doc.Simulation)
    view.setAnimationEnabled(False)
    middle = int(np.linalg.norm(field_.points - field_.points.mean(axis=0), axis=1).argmin())

    def direction():
        return np.array(view.getViewDirection())

    sight = Sight(job)
    sight.at_samples(field_, [middle], 30.0)
    assert direction() @ field_.normals[middle] < -0.97  # nothing in the way
    points, triangles = sight.part
    shape = Part.Compound([part.Shape, roof.Shape])
    sight.part = tessellated(shape)
    sight.at_samples(field_, [middle], 30.0)
    assert direction() @ field_.normals[middle] > -0.75, direction()
    assert not sight.faded

    # Walled in: the rest of the part fades, and is there again afterwards.
    walls = Part.makeBox(
        box.XLength + 20,
        box.YLength + 20,
        60,
        FreeCAD.Vector(box.XMin - 10, box.YMin - 10, box.ZMin - 10),
    )
    sight.part = tessellated(walls)
    sight.at_samples(field_, [middle], 30.0)
    assert sight.faded
    root, node = sight.faded[0]
    assert root.findChild(node) == 0 and node.transparency.getValues()[0] > 0.5
    sight.clear()
    assert root.findChild(node) < 0 and not sight.faded

    # At a contact: a body between the eye and the wheel is seen through.
    doc.BeltMachine.BodiesAtPart = [roof]
    cell = CellView(doc, doc.BeltMachine)
    path = doc.RobotPath
    cell.set_path(path.Proxy.arrays(path)["frames"])
    cell.set_pose(4)
    assert {"wheel", "Roof"} <= set(cell.bodies) and "Roof" in cell.solids()
    sight = Sight(job)
    sight.at_contact(cell, cell.frames()["contact"][:3, 3], 100.0)
    assert abs(direction()[2]) < 0.9  # from aside of the wheel
    cell.fade(["Roof"])
    assert cell.bodies["Roof"].getChild(0).getName() == "BeltGrindingFade"
    cell.tint(["Roof"])
    cell.fade([])
    names = [
        cell.bodies["Roof"].getChild(k).getName()
        for k in range(cell.bodies["Roof"].getNumChildren())
    ]
    assert "BeltGrindingFade" not in names and "BeltGrindingTint" in names
    cell.close()


def test_a_path_has_arrows_and_keeps_its_colours():
    _, doc, _ = prepared()
    path = doc.RobotPath
    assert path.ViewObject.SelectionStyle == "BoundBox" and path.ViewObject.LineWidth == 2
    arrows = path.ViewObject.Proxy.arrows
    assert arrows.whichChild.getValue() == -3
    points = path.Proxy.contacts(path)
    rapid = path.Proxy.arrays(path)["rapid"]
    assert points.shape == (path.PoseCount, 3)
    places, ways = path_arrows.placed(points, rapid, 1.0)
    assert len(places) > 1
    np.testing.assert_allclose(ways[:, 0], 1.0, atol=1e-6)  # the pass goes along x
    path.ViewObject.Visibility = False
    assert arrows.whichChild.getValue() == -1
    path.ViewObject.Visibility = True
    assert arrows.whichChild.getValue() == -3

    # Rapid moves have none; short pieces neither; a long program no more than can be seen.
    line = np.array([[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [0, 10.1, 0]], dtype=float)
    places, ways = path_arrows.placed(line, np.array([0, 0, 1, 0, 1], dtype=bool), 1.0)
    assert sorted(set(map(tuple, ways.round(6).tolist()))) == [(-1, 0, 0), (1, 0, 0)]
    many = np.cumsum(np.random.default_rng(1).normal(size=(40000, 3)), axis=0)
    assert len(path_arrows.placed(many, np.zeros(40000, bool), 0.1)[0]) <= path_arrows.MOST
    still = np.zeros((5, 3))
    assert len(path_arrows.placed(still, np.zeros(5, bool), 0.0)[0]) == 0
    path_arrows.arrows(still, np.zeros(5, bool), (0, 1, 0))
    corners, faces = path_arrows.cones(np.zeros((1, 3)), np.array([[0, 0, 1.0]]), 2.0)
    assert (
        corners[:, 2].max() == 1.0
        and corners[:, 2].min() == -1.0
        and faces.max() == len(corners) - 1
    )


def test_the_stock_is_a_shell_until_there_is_a_result():
    job, doc, _ = prepared()
    shell = doc.Stock.ViewObject.Proxy.shell
    shown = lambda: shell.whichChild.getValue() == -3
    assert shown()
    doc.Stock.ViewObject.Visibility = False
    assert not shown()
    doc.Stock.ViewObject.Visibility = True
    assert shown()
    doc.Stock.Kind = "solid"
    settle()
    assert not shown()
    doc.Stock.Kind = "allowance"
    menu("Simulate")
    wait(lambda: doc.getObject("Deviation") is not None)
    press("Close")
    assert not shown()
    doc.Deviation.ViewObject.Visibility = False
    assert shown()
    doc.Deviation.ViewObject.Visibility = True
    assert not shown()
    doc.removeObject("Deviation")
    settle()
    assert shown()

    # Outwards: flipping is for loose faces, and an inside-out solid's are turned.
    part = job.DesignFaces[0][0].Shape.copy()
    assert set(stock_shell._outwards(part).values()) == {1.0}
    inside_out = Part.Solid(part.Shells[0].reversed())
    assert set(stock_shell._outwards(inside_out).values()) == {
        -1.0 if inside_out.Volume < 0 else 1.0
    }
    assert stock_shell._outwards(part.Faces[0]) == {}  # loose
    # A volume takes a third of a second of a cast housing: once for a solid, not for each of its 323 faces.
    volumes = []

    class Solid:
        Faces = part.Faces
        Volume = property(lambda self: volumes.append(1) or 1.0)

    class Casting:
        Solids = [Solid()]
        isEqual = lambda self, other: self is other

    casting = Casting()
    for _ in range(2):
        stock_shell._sides = [one for one in stock_shell._sides if one[0] is casting]
        assert len(stock_shell._outwards(casting)) == len(part.Faces) and len(volumes) == 1
    stock_shell._sides = []

    # As thick as the allowance, closed at its borders.
    square = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]], dtype=float)
    points, faces = stock_shell.thickened(square, np.array([[0, 1, 2], [0, 2, 3]]), 0.5)
    assert len(points) == 8 and len(faces) == 2 + 2 * 4
    assert points[4:, 2].tolist() == [0.5] * 4


@pytest.mark.slow
def test_a_mesh_is_the_part_of_a_job():
    start()
    Gui.activateWorkbench("BeltGrindingWorkbench")
    doc = FreeCAD.newDocument("meshed")
    box = Part.makeBox(40, 30, 10)
    mesh = doc.addObject("Mesh::Feature", "Casting")
    mesh.Mesh = Mesh.Mesh(box.tessellate(0.1))
    mesh.Placement.Base = FreeCAD.Vector(5, 0, 0)
    doc.recompute()
    Gui.Selection.addSelection(mesh)
    steps = doc.UndoCount
    menu("New job")
    press("OK")
    job = doc.BeltGrindingJob
    part = job.DesignFaces[0][0]
    assert part.Label == "Casting (faces)" and len(part.Shape.Faces) == 6
    assert abs(part.Shape.BoundBox.XMin - 5) < 1e-6
    assert not mesh.ViewObject.Visibility
    assert doc.UndoCount == steps + 1
    doc.undo()
    assert doc.getObject("BeltGrindingJob") is None and doc.getObject("MeshPart") is None

    # Too fine: said, and the document stays as it was.
    fine = doc.addObject("Mesh::Feature", "Scan")
    fine.Mesh = Mesh.createSphere(20.0, 120)
    doc.recompute()
    objects = len(doc.Objects)
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(fine)
    menu("New job")
    box = next(b for b in widgets(QtGui.QMessageBox, "BeltGrinding_Error") if b.isVisible())
    assert "Scan" in box.text() and "triangles" in box.text(), box.text()
    box.close()
    assert len(doc.Objects) == objects


def test_what_is_out_of_date_keeps_its_icon():
    _, doc, _ = prepared()
    before = set(Path(FreeCAD.getTempPath()).glob("BeltGrinding_*"))
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Close")
    own = doc.Simulation.ViewObject.Icon.pixmap(64, 64).toImage()
    doc.BeltMachine.Force = "25 N"
    doc.recompute()
    settle()
    assert doc.Simulation.OutOfDate
    stale = doc.Simulation.ViewObject.Icon.pixmap(64, 64).toImage()  # as FreeCAD's tree has it
    assert own.width() == stale.width() == 64

    def same(first, last):
        return [
            own.pixelColor(x, y) == stale.pixelColor(x, y)
            for x in range(first, last)
            for y in range(first, last)
        ]

    assert all(same(0, 22))  # its upper left is the icon's own
    assert same(30, 64).count(False) > 300
    # They stay in memory: a file of the temporary folder may be another user's, and stays behind.
    assert set(Path(FreeCAD.getTempPath()).glob("BeltGrinding_*")) == before
    for name in ("play", "pause", "next", "previous"):
        assert not media_icon(name).isNull()


def test_the_theme_is_the_windows():
    start()
    app = QtGui.QApplication.instance()
    before = app.styleSheet()
    try:
        assert not themes.theme().dark
        app.setStyleSheet("QWidget { background: #202124; color: #e8e8e8; }")
        settle()
        assert themes.theme().dark
        assert (
            themes.readable("#1f5a96").lightnessF() > 0.45
            and themes.theme().warning in themes.warning_style()
        )
        app.setStyleSheet("QWidget { background: #fafafa; color: #202020; }")
        settle()
        assert not themes.theme().dark
        assert themes.readable("#1f5a96").name() == "#1f5a96"
    finally:
        app.setStyleSheet(before)
        settle()


def test_the_first_section_goes_through_what_was_ground():
    _, doc, _ = prepared()
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    field_ = doc.Simulation.Proxy.field(doc.Simulation)
    chosen = section.ground(field_)
    assert 0 < len(chosen) < field_.size
    middle = np.array(section.middle_of_ground(field_))
    low, high = field_.points[chosen].min(axis=0), field_.points[chosen].max(axis=0)
    assert (middle >= low - 1e-9).all() and (middle <= high + 1e-9).all()
    point, normal = section.first_plane(field_)
    np.testing.assert_allclose(point, middle)
    assert sorted(map(abs, normal)) == [0.0, 0.0, 1.0]
    press("Close")
    menu("Cross-section")
    assert doc.Section.RemovedMean.Value > 0.01 and doc.Section.Problem == ""


def test_the_mouse_over_the_surface_or_a_click_on_it_changes_no_colour():
    job, doc, view = prepared()
    menu("Simulate")
    wait(lambda: doc.getObject("Deviation") is not None)
    press("Close")
    view.viewTop()
    view.fitAll()
    settle()

    def move_to(x, y):
        """The mouse, no button pressed, at pixels from the lower left."""
        widget = view_widget()
        ratio = widget.devicePixelRatioF()
        for shift in (-3, -1, 0):
            at = QtCore.QPointF(round(x / ratio) + shift, widget.height() - 1 - round(y / ratio))
            place = QtCore.QPointF(widget.mapToGlobal(at.toPoint()))
            none = QtCore.Qt.NoButton
            event = QtGui.QMouseEvent(
                QtCore.QEvent.MouseMove, at, place, none, none, QtCore.Qt.NoModifier
            )
            QtGui.QApplication.sendEvent(widget, event)
            settle()
            time.sleep(0.15)  # FreeCAD looks a few times a second
            settle()

    def colours():
        width, height = view.getSize()
        view.saveImage("hover.png", width, height, "White")
        image = QtGui.QImage("hover.png")
        seen = []
        for x, y in places:
            a, b = view.getPointOnScreen(FreeCAD.Vector(x, y, top))
            seen.append(image.pixelColor(int(a), height - 1 - int(b)).getRgb()[:3])
        return seen

    box = job.DesignFaces[0][0].Shape.BoundBox
    top = box.ZMax
    places = [
        (box.XMin + u * box.XLength, box.YMin + v * box.YLength)
        for u in (0.1, 0.5, 0.9)
        for v in (0.1, 0.35, 0.9)
    ]
    before = colours()
    assert len(set(before)) > 1
    at = view.getPointOnScreen(FreeCAD.Vector(*places[0], top))
    move_to(*at)
    assert colours() == before
    click_at(*at)
    assert [one.Name for one in Gui.Selection.getSelection()] == ["Deviation"]
    assert colours() == before


def test_tint_and_shell_are_blended_and_a_solid_stocks_edges_are_dashed():
    """In the order of drawing: the tint last, at once and without depth; hidden edges of a stock dashed, others not."""
    job, doc, view = prepared()
    view.viewIsometric()
    view.fitAll()
    scene = view.getSceneGraph()
    bare = seen("bare.png", view)
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    tints = nodes_of(scene, coin.SoTransparencyType)
    assert [one.value.getValue() for one in tints] == [coin.SoTransparencyType.BLEND]
    assert not [
        one for one in nodes_of(scene, coin.SoDepthBuffer) if one.getField("write").getValue()
    ]
    shell = doc.Stock.ViewObject.Proxy.shell
    assert shell.whichChild.getValue() == -3
    # The face is seen through tint and shell: in one tone, wherever it is looked at, and in none of before.
    tinted = seen("tinted.png", view)
    assert len(set(tinted)) == 1 and tinted[0] != bare[0], (tinted, bare)
    doc.Stock.ViewObject.Visibility = False
    settle()
    through = seen("through.png", view)
    assert len(set(through)) == 1 and through[0] != tinted[0], (through, tinted)
    assert through[0][1] > through[0][0], through  # the tint is green, the part's face is not
    doc.Stock.ViewObject.Visibility = True
    press("Cancel")
    assert seen("after.png", view) == bare
    assert not nodes_of(scene, coin.SoTransparencyType)

    # A solid stock: its edges twice, in front of everything whole, behind it dashed.
    solid = doc.addObject("Part::Feature", "Casting")
    solid.Shape = Part.makeBox(64, 44, 22, FreeCAD.Vector(-2, -2, -1))
    doc.recompute()
    doc.Stock.Kind, doc.Stock.Source = "solid", solid
    doc.recompute()
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    depths = [one for one in nodes_of(scene, coin.SoDepthBuffer) if one.function.getValue()]
    found = {}
    for depth in depths:
        parent = above(scene, depth)
        for style in nodes_of(parent, coin.SoDrawStyle):
            if style.lineWidth.getValue() == stock_lines.WIDTH:
                found[depth.function.getValue()] = style.linePattern.getValue()
    assert found == {
        coin.SoDepthBuffer.LEQUAL: 0xFFFF,
        coin.SoDepthBuffer.GREATER: stock_lines.DASHES,
    }, found
    press("Cancel")
    assert not [
        one
        for one in nodes_of(scene, coin.SoDepthBuffer)
        if one.function.getValue() == coin.SoDepthBuffer.GREATER
    ]


def nodes_of(root, kind):
    """The nodes of a kind below a node, in the order of drawing."""
    search = coin.SoSearchAction()
    search.setType(kind.getClassTypeId())
    search.setInterest(coin.SoSearchAction.ALL)
    search.apply(root)
    paths = search.getPaths()
    return [paths[k].getTail() for k in range(paths.getLength())]


def above(root, node):
    """The group that holds a node."""
    search = coin.SoSearchAction()
    search.setNode(node)
    search.apply(root)
    return search.getPath().getNodeFromTail(1)


def seen(name, view):
    """Colours of the view at places of the block's upper face, from edge to edge."""
    settle()
    width, height = view.getSize()
    view.saveImage(name, width, height, "White")
    image = QtGui.QImage(name)
    found = []
    for x, y in ((12, 8), (30, 32), (48, 10), (20, 12), (52, 34)):
        a, b = view.getPointOnScreen(FreeCAD.Vector(x, y, 20))
        found.append(image.pixelColor(int(a), height - 1 - int(b)).getRgb()[:3])
    return found
