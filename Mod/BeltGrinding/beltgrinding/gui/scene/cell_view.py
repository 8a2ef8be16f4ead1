"""The cell at a pose, drawn into a document's 3D views: wheel, tool, bodies, robot, moving part.

All nodes are in the part's coordinates, which are the document's. While the cell is shown as it
moves, a transform before all that is drawn in the view carries the part through the cell.
"""

from __future__ import annotations

import weakref
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import FreeCADGui as Gui
import numpy as np
from pivy import coin

from ...base.frames import work_from_frames
from ...base.kinds import known
from ...geometry.body_names import WHEEL
from ...objects import belt_machine, bodies
from ...objects.kinds import Document, DocumentObject
from ..common.kinds import Array, Node, Surface, View3D
from . import belt_shapes, loads
from .part_context import mesh_of_part
from .robot_view import RobotView
from .shapes3d import (
    axes,
    body,
    faint,
    material,
    mesh_of,
    separator,
    set_matrix,
    unpickable,
    wheel,
)

# Frames beside those of the base of the programs, which goes with a part on a positioner: what stands in the cell.
STANDING = "standing"
PLACES = {
    "wheel": "contact",
    "base": STANDING,
}  # where a body goes, if it is not called as in a job
ALARM, CLOSE = (0.86, 0.12, 0.10), (0.93, 0.62, 0.05)  # of what meets, of what is near
TINT, FADE = "BeltGrindingTint", "BeltGrindingFade"
CELL: dict[str, Any] = {
    "holding": "tool_in_hand",
    **dict.fromkeys(
        ("base_from_work", "tcp_from_contact", "tcp_from_work", "base_from_contact"), np.eye(4)
    ),
}


SHOWN = "Loads"  # property of a machine's view: whether arrows show what acts at the contact
_open: weakref.WeakSet[CellView] = weakref.WeakSet()


def redraw_loads(machine: DocumentObject) -> None:
    """Draws the loads of a machine anew wherever its cell is shown: its view's property, or a unit, is another."""
    for cell in _open:
        if cell.machine == machine and cell.scenes:
            cell.draw_loads()


