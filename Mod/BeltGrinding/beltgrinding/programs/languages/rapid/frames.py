"""Tools and work objects of a RAPID program, and where the robot is in them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ....base.kinds import Json
from ...program import Fact, Program, Unknown, name_of
from ..core.expression import Place
from ..core.telling import Telling
from . import data
from .data import inverse, pose_of, product
from .expression import name_of as named
from .state import State

TOOL = Fact("programs.rapid.tool", "tool")
WORK_OBJECT = Fact("programs.rapid.work_object", "work object")


class Frames(Telling, State):
    """Names frames in words, and knows the current pose."""

    def __init__(self, path: Path | str, given: Json | None = None) -> None:
        Telling.__init__(self)
        State.__init__(self)
        self.given = given or {}
        self.file = name_of(path)
        self.program = Program("ABB RAPID", self.file)
        self.here: tuple[Any, str, str] | None = None  # target, tool, work object; None: not known
        self.asked = False  # whether the program has asked for it: a loop's passes may differ by it
        self.frames: dict[int, dict[str, data.Pose]] = {
            1: {},
            3: {},
        }  # of tools and work objects in words: position, quaternion
        # Names of tools and work objects as the program writes them
        self.written: dict[str, str] = {}

    def forget_position(self) -> None:
        self.here = None

    def gap(self, line: int) -> None:
        self.forget_position()
        super().gap(line)

    def frames_of(self, line: int, tool_row: object, wobj_row: object) -> tuple[str, str]:
        """Names of tool and work object, after a look whether they go together."""
        names: list[str] = []
        for argument, what in ((tool_row, TOOL), (wobj_row or Place("wobj0"), WORK_OBJECT)):
            if not named(argument):
                raise Unknown(
                    "programs.rapid.not_by_name", "its {what} is not given by a name", what=what
                )
            names.append(named(argument).lower())
            self.written.setdefault(names[-1], named(argument))
        key = names[0], names[1]
        if key not in self.said:
            self.said.add(key)
            holds = []
            for name, kind in zip(names, ("tooldata", "wobjdata")):
                try:
                    holds.append(self.frame_data(self.written[name], kind)[0])
                except Unknown as unknown:
                    self.problem(
                        line,
                        "programs.rapid.kept_as_programmed",
                        "{reason}; the poses are kept as programmed",
                        reason=unknown.fact,
                        once=name,
                    )
            if len(holds) == 2 and holds[0] is holds[1]:
                fact = (
                    Fact(
                        "programs.rapid.both_held",
                        "{tool} and {wobj}: both are held by the robot (robhold)",
                        tool=names[0],
                        wobj=names[1],
                    )
                    if holds[0]
                    else Fact(
                        "programs.rapid.neither_held",
                        "{tool} and {wobj}: neither is held by the robot (robhold)",
                        tool=names[0],
                        wobj=names[1],
                    )
                )
                self.problem(line, fact)
        return key

    def frame_data(self, name: str, kind: str) -> Any:
        value, found = self.variable(name)
        if found != kind or len(value) < 3 or not isinstance(value[0], bool):
            raise Unknown("programs.rapid.wrong_type", "{name} is no {kind}", name=name, kind=kind)
        return value

    def described(self, name: str, at: int) -> str:
        """A tool (at 1) or a work object (at 3) in words."""
        if (name, at) not in self.texts:
            text = self.written.get(name, name)
            try:
                value = self.frame_data(name, "tooldata" if at == 1 else "wobjdata")
                pose = pose_of(value[at])
                if at == 3:
                    pose = pose_of(product(pose, pose_of(value[4])))
                text = f"{text} {data.components(pose)}"
                if value[0] == (at == 3):
                    text += " held by the robot" if at == 3 else " fixed in the room"
                if (
                    at == 1 or value[1] and not value[2]
                ):  # one that a mechanical unit moves is nowhere
                    self.frames[at][text] = pose
                if at == 3 and value[0]:
                    self.program.held.add(text)
            except (Unknown, IndexError):
                if name in self.changed:
                    text += f" after line {self.changed[name]}"
            self.texts[name, at] = text
        return self.texts[name, at]

    def position(self, options: Mapping[str, Any]) -> Any:
        """The robtarget CRobT gives: the last one, in another tool or work object if asked for."""
        if self.here is None:
            raise Unknown("programs.rapid.place_unknown", "where the robot is then is not known")
        target, tool, wobj = self.here
        names = []
        for key, own in (("tool", tool), ("wobj", wobj)):
            names.append(named(options.get(key)).lower() or own)
        self.asked = True
        if names == [tool, wobj]:
            return target
        old, new = self.flange(tool, wobj), self.flange(names[0], names[1])
        if old[2] or new[2]:
            raise Unknown(
                "programs.rapid.crobt",
                "CRobT in another tool or work object than the part's in the robot",
            )
        flange = product(product(old[1], pose_of(target)), inverse(old[0]))
        return [*product(product(inverse(new[1]), flange), new[0]), *target[2:]]

    def flange(self, tool: str, wobj: str) -> tuple[data.Pose, data.Pose, bool]:
        held, work = self.frame_data(tool, "tooldata"), self.frame_data(wobj, "wobjdata")
        if len(work) != 5 or not work[1]:
            raise Unknown(
                "programs.rapid.mechanical_unit", "{name} is moved by a mechanical unit", name=wobj
            )
        room = product(pose_of(work[3]), pose_of(work[4]))
        return pose_of(held[1]), room, work[0] or not held[0]
