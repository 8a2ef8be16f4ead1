"""The motions of a Fanuc TP program: where J, L, C, A and S lead, with offsets, and how fast."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path
from typing import Any

import numpy as np

from ....base.frames import to_abc
from ...program import Motion, Reason, Unknown
from ..taught import DIGITS, pose_of
from .position_registers import PositionRegisters
from .positions import Positions
from .registers import INDEX

KINDS = {"J": "PTP", "L": "LIN", "C": "CIRC", "A": "A", "S": "SPL"}
MOTION = re.compile(rf"([JLCAS])\s+(PR|P)\s*{INDEX}\s*(.*)$")
TARGET = re.compile(rf"\s*(PR|P)\s*{INDEX}\s*(.*)$")
SPEED = re.compile(
    rf"({DIGITS}|R{INDEX})\s*(mm/sec|cm/min|inch/min|deg/sec|msec|sec|%)(?=\s|$)\s*(.*)$"
)
MM_PER_S = {"mm/sec": 1.0, "cm/min": 10.0 / 60.0, "inch/min": 25.4 / 60.0}
SECONDS = {"sec": 1.0, "msec": 1e-3}
# Options that move the target, or end the motion before it.
AT_RUN_TIME = ("VOFFSET", "Search", "TrackPR", "Skip")
SHIFTS = re.compile(rf"\b(Tool_Offset|Offset|{'|'.join(AT_RUN_TIME)}|VR\[)", re.IGNORECASE)
OFFSET = re.compile(
    r"\b(Tool_Offset|Offset)\s*,\s*PR\s*\[([^\[\]]*(?:\[[^\[\]]*\])?[^\[\]]*)\]", re.IGNORECASE
)
CONDITIONED = re.compile(r"(?<![\w,])\s*(Tool_Offset|Offset)\b(?!\s*,)", re.IGNORECASE)
CONDITION = re.compile(rf"(TOOL_OFFSET|OFFSET)\s+CONDITION\s+PR\s*{INDEX}(.*)$", re.IGNORECASE)
# What may follow a motion's speed without moving its target: how it ends and what goes on beside it.
OPTIONS = re.compile(
    rf"""\s*,?\s*(?:FINE|CNT\s*(?:\d+|R{INDEX})|C[DR]\s*(?:\d+|R{INDEX})|ACC\s*(?:\d+|R{INDEX})|INC|Wjnt|PTH|RTCP|COORD
    (?:\[\d+\])?|BREAK|PSPD\s*\d+|(?:Ind\.)?EV\s*\d+%|(?:AP|RT)_LDR?\s*(?:\d+|R{INDEX})|MROT|MINCOST|ATTACH
    |(?:Arc|Weld|Spot|Laser|Seal|SPRAY|Glue)\s*(?:Start|End)?\s*{INDEX}
    |(?:TA|TB|DB|T[12]|TIME\s+(?:BEFORE|AFTER))\s*[-+]?\s*[\d.]+\s*(?:sec|mm)?.*)(?=[\s,;]|$)""",
    re.VERBOSE,
)


def zeither(rest: str) -> float | None:
    """mm by the termination type in a motion's additions: FINE stops; CD is the distance from the
    corner, CR its radius (the same where the path turns by 90 degrees); CNT is no length (``share``).
    """
    match = re.search(r"\b(?:(FINE)|C[DR]\s*(\d{1,4}))(?=\s|$)", rest)
    if not match:
        return None
    return 0.0 if match.group(1) else float(match.group(2))


def share(rest: str) -> float | None:
    """Of the speed, that CNT keeps through the corner; None without CNT, and of CNT0: nearly a stop without being one."""
    match = re.search(r"\bCNT\s*(\d{1,3})(?=\s|$)", rest)
    return min(int(match.group(1)), 100) / 100.0 or None if match else None


class Motions(PositionRegisters):
    """Adds the motions of the listing that is followed."""

    NO_ARC = re.compile(r"[JLCS]\s")

    def __init__(self, path: Path | str, values: dict[str, Any] | None = None) -> None:
        super().__init__(path, values)
        self.begin_registers()
        self.positions: Positions = {}
        self.uframe: int | None = None
        self.utool: int | None = None
        self.frames: dict[
            str, str
        ] = {}  # words of frames that the program sets after motions in them
        # Of UFRAME and UTOOL: (line of what may have changed them, whether only selected)
        self.others: dict[str, tuple[int, bool]] = {}
        self.here = None  # (components, base) of the current pose, None: unknown
        self.conditions: dict[
            str, Any
        ] = {}  # of OFFSET and TOOL_OFFSET: (register or a Reason, components)

    def motion(self, line: int, kind: str, register: str, index: str, rest: str) -> None:
        if self.displaced:
            raise Unknown(self.displaced)
        targets = [(register, index)]
        if kind == "C":
            match = TARGET.match(rest)
            if not match:
                raise Unknown("programs.fanuc.no_end_point", "its end point is missing")
            targets.append((match[1], match[2]))
            rest = match.group(3)
        shift, rest = self.offset(kind, rest)
        moved, rate = SHIFTS.search(rest), SPEED.match(rest)
        if moved:
            raise Unknown(
                "programs.known_at_run_time",
                "what {word} does is known at run time only",
                word=moved[1],
            )
        after = rate[4] if rate else ""
        odd = OPTIONS.sub("", after).strip(" ,;")
        if odd:
            raise Unknown("programs.not_understood", "'{text}' is not understood", text=odd[:30])
        motions = [
            self.target(line, KINDS[kind], *target, re.search(r"\bINC\b", rest))
            for target in targets
        ]
        for one in shift:
            motions = [(m, self.shifted(m, one)) for m, _ in motions]
        before = self.here
        for motion, components in motions:
            motion.aux = motion is not motions[-1][0]
            self.here = components and (components, motion.base)
        if motions[-1][0].kind != "PTP":
            speed = self.speed(line, kind, rest, before)
            for motion, _ in motions:
                motion.speed_mm_s = speed
        for motion, _ in motions:
            motion.zone_mm, motion.corner_share = zeither(rest), share(rest)
        for motion, _ in motions:
            (self.add_arc_point if kind == "A" else self.add)(motion)

    def target(
        self, line: int, kind: str, register: str, index: str, incremental: Any
    ) -> tuple[Motion, Any]:
        """(Motion, components) of one position. Raises Unknown."""
        n = self.index(index)
        position: Any = None
        if register == "PR":
            position = (self.position_register(n), None, None)
        else:
            position = self.positions.get(n)
        if position is None:
            raise Unknown("programs.fanuc.not_in_pos", "P[{n}] is not in /POS", n=n)
        if isinstance(position, str):
            raise Unknown(position)
        components, uf, ut = position
        names = self.names_of(n, uf, ut)
        motion = Motion(
            kind, None, self.place(line), self.program.file, tool=names[1], base=names[0]
        )
        if components is None:
            if kind != "PTP":
                raise Unknown("programs.fanuc.joint_position", "P[{n}] is a joint position", n=n)
            return motion, None
        if incremental:
            if self.here is None or self.here[1] != motion.base or any(components[3:]):
                raise Unknown(
                    "programs.fanuc.inc", "INC adds to a pose that is not known, or turns"
                )
            components = [*np.add(self.here[0][:3], components[:3]), *self.here[0][3:]]
        motion.pose = pose_of(components)
        return motion, components

    def names_of(self, n: int, uf: int | None, ut: int | None) -> list[str]:
        """[base, tool] in words of a position in UF and UT, None: those that are selected. Raises Unknown."""
        names = []
        for what, own, current in (("UFRAME", uf, self.uframe), ("UTOOL", ut, self.utool)):
            if None not in (own, current) and own != current:
                raise Unknown(
                    "programs.fanuc.other_frame",
                    "P[{n}] is taught in {what} {own}, selected is {what} {current}",
                    n=n,
                    what=what,
                    own=own,
                    current=current,
                )
            own = current if own is None else own
            name = "" if own is None else f"{what} {own}"
            name = self.frames.get(name, name)
            changed, selected = self.others.get(what, (None, False))
            if changed and not (selected and name):
                name = f"{(name or what).split(' after')[0]} after line {changed}"
            names.append(name)
        return names

    def where(self) -> Any:
        """The current pose's components in the frames that are selected. Raises Unknown."""
        if self.here is None or self.here[1] != self.names_of(0, None, None)[0]:
            raise Unknown("programs.position_before_unknown", "the position before is not known")
        return self.here[0]

    def taught(self, n: int) -> list[float]:
        """The components of P[n]. Raises Unknown."""
        position = self.positions.get(n)
        if not isinstance(position, tuple) or position[0] is None:
            raise Unknown("programs.fanuc.joint_position", "P[{n}] is a joint position", n=n)
        return position[0]

    def offset(self, kind: str, rest: str) -> tuple[list[tuple[str, Any]], str]:
        """([(which side, 4 x 4)] of Offset and Tool_Offset with their PR[n], or that of their CONDITION, the rest
        without them). Raises Unknown."""
        found = [(side.lower(), index) for side, index in OFFSET.findall(rest)]
        plain = OFFSET.sub(" ", rest)
        found += [(side.lower(), None) for side in CONDITIONED.findall(plain)]
        if not found:
            return [], rest
        if kind in "CA" or re.search(r"\bINC\b", rest):
            raise Unknown(
                "programs.fanuc.offset_of_arc",
                "what an offset does to an arc, or with INC, is not known here",
            )
        if len({side for side, _ in found}) < len(found):
            raise Unknown("programs.not_understood", "'{text}' is not understood", text=rest[:30])
        shifts = [
            (side, self.conditioned(side) if n is None else self.position_register(self.index(n)))
            for side, n in found
        ]
        return [(side, pose_of(six)) for side, six in shifts], CONDITIONED.sub(" ", plain)

    def conditioned(self, side: str) -> list[float]:
        """The components of the offset that OFFSET CONDITION has named. Raises Unknown."""
        n, six = self.conditions.get(side, (None, None))
        if n is None:
            raise Unknown(
                "programs.fanuc.no_condition",
                "no {word} CONDITION before it says by how much",
                word=side.upper(),
            )
        if isinstance(n, Reason):
            raise Unknown(n)
        now = self.position_register(n)
        if six != now:
            raise Unknown(
                "programs.fanuc.condition_changed",
                "PR[{n}] is changed after the {word} CONDITION that names it",
                n=n,
                word=side.upper(),
            )
        return now

    def sets_condition(self, text: str) -> bool:
        """Follows OFFSET CONDITION PR[n] and TOOL_OFFSET CONDITION PR[n]; False: it is another statement."""
        match = CONDITION.match(text)
        if not match:
            return False
        side = match.group(1).lower()
        try:
            if match.group(3).strip():
                raise Unknown(
                    "programs.not_understood", "'{text}' is not understood", text=text[:30]
                )
            n = self.index(match.group(2))
            six = None
            with contextlib.suppress(Unknown):  # asked for where a motion needs it
                six = self.position_register(n)
            self.conditions[side] = n, six
        except Unknown as unknown:
            self.conditions[side] = Reason(unknown), None
        return True

    def shifted(self, motion: Motion, shift: tuple[str, Any]) -> list[float]:
        """Moves a Motion by an offset; its new components."""
        side, frame = shift
        if motion.pose is None:
            raise Unknown("programs.fanuc.offset_of_joints", "an offset moves a joint position")
        pose: Any = motion.pose @ frame if side == "tool_offset" else frame @ motion.pose
        motion.pose = pose
        a, b, c = to_abc(pose)
        return [*pose[:3, 3].tolist(), c, b, a]

    def speed(self, line: int, kind: str, rest: str, before: Any) -> float | None:
        """mm/s of a path motion, None (and a Problem) when it is not known."""
        match = SPEED.match(rest)
        try:
            if not match:
                raise Unknown(
                    "programs.fanuc.names_no_speed", "'{text}' names none", text=rest[:30]
                )
            value, unit = self.number(match.group(1)), match.group(3)
            if value <= 0.0:
                raise Unknown("programs.not_positive", "it is not positive")
            if unit in MM_PER_S:
                return value * MM_PER_S[unit]
            length = 0.0
            if unit in SECONDS and kind == "L" and before and self.here[1] == before[1]:
                length = float(np.linalg.norm(np.subtract(self.here[0][:3], before[0][:3])))
            if length == 0.0:
                raise Unknown(
                    "programs.fanuc.no_path_speed",
                    "{text}{unit} tells no path speed",
                    text=match.group(1),
                    unit=unit,
                )
            if value < 1e-6:
                raise Unknown(
                    "programs.fanuc.short_time",
                    "{text}{unit} is too short a time",
                    text=match.group(1),
                    unit=unit,
                )
            return length / (value * SECONDS[unit])
        except Unknown as unknown:
            self.program.need(unknown)
            self.problem(
                line,
                "programs.path_speed_unknown",
                "the path speed is not known: {reason}",
                reason=unknown.fact,
            )
            return None