class CellView:
    """Draws the cell of ``machine`` (None: only the tool frame) at the poses of a path."""

    def __init__(self, document: Document, machine: DocumentObject | None) -> None:
        self.machine = machine
        self.poses = np.zeros((0, 4, 4))
        self.pose, self.moving = 0, False
        self.frame: Array | None = None  # between two poses
        self.motions: Mapping[str, Array] | None = None  # feeds, forces, rapid of the poses
        self.load: loads.Load | None = None  # at ``frame``
        self.loads = coin.SoGroup()
        self.carrier = coin.SoMatrixTransform()
        self.places = {name: coin.SoMatrixTransform() for name in ("contact", "tool", STANDING)}
        self.things = {name: coin.SoGroup() for name in (*self.places, "part")}
        self.root = separator(unpickable())
        for name, things in self.things.items():
            nodes = [self.places[name]] if name in self.places else []
            self.root.addChild(separator(*nodes, things))
        self.bodies: dict[str, Node] = {}  # by their names
        self.tinted: tuple[str, ...] = ()  # names of bodies
        self.tone = ALARM
        self.belt: dict[str, Any] | None = None  # of a machine without a wheel, as a job has it
        self.part: Surface | None = None
        self.pressed = False  # the belt is drawn as the part presses it
        self.root.addChild(separator(self.places["contact"], self.loads))
        self.robot = RobotView()
        self.root.addChild(self.robot.root)
        self.scenes = [
            view.getSceneGraph()
            for view in Gui.getDocument(document.Name).mdiViewsOfType("Gui::View3DInventor")
        ]
        for scene in self.scenes:
            scene.insertChild(self.carrier, 0)
            scene.addChild(self.root)
        _open.add(self)
        self.rebuild()

    def close(self) -> None:
        for scene in self.scenes:
            for node in (self.carrier, self.root):
                if scene.findChild(node) >= 0:
                    scene.removeChild(node)
        self.scenes = []

    def set_path(self, poses: Array, motions: Mapping[str, Array] | None = None) -> None:
        """base_from_tcp (n, 4, 4) in mm of the path that is walked. ``motions``: the arrays that ``loads.of_motion`` takes."""
        self.poses, self.pose, self.frame = np.asarray(poses, dtype=float), 0, None
        self.motions = motions
        self.update()

    def set_pose(self, index: int) -> None:
        self.pose, self.frame = index, None
        self.update()

    def set_frame(self, base_from_tcp: Array, load: loads.Load | None = None) -> None:
        """Shows the tool at a frame (4, 4) in mm that need not be a pose's, and the load there, where it is known."""
        self.frame, self.load = base_from_tcp, load
        self.update()

    def set_moving(self, moving: bool) -> None:
        """True: the part moves where the robot holds it; False: it stays, the wheel moves."""
        self.moving = moving
        self.update()

    def rebuild(self) -> None:
        """Draws wheel and bodies anew, after the machine was changed."""
        for things in self.things.values():
            things.removeAllChildren()
        size = 50.0
        if self.machine is not None:
            size = belt_machine.half_size(self.machine)
            self.bodies = _pressing(self.machine)
            self._take_part(self.machine)
            for node in self.bodies.values():
                self.things["contact"].addChild(node)
            for name, frame, obj in bodies.listed(self.machine):
                self.bodies[name] = body(obj)
                self.things[PLACES.get(frame, frame)].addChild(self.bodies[name])
            self.robot.choose(self.machine.Proxy.robot(self.machine))
            self.bodies.update(self.robot.bodies)
            self.tint(self.tinted, self.tone)
        self.things["tool"].addChild(axes(0.3 * size))
        self.update()

    def _take_part(self, machine: DocumentObject) -> None:
        """What presses on a belt, where that is no wheel."""
        self.belt, self.part, self.pressed = None, None, False
        job = machine.getParentGroup()
        if machine.Kind in belt_machine.WHEELS or not hasattr(job, "DesignFaces"):
            return
        self.belt, self.part = belt_shapes.as_job(machine), mesh_of_part(job)

    def _press(self, contact: Array) -> None:
        """Draws the belt as the part presses it at the pose."""
        if self.belt is None or self.part is None or not len(self.part[1]):
            return
        points, triangles = self.part
        points = (points - contact[:3, 3]) @ contact[:3, :3]
        self.pressed = belt_shapes.press(
            self.bodies[""], self.belt, points, triangles, self.pressed
        )

    def tint(self, names: Collection[str], tone: tuple[float, float, float] = ALARM) -> None:
        """Draws the bodies of these names, as events have them, in a warning colour; the others in
        their own."""
        self.tinted, self.tone = tuple(names), tone
        for name, node in self.bodies.items():
            colour = None
            if name in self.tinted:
                colour = material(tone, 0.4)
                colour.setOverride(True)
            _put_first(node, TINT, colour)

    def fade(self, names: Collection[str]) -> None:
        """Draws the bodies of these names see-through; the others as they are."""
        for name, node in self.bodies.items():
            _put_first(node, FADE, faint() if name in names else None)

    def solids(self) -> dict[str, Surface]:
        """{name as events have it: (points (n, 3) mm, triangles (m, 3))} of bodies and robot at the pose,
        in the part's coordinates."""
        if self.machine is None:
            return {}
        frames, found = self.frames(), self.robot.solids()
        for name, frame, obj in bodies.listed(self.machine):
            points, faces = (np.array(one) for one in mesh_of(obj))
            if len(faces) and PLACES.get(frame, frame) in frames:
                place = frames[PLACES.get(frame, frame)]
                found[name] = points @ place[:3, :3].T + place[:3, 3], faces
            elif len(faces):
                found[name] = points, faces
        return found

    def cell(self) -> dict[str, Any]:
        return CELL if self.machine is None else self.machine.Proxy.cell(self.machine)

    def frames(self) -> dict[str, Array]:
        """{frame: work_from_frame} at the pose."""
        found = work_from_frames(self.base_from_tcp(), **self.cell())
        return {**found, STANDING: found["base"] @ self.robot.standing}

    def base_from_tcp(self) -> Array:
        return self.poses[self.pose] if self.frame is None else self.frame

    def update(self) -> None:
        """Puts everything where it is at the pose."""
        if not len(self.poses):
            return
        self.robot.stand(self.pose)
        frames = self.frames()
        for name, node in self.places.items():
            set_matrix(node, frames[name])
        set_matrix(self.carrier, self.carried(frames))
        self._press(frames["contact"])
        self.robot.place(frames["base"], self.base_from_tcp(), self.pose)
        self.draw_loads()

    def draw_loads(self) -> None:
        """Draws what acts at the contact, unless the machine's view says no."""
        self.loads.removeAllChildren()
        machine = self.machine
        if machine is None or not getattr(machine.ViewObject, SHOWN, False) or not len(self.poses):
            return
        load = self._load()
        if load is not None:
            frame = self.frames()["contact"]
            self.loads.addChild(loads.arrows(machine, load, frame, self.moving))

    def _load(self) -> loads.Load | None:
        """What acts at the frame, or at the pose; None where that is not known."""
        if self.frame is not None:
            return self.load
        if self.motions is None:
            return None
        to = min(self.pose + 1, len(self.poses) - 1)
        if to < 1:
            return None
        ends = work_from_frames(self.poses[to - 1 : to + 1], **self.cell())["contact"][:, :3, 3]
        return loads.of_motion(self.motions, known(self.machine), to, ends[1] - ends[0])

    def carried(self, frames: Mapping[str, Array]) -> Array:
        """How the part has moved in the cell since the first pose; it lies as drawn there."""
        if not self.moving:
            return np.eye(4)
        start = work_from_frames(self.poses[0], **self.cell())["base"]
        return start @ np.linalg.inv(frames["base"])

    def nearest(self, view: View3D, position: Sequence[float], reach: float) -> int | None:
        """Index of the pose whose contact point is drawn within ``reach`` pixels of ``position``
        (x, y from the lower left), None if there is none."""
        points = work_from_frames(self.poses, **self.cell())["contact"][:, :3, 3]
        ends = np.hstack([points, np.ones((len(points), 1))])
        seen, depth = project(view, ends @ self.carried(self.frames()).T)
        distance = np.linalg.norm(seen - np.asarray(position, dtype=float), axis=1)
        near = np.flatnonzero(distance <= reach)
        # Of those that lie on one another, what is in front is meant.
        return (
            int(near[np.lexsort((depth[near], np.round(distance[near])))[0]]) if len(near) else None
        )


