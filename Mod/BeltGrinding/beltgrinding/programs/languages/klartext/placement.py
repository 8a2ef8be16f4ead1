"""Where the coordinates of a Klartext program are: datum shift, rotation, tilted plane."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ....base.kinds import Floats
from ...program import Fact, Unknown
from ..core import poses
from ..tool_axis import unit
from ..set_frames import Frame, about

SQUARE = 1e-3  # cosine between two axes
CHAINED = Fact(
    "programs.klartext.order",
    "a datum shift within a rotation or a tilted plane that has one before it depends on the control",
)


class Placement:
    """The chain of a shift, a tilted plane, a shift in it and a rotation about its z."""

    def __init__(self) -> None:
        self.shift, self.inner, self.angle = [0.0] * 3, [0.0] * 3, 0.0
        self.plane: Floats | None = None  # the rotation (3, 3) of the tilted plane
        self.open: set[int] = set()  # axes of the shift that are not known
        self.why: dict[str, Fact] = {}  # settings that are not known here, by what they set

    def shifted(self, values: Mapping[int, tuple[float, bool]]) -> None:
        """Takes {axis: (mm, whether it is an increment)} of a datum shift."""
        if self.angle or self.plane is not None and any(self.shift):
            self.lose("order", CHAINED)
        origin = self.inner if self.plane is not None else self.shift
        for k, (value, more) in values.items():
            origin[k] = origin[k] + value if more else value
            if not more and not self.angle and self.plane is None:
                self.open.discard(k)
        if not self.open:
            self.why.pop("order", None)
            self.why.pop("datum", None)

    def lose(self, what: str, why: Fact) -> None:
        """The shift is not known until each axis of it is said again, outside of rotations and planes."""
        self.why[what], self.open = why, {0, 1, 2}

    def turned(self, degrees: float, more: bool) -> None:
        self.angle = self.angle + degrees if more else degrees

    def tilted(self, rotation: Floats | None) -> None:
        """A plane by its rotation; None: the plane is set back."""
        if self.angle and rotation is not None:
            self.lose("order", CHAINED)
        if rotation is None and any(self.inner):  # is it a shift of what is not tilted?
            self.lose("order", CHAINED)
        self.plane, self.inner = rotation, [0.0] * 3

    def within(self, rotation: Floats) -> Floats:
        """The rotation of a plane that is turned from the one that is set. Raises Unknown."""
        if any(self.inner):
            raise Unknown(CHAINED)
        return rotation if self.plane is None else self.plane @ rotation

    @property
    def unknown(self) -> Fact | None:
        """Why the coordinates are not known, a Fact; None: they are."""
        return next(iter(self.why.values()), None)

    @property
    def frame(self) -> Frame:
        frame = Frame(origin=self.shift)
        if self.plane is not None:
            frame = frame @ Frame(self.plane, self.plane @ self.inner)
        return frame @ Frame(about(2, self.angle)) if self.angle else frame


def spatial(a: float, b: float, c: float) -> Floats:
    """The rotation of PLANE SPATIAL: about the fixed X, then Y, then Z."""
    return about(2, c) @ about(1, b) @ about(0, a)


def euler(precession: float, nutation: float, turn: float) -> Floats:
    """The rotation of PLANE EULER: about Z, about the new X, about the new Z."""
    return about(2, precession) @ about(0, nutation) @ about(2, turn)


def vectors(*values: float) -> Floats:
    """The rotation of PLANE VECTOR: along its x axis, and its normal. Raises Unknown unless these are at a right
    angle: what a control makes of others is a parameter's."""
    x, z = unit(values[:3]), unit(values[3:])
    if x is None or z is None or abs(sum(a * b for a, b in zip(x, z))) > SQUARE:
        raise Unknown("programs.klartext.vector", "TX, TY, TZ are no direction")
    return poses.three_points(_at((0.0, 0.0, 0.0)), _at(x), _at(tuple(np.cross(z, x))))[:3, :3]


def points(*values: float) -> Floats:
    """The rotation of PLANE POINTS: x from the first to the second, y on the side of the third."""
    return poses.three_points(*(_at(values[k : k + 3]) for k in (0, 3, 6)))[:3, :3]


def _at(point: Sequence[float]) -> Floats:
    frame = np.eye(4)
    frame[:3, 3] = point
    return frame


# What PLANE is written with: its words, and the rotation of their values; of RELATIV one of them only.
TILTED: dict[str, tuple[tuple[str, ...], Callable[..., Floats]]] = {
    "SPATIAL": (("SPA", "SPB", "SPC"), spatial),
    "RELATIV": (("SPA", "SPB", "SPC"), spatial),
    "EULER": (("EULPR", "EULNU", "EULROT"), euler),
    "VECTOR": (("BX", "BY", "BZ", "NX", "NY", "NZ"), vectors),
    "POINTS": (tuple(f"P{k}{letter}" for k in (1, 2, 3) for letter in "XYZ"), points),
}
