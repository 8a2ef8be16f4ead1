"""FreeCAD's own paths as robot programs: ``Path::Feature`` (CAM) and ``Robot::TrajectoryObject``."""

from __future__ import annotations

import math
from collections.abc import Mapping

import FreeCAD
import numpy as np

from ..base.kinds import Floats
from ..engine import InputError
from ..programs.program import CHORD_ERROR, Motion, Program
from ..programs.languages.tool_axis import Tracer, arc_through
from .geometry import matrix
from .kinds import DocumentObject

LARGEST_TURN = 2.0  # degrees between two poses while a rotary axis turns
LINES = {"G0": "PTP", "G00": "PTP", "G1": "LIN", "G01": "LIN"}
ARCS = {"G2": -1.0, "G02": -1.0, "G3": 1.0, "G03": 1.0}
PLANES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
SILENT = ("G40", "G49", "G54", "G80", "G94", "G98", "G99", "G21", "M", "T", "S", "F", "(", ";")
TRAJECTORY = {"PTP": "PTP", "LIN": "LIN", "CIRC": "LIN"}


def is_path(obj: DocumentObject) -> bool:
    """Whether ``program_of`` takes the object."""
    return hasattr(obj, "Trajectory") or hasattr(obj, "Path")


def program_of(obj: DocumentObject) -> Program:
    """The Program of a path object, its lines being the numbers of commands or waypoints from 1.

    A CAM path's poses are contact frames in the document's coordinates (z along the milling tool,
    into the part; x along the motion); a trajectory's are tool frames in the robot's base.
    Raises InputError.
    """
    if hasattr(obj, "Trajectory"):
        return _trajectory(obj)
    if hasattr(obj, "Path"):
        return _Commands(obj).program
    raise InputError(
        "objects.no_path",
        "{object} holds no path; choose a CAM path or a robot's trajectory",
        object=obj.Label,
    )


def _trajectory(obj: DocumentObject) -> Program:
    """Waypoints: Robot::Waypoint knows no arc's auxiliary point, and FreeCAD itself moves its CIRC
    on a line; so does this."""
    program = Program("FreeCAD trajectory", obj.Label)
    base = matrix(obj.Base) if hasattr(obj, "Base") else np.eye(4)
    for number, point in enumerate(obj.Trajectory.Waypoints, 1):
        kind = TRAJECTORY.get(point.Type)
        if point.Type == "CIRC":
            program.problem(
                obj.Label,
                number,
                "objects.no_auxiliary_point",
                "{name}: CIRC has no auxiliary point here; it is taken as a line",
                name=point.Name,
            )
        if kind is None:
            continue  # WAIT: nothing moves
        motion = Motion(kind, base @ matrix(point.Pos), number, obj.Label)
        if kind != "PTP" and point.Velocity > 0:
            motion.speed_mm_s = float(point.Velocity)
        motion.tool, motion.base = f"tool {point.Tool}", f"base {point.Base}"
        program.motions.append(motion)
    return program


def _placement(obj: DocumentObject) -> Floats:
    """Where a path lies in the document; Path::Feature itself knows only its own placement."""
    own = matrix(obj.Placement) if hasattr(obj, "Placement") else np.eye(4)
    group = obj.getParentGeoFeatureGroup()
    return own if group is None else matrix(group.getGlobalPlacement()) @ own


