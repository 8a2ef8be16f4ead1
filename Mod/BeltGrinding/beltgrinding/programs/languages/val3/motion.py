"""The motions of a VAL3 program: targets, tools and speeds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...program import Fact, Motion, Unknown
from ..core.tree import Node
from . import data
from .control import Control
from .data import Missing, Record, number, six
from .expression import split

NO_TVEL = Fact(
    "programs.val3.no_tvel", "the mdesc sets no tvel, and vel is a share of the joints' speed"
)
ALTERED = ("alterMovej", "alterMovel", "alterMovec", "alter")  # whose path changes at run time
KINDS = {"movej": "PTP", "movel": "LIN", "movec": "CIRC"}


class Motions(Control):
    """Adds the motions."""

    def motion(self, node: Node, target: str | None, word: str, text: str) -> None:
        self.reached(node.line)
        try:
            if word not in KINDS:
                raise Unknown(
                    "programs.val3.motion_at_run_time",
                    "this motion is decided at run time, or is not known",
                )
            row = split(text)
            count = 2 if word == "movec" else 1
            if len(row) != count + 2:
                raise Unknown(
                    "programs.val3.arguments",
                    "it has {count} arguments instead of {expected}",
                    count=len(row),
                    expected=count + 2,
                )
            targets = [self.value(part) for part in row[:count]]
            self.move(node.line, KINDS[word], targets, row[count], row[count + 1])
        except Unknown as unknown:
            self.problem(
                node.line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=word,
                reason=unknown.fact,
            )
            self.gap(node.line)
        if target:
            self.unknown(
                target.strip(),
                Fact("programs.val3.motion_number", "it numbers a motion at run time"),
            )

    def move(self, line: int, kind: str, targets: Sequence[Any], tool: str, mdesc: str) -> None:
        end = targets[-1]
        if (
            isinstance(end, list) and kind == "PTP"
        ):  # {..} without a type: joints, as many as it has
            end = data.as_kind("jointRs" if len(end) == 4 else "joint", end)
        if isinstance(end, Record) and end.kind == "joint":
            if kind != "PTP":
                raise Unknown("programs.joint_target", "its target is a joint position")
            for name in end.fields:
                number(end.get(name))
            motion = Motion("PTP", None, line, self.file, tool=self.tool(line, tool))
            self.program.motions.append(motion)
            return
        rows: list[data.Six] = []
        if not all(isinstance(one, Record) and one.kind == "point" for one in targets):
            raise Unknown("programs.val3.no_point", "its target is no point")
        for point in targets:
            row = six(point.get("trsf"))
            if isinstance(point.father, Missing):
                raise Unknown(point.father.why)
            if point.father is None and not any(row):
                raise Unknown(
                    "programs.val3.not_taught",
                    "the point has no value: it was not taught, or the .dtx is not whole",
                )
            if isinstance(end.father, Missing):
                raise Unknown(end.father.why)
            if point.father is not end.father:  # an arc's point in another frame
                home = data.in_world(end.father) if end.father else (0.0,) * 6
                row = data.product(data.inverse(home), data.in_world(point))
            rows.append(row)
        base, held = self.described(end.father, "world"), self.tool(line, tool)
        speed = self.speed(line, kind, mdesc)
        for k, row in enumerate(rows):
            motion = Motion(kind, None, line, self.file, speed, tool=held, base=base)
            motion.aux = k < len(rows) - 1
            self.program.motions.append(motion)
            self.rows.append((motion, row))

    def tool(self, line: int, text: str) -> str:
        try:
            value = self.value(text)
            if not isinstance(value, Record) or value.kind != "tool":
                raise Unknown("programs.val3.no_tool", "it is no tool")
            return self.described(value, "flange")
        except Unknown as unknown:
            self.problem(
                line,
                "programs.val3.tool_unknown",
                "the tool {text} is not known: {reason}",
                text=text[:40],
                reason=unknown.fact,
                once=("tool", text),
            )
            return text[:40]

    def speed(self, line: int, kind: str, text: str) -> float | None:
        """mm/s; None for a joint motion or where no path speed is set."""
        if kind == "PTP":
            return None
        try:
            value = self.value(text)
            if not isinstance(value, Record) or value.kind != "mdesc":
                raise Unknown("programs.val3.no_mdesc", "{text} is no mdesc", text=text[:40])
            speed = number(value.get("tvel"))
            if speed <= 0:
                raise Unknown("programs.val3.speed_not_positive", "tvel is not positive")
            if speed < data.NO_LIMIT:
                return speed * self.project.unit
            raise Unknown(NO_TVEL)
        except Unknown as unknown:
            self.problem(
                line,
                "programs.val3.speed_unknown",
                "the path speed of {text} is not known: {reason}; the default is used",
                text=text[:40],
                reason=unknown.fact,
                once=("speed", text, unknown.fact),
            )
            return None
