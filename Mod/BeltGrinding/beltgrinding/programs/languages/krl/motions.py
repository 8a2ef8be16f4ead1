"""The motions of KRL: targets, circles, approximation, and what WITH sets for one motion or a spline block."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Mapping, Sequence, Set
from dataclasses import replace
from typing import Any

import numpy as np

from ....base.kinds import known
from ... import one_frame
from ...program import MAX_COORDINATE, Motion, Unknown, joint_angles
from .parts import Parts
from . import circles
from ..core.expression import Place, Token
from .expression import FRAME, Parser, check_target, components_of, frame_of, lacking
from .numbers import number
from .settings import FRAMES
from .types import EXTERNAL
from .values import Lost, Members, Steps

SPEED = re.compile(
    r"(?:\$VEL\.CP\s*=|\$VEL\s*=\s*\{\s*(?:\w+\s*:\s*)?CP\s|SVEL_CP\s*\()\s*([^,)}\s]+)",
    re.IGNORECASE,
)
APPROXIMATIONS = {"c_dis", "c_spl", "c_vel", "c_ori", "c_ptp"}
# What WITH may set: what a pose depends on, and what it does not.
FOLLOWED = {"$vel", "$base", "$tool", "$ipo_mode", "$ori_type", "$circ_type", "$apo"}
WITHOUT_EFFECT = set(
    "$acc $load $load_a1 $load_a2 $load_a3 $gear_jerk $jerk $vel_axis $acc_axis $vel_extax $acc_extax "
    "$collmon_tol_pro $torqmon $ex_ax_ignore $adap_acc $opt_move $spl_vel_mode $cp_vel_type $spl_ori_joint_auto "
    "$vel_ptp $acc_ptp $acc_ext_ax $vel_ext_ax $cp_statmon $target_status".split()
)


class Motions(Parts):
    """Part of the interpreter (reader.py); what it needs of the others is theirs."""

    def motion(self, line: int, kind: str, text: str) -> None:
        if self.spline is not False and kind.split("_")[0] in ("PTP", "LIN", "CIRC", "SPTP"):
            self.leave_spline(line)
        self.reached(line)
        saved: list[tuple[str, Any]] = []
        try:
            if self.block_reason is not None:
                raise Unknown(self.block_reason)
            targets, angle, words, settings = _parsed(kind, text)
            self.zeroed = False
            targets = [target(self) for target in targets]
            zeroed = self.zeroed
            angle = angle and circles.angle(angle(self))
            saved = self.set_for_now(line, settings)
            self.add(line, kind, targets, angle, words)
            if zeroed:
                self.say_zeroed(line)
        except Unknown as unknown:
            self.lose_calls(line, text, unknown.told)
            self.problem(
                line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=kind,
                reason=unknown.fact,
            )
            self.gap(line)
        finally:
            self.put_back(saved)

    def set_for_now(self, line: int, settings: list[Token]) -> list[tuple[str, Any]]:
        """Sets what stands behind WITH, given as tokens; returns what was there before, for ``put_back``.
        Raises Unknown, with nothing set, where it is not understood."""
        found: list[tuple[str, Steps, Any, str]] = []
        for part in _parts(settings):
            parser = Parser(part)
            value: Any = None
            target = parser.path()
            try:
                name, steps = self.path(target)
            except Unknown as unknown:
                (name, steps), value = self.covered, Lost(unknown.told)
            if name in WITHOUT_EFFECT:
                continue
            if name not in FOLLOWED:
                raise Unknown(
                    "programs.not_understood_there",
                    "'{found}' is not understood there",
                    found=name.upper(),
                )
            if value is None:
                value = self.frame_or_value(parser, name, steps)
            text = " ".join(t for _, t, _ in part).partition("=")[2]
            found.append((name, steps, value, text))
        saved = [(name, self.values.save(name)) for name in dict.fromkeys(f[0] for f in found)]
        for name, steps, value, text in found:
            self.store(line, name, steps, value, text)
        return saved

    def frame_or_value(self, parser: Parser, name: str, steps: Steps) -> Any:
        """The value of an assignment where a Parser stands, to its end; Lost where it is not known."""
        try:
            parser.expect("=")
            value = parser.infix()
            parser.end()
            if name in FRAMES and not steps and isinstance(value, Place):
                if value.name.lower() != "$nullframe":
                    return self.frame_value(*self.path(value))
            return value(self)
        except Unknown as unknown:
            return Lost(unknown.told)

    def put_back(self, saved: Sequence[tuple[str, Any]]) -> None:
        for name, before in saved:
            self.values.restore(name, before)

    def enter_spline(self, line: int, text: str) -> None:
        """SPLINE, with what WITH sets for the whole block."""
        self.leave_spline(line, quiet=self.spline is False)
        self.spline = True
        try:
            parser = Parser(text)
            parser.next()
            self.block_saved = self.set_for_now(line, _behind(parser, "")[1])
        except Unknown as unknown:
            self.lose_calls(line, text, unknown.told)
            self.block_reason = unknown.told

    def leave_spline(self, line: int, quiet: bool = False) -> None:
        """The end of a spline block; one that is missing is told."""
        if not quiet and self.spline:
            self.problem(
                line,
                "programs.krl.no_block_end",
                "{word} has no {end}",
                word="SPLINE",
                end="ENDSPLINE",
            )
        self.put_back(self.block_saved)
        self.block_saved, self.block_reason, self.spline = [], None, False

    def end_spline(self, line: int, text: str) -> None:
        inside = self.spline
        self.leave_spline(line, quiet=True)
        words = {word.lower() for word in text.split()[1:]}
        if (
            inside is not False and self.program.motions
        ):  # its own word rounds the block's last corner
            zone = None if words - APPROXIMATIONS else self.zone(words)
            self.program.motions[-1].zone_mm = zone

    def add(
        self, line: int, kind: str, targets: Sequence[Any], angle: float | None, words: Set[str]
    ) -> None:
        """Adds a motion to its targets. Raises Unknown, with none added."""
        frames = self.frames_now()
        zone = self.zone(words)
        start, first = self.here_in(frames), len(self.program.motions)
        try:
            for k, target in enumerate(targets):
                self.program.motions.append(
                    self.target(line, kind, target, k + 1 < len(targets), words, frames, start)
                )
            if angle is not None:
                self.by_angle(line, first, start, angle)
        except Unknown:
            del self.program.motions[first:]
            raise
        last = self.program.motions[-1]
        turn = "" if "PTP" in kind else self.turning.of(line, self.problem)
        for motion in self.program.motions[first:]:
            motion.turn = turn
            motion.zone_mm = zone if motion is last or angle is None else motion.zone_mm
        self.here = None if last.pose is None else self.last_components
        self.here_frames = frames

    def here_in(self, frames: Sequence[str]) -> Mapping[str, Any] | None:
        """The components of the pose before in the frames of a motion; None where they are not known."""
        if self.here is None or frames == self.here_frames:
            return self.here
        tool, base = self.here_frames
        way, _ = one_frame.way(self.program, (frames[1], frames[0]), (base, tool))
        if way is None or any(name not in self.here for name in FRAME):
            return None
        return components_of(way[0] @ frame_of(self.here) @ way[1])

    def target(
        self,
        line: int,
        kind: str,
        target: Any,
        aux: bool,
        words: Set[str],
        frames: Sequence[str],
        here: Mapping[str, Any] | None,
    ) -> Motion:
        """The Motion to a target."""
        if not isinstance(target, Members) or any(isinstance(step, tuple) for step in target):
            raise Unknown("programs.krl.no_pose", "its target is no pose")
        check_target(target)
        simple = {"SPTP": "PTP", "SLIN": "LIN", "SCIRC": "CIRC"}.get(
            kind.replace("_REL", ""), kind.replace("_REL", "")
        )
        motion = Motion(simple, None, line, self.file, aux=aux)
        motion.tool, motion.base = frames
        motion.external = _external(target)
        if any(f"a{k}" in target for k in range(1, 7)):
            if simple != "PTP" or kind.endswith("_REL"):
                raise Unknown("programs.joint_target", "its target is a joint position")
            angles = [target.get(f"a{k}", target.rest) for k in range(1, 7)]
            for angle in angles:
                if isinstance(angle, Lost):
                    raise Unknown(angle.told)
            motion.joints_deg = joint_angles(angles)
            return motion
        given = {name: float(number(target[name])) for name in FRAME if name in target}
        if len(given) < len(FRAME) and isinstance(target.rest, Lost):
            raise lacking(target, [])
        if not given:
            raise Unknown("programs.krl.no_component", "its target names no component of a pose")
        components: Mapping[str, Any] = (
            given if kind.endswith("_REL") else {**(here or {}), **given}
        )
        if kind.endswith("_REL"):
            components = self.relative(given, words, here)
        elif aux and here is None:
            components = {**dict.fromkeys("abc", 0.0), **given}
        missing = [name.upper() for name in FRAME if name not in components]
        if missing:
            raise Unknown(
                "programs.krl.not_given",
                "{names} is not given, and the pose before is not known",
                names=", ".join(missing),
            )
        motion.pose = frame_of(components)
        if np.abs(motion.pose[:3, 3]).max() > MAX_COORDINATE:
            raise Unknown("programs.position_out_of_bounds", "the position is out of all bounds")
        motion.speed_mm_s = None if simple == "PTP" else self.speed_now()
        self.last_components = components
        return motion

    def relative(
        self, given: Mapping[str, float], words: Set[str], here: Mapping[str, Any] | None
    ) -> Mapping[str, Any]:
        if here is None:
            raise Unknown(
                "programs.krl.relative_to_unknown", "it is relative to a pose that is not known"
            )
        if "#tool" in words:
            step = {**dict.fromkeys(FRAME, 0.0), **given}
            return components_of(frame_of(here) @ frame_of(step))
        return {name: here[name] + given.get(name, 0.0) for name in FRAME}

    def by_angle(
        self, line: int, first: int, start: Mapping[str, Any] | None, angle: float
    ) -> None:
        """An arc, the motions from number ``first`` on, that ends behind an angle (CA) instead of at its
        second point."""
        through, end = self.program.motions[first:]
        if start is None or any(name not in start for name in FRAME):
            raise Unknown(
                "programs.krl.circle_start",
                "where a circle by an angle (CA) ends depends on the pose before, which is not known",
            )
        begin = frame_of(start)
        turn = self.turning.of(line, self.problem)
        found = circles.arcs(begin, known(through.pose), known(end.pose), angle, turn)
        if np.abs(begin[:3, :3] - known(end.pose)[:3, :3]).max() > 1e-3 and "hold" not in turn:
            self.problem(
                line,
                "programs.krl.circle_turn",
                "the circle ends at its angle (CA) with the orientation of its second point, as here; "
                "a controller that is set to extrapolate it turns further",
            )
        del self.program.motions[first:]
        for middle, last in found:
            self.program.motions.append(replace(through, pose=middle, zone_mm=math.inf))
            self.program.motions.append(replace(end, pose=last, zone_mm=math.inf))
        self.last_components = components_of(found[-1][1])

    def zone(self, words: Set[str]) -> float | None:
        """mm by the approximation of a motion: without one the robot stops; C_DIS and C_SPL
        begin at $APO.CDIS; the others (C_VEL, C_ORI, C_PTP) name no length: not known.
        """
        if self.spline is not False:
            return math.inf if self.spline else None  # None: where the block ends is not known
        words = words & APPROXIMATIONS
        if not words:
            return 0.0
        if words & {"c_dis", "c_spl"}:
            distance = self.values.peek("$apo", ("cdis",))
            return max(0.0, distance) if isinstance(distance, float) else None
        return None

    def say_zeroed(self, line: int) -> None:
        if "zeroed" not in self.missing:
            self.missing.add("zeroed")
            self.problem(
                line,
                "programs.krl.zeroed",
                "components that a frame at ':' does not name are taken as 0, here and further on",
            )


@functools.lru_cache(maxsize=256)  # for loops
def _parsed(kind: str, text: str) -> tuple[list[Any], Any, frozenset[str], list[Token]]:
    """(targets, angle or None, approximations, settings) of a motion's text. Raises Unknown."""
    parser = Parser(text)
    targets, angle = [parser.infix()], None
    if "CIRC" in kind:
        parser.expect(",")
        targets.append(parser.infix())
        angle = circles.angle_behind(parser)
    return targets, angle, *_behind(parser, kind)