def _pressing(machine: DocumentObject) -> dict[str, Node]:
    """{name as events have it: node} of what presses on the part."""
    if machine.Kind in belt_machine.WHEELS:
        more = {} if machine.Kind == belt_machine.WHEEL else belt_shapes.fork_parts(machine)
        return {WHEEL: wheel(machine), **more}
    return belt_shapes.parts(machine)


def _put_first(group: Node, name: str, node: Node | None) -> None:
    """Puts a node of this name before a group's others, in place of one of that name; None: none."""
    for k in reversed(range(group.getNumChildren())):
        if group.getChild(k).getName() == name:
            group.removeChild(k)
    if node is not None:
        node.setName(name)
        group.insertChild(node, 0)


def project(view: View3D, points: Array) -> tuple[Array, Array]:
    """(pixels (n, 2) from the lower left, depth (n,)) of homogeneous points (n, 4)."""
    width, height = view.getSize()
    volume = view.getCameraNode().getViewVolume(width / height)
    if width < height:  # as SoCamera::ADJUST_CAMERA does
        volume.scale(height / width)
    matrix = np.array(volume.getMatrix().getValue()).reshape(4, 4)
    clip = points @ matrix
    clip = clip[:, :3] / np.where(np.abs(clip[:, 3:]) < 1e-12, 1e-12, clip[:, 3:])
    return (clip[:, :2] + 1.0) * 0.5 * np.array([width, height]), clip[:, 2]