class _Commands:
    """Follows the commands of a Path as FreeCAD draws them (PathSegmentWalker): A, B, C turn the
    point, and here the tool's axis as well, about the path's centre by Rz(-C) Ry(-B) Rx(-A)."""

    def __init__(self, obj: DocumentObject) -> None:
        self.label = obj.Label
        self.program = Program("FreeCAD path", obj.Label)
        self.trace = Tracer(self.program)
        self.placement = _placement(obj)
        self.centre = np.array(obj.Path.Center)
        self.at = np.full(3, math.nan)  # x, y, z of the machine, mm
        self.angles = np.zeros(3)  # A, B, C, degrees
        self.feed: float | None = None  # mm/s
        self.absolute, self.absolute_centre, self.plane = True, False, PLANES["G17"]
        self.noted: set[str] = set()
        for number, command in enumerate(obj.Path.Commands, 1):
            self.command(number, command.Name.upper(), command.Parameters)

    def command(self, number: int, name: str, words: Mapping[str, float]) -> None:
        if words.get("F", 0.0) > 0.0:
            self.feed = float(words["F"])
        if name in LINES or name in ARCS:
            self.move(number, name, words)
        elif name in PLANES:
            self.plane = PLANES[name]
        elif name in ("G90", "G91"):
            self.absolute = name == "G90"
        elif name in ("G90.1", "G91.1"):
            self.absolute_centre = name == "G90.1"
        elif name == "G20":
            self.note(
                number,
                name,
                "objects.inches",
                "G20 has no effect on a path object, which is in mm",
            )
        elif not name.startswith(SILENT):
            self.note(
                number,
                name,
                "objects.unsupported_command",
                "{name} is not supported; where it leads is left out",
                name=name,
            )
            self.trace.gap(number)
            self.at[:] = math.nan

    def note(self, number: int, key: str, code: str, text: str, /, **arguments: object) -> None:
        if key not in self.noted:
            self.noted.add(key)
            self.program.problem(self.label, number, code, text, **arguments)

    def move(self, number: int, name: str, words: Mapping[str, float]) -> None:
        start, before = self.at.copy(), self.angles.copy()
        for k, word in enumerate("XYZ"):
            if word in words:
                self.at[k] = words[word] + (0.0 if self.absolute else self.at[k])
        for k, word in enumerate("ABC"):
            self.angles[k] = words.get(word, self.angles[k])
        if not np.isfinite(self.at).all():
            return  # the first commands name one axis after the other
        known = np.isfinite(start).all()
        turn = float(np.abs(self.angles - before).max())
        if name in ARCS and known:
            through, points = self.arc(number, ARCS[name], start, words, turn > 0)
            for k, point in enumerate(through):
                place, axis = self.placed(point, self.angles)
                self.trace.move("CIRC", place, axis, number, self.feed, aux=k % 2 == 0)
        else:
            points = [self.at.copy()]
        parts = max(1, math.ceil(turn / LARGEST_TURN / len(points))) if known and points else 1
        legs = [start if known else self.at, *points]
        kind = LINES.get(name, "LIN")
        for k in range(1, len(legs)):
            for j in range(1, parts + 1):
                share = (k - 1 + j / parts) / (len(legs) - 1)
                point = legs[k - 1] + (legs[k] - legs[k - 1]) * (j / parts)
                place, axis = self.placed(point, before + share * (self.angles - before))
                self.trace.move(kind, place, axis, number, self.feed)

    def arc(
        self, number: int, side: float, start: Floats, words: Mapping[str, float], turning: bool
    ) -> tuple[list[Floats], list[Floats]]:
        """(points of arcs in pairs: one on the way, the end; points of chords): a plane arc is the
        first, a helix or an arc while a rotary axis turns the second."""
        u, v, w = self.plane
        offset = np.array([words.get(axis, 0.0) for axis in "IJK"], dtype=float)
        centre = offset if self.absolute_centre else start + offset
        centre[w] = start[w]
        normal = np.zeros(3)
        normal[w] = side
        radius = float(np.linalg.norm(start - centre))
        end = self.at.copy()
        full = float(np.linalg.norm((end - start)[[u, v]])) < 1e-9
        if radius < 1e-9:
            self.note(
                number,
                "arc",
                "objects.arc_without_centre",
                "an arc without centre (I, J, K) is taken as a line",
            )
            return [], [end]
        if not turning and abs(end[w] - start[w]) < 1e-9:
            ends = (start.tolist(), centre.tolist(), end.tolist())
            through = arc_through(*ends, normal.tolist(), full)
            return [*(np.array(point) for point in through), end], []
        a, b = start - centre, end - centre
        side_way = np.cross(normal, a)
        angle = math.atan2(float(b @ side_way), float(b @ a)) % (2 * math.pi)
        angle = 2 * math.pi if full or angle < 1e-9 else angle
        chord = 2 * math.acos(max(-1.0, 1 - CHORD_ERROR / radius)) if radius > CHORD_ERROR else 1.0
        t = np.linspace(0.0, 1.0, max(3, math.ceil(angle / chord) + 1))[1:, None]
        points = centre + np.cos(t * angle) * a + np.sin(t * angle) * side_way
        points[:, w] = start[w] + t[:, 0] * (end[w] - start[w])
        return [], [*points[:-1], end]

    def placed(self, point: Floats, angles: Floats) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Position in mm and axis, from the part to the spindle, in the document."""
        a, b, c = angles
        turn = FreeCAD.Rotation(-float(c), -float(b), -float(a))
        place = turn.multVec(FreeCAD.Vector(*(point - self.centre))) + FreeCAD.Vector(*self.centre)
        axis = turn.multVec(FreeCAD.Vector(0, 0, 1))
        place = self.placement @ [*place, 1.0]
        return tuple(place[:3].tolist()), tuple((self.placement[:3, :3] @ list(axis)).tolist())