def _external(target: Members) -> tuple[float, ...]:
    """E1, E2 .. of a target, as far as it gives them one after the other."""
    found: list[float] = []
    for name in EXTERNAL:
        value = target.get(name)
        if value is None or isinstance(value, Lost):
            break
        found.append(float(number(value)))
    return tuple(found)


def _behind(parser: Parser, kind: str) -> tuple[frozenset[str], list[Token]]:
    """(approximations and #BASE or #TOOL, the tokens behind WITH) of what follows a motion's targets.
    Raises Unknown where it is not understood."""
    words: set[str] = set()
    settings: list[Token] = []
    relative = ("#base", "#tool") if "_REL" in kind else ()
    while parser.peek() is not None:
        word = str(parser.peek()).lower()
        if word == "with":
            settings = parser.tokens[parser.at + 1 :]
            while settings and settings[-1][1].lower() in APPROXIMATIONS:
                words.add(settings[-1][1].lower())
                settings = settings[:-1]
            break
        if word not in APPROXIMATIONS and word not in relative:
            parser.end()
        words.add(word)
        parser.at += 1
    return frozenset(words), settings


def _parts(settings: list[Token]) -> list[list[Token]]:
    """Lists of tokens between the commas that are in no brackets."""
    parts: list[list[Token]] = [[]]
    depth = 0
    for token in settings:
        depth += (token[1] in ("(", "[", "{")) - (token[1] in (")", "]", "}"))
        if token[1] == "," and depth == 0:
            parts.append([])
        else:
            parts[-1].append(token)
    return parts if settings else []
