"""What a program for the whole robot is made of."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple, Optional

import numpy as np

from ..base.kinds import Facts, Floats, Json
from ..base.messages import fact_data
from ..engine import Fact


@dataclass
class Move:
    """A motion of the program. ``joints_deg``: six angles at its end, None: not known, the arm does not get there."""

    kind: str  # PTP: by joints; LIN
    frame: Floats  # base_from_tcp at its end, mm
    joints_deg: Optional[Floats] = None
    feed: float = 0.0  # mm/s; PTP: not used
    force: float = -1.0  # N
    zone: float = 0.0  # mm; -1: the job's default
    line: int = 0
    note: str = ""
    external: tuple[float, ...] = ()  # where the external axes are at its end, mm or degrees


class Incident(NamedTuple):
    """A problem, or a note, at a place of a program. ``kind``, ``severity``: as events have them; ``move``: the motion on
    whose way it is, from 0; ``bodies``: names of two."""

    kind: str
    severity: str
    fact: Fact
    move: int
    bodies: tuple[str, ...] = ()


@dataclass
class Whole:
    """A program for the whole robot. ``problems``: for which it must not run; ``notes``: what is to be known of it;
    ``incidents``: of both, what has a place."""

    moves: list[Move] = field(default_factory=list)
    problems: Facts = field(default_factory=list)
    notes: Facts = field(default_factory=list)
    figures: dict[str, Any] = field(default_factory=dict)
    incidents: list[Incident] = field(default_factory=list)

    def add_problem(
        self, kind: str, fact: Fact, bodies: tuple[str, ...] = (), move: int = -1
    ) -> None:
        """Adds a problem on the way of a motion, -1: of the one that is added next."""
        self.problems.append(fact)
        place = len(self.moves) if move < 0 else move
        self.incidents.append(Incident(kind, "error", fact, place, bodies))

    def add_note(self, kind: str, fact: Fact, move: int = -1) -> None:
        """The same of a note."""
        self.notes.append(fact)
        self.incidents.append(
            Incident(kind, "warning", fact, len(self.moves) if move < 0 else move)
        )

    def follow(self, other: Whole) -> None:
        """Adds a program that begins where this one ends."""
        shift = max(len(self.moves) - 1, 0)
        self.moves += other.moves[1:] if self.moves else other.moves
        self.problems += other.problems
        self.notes += other.notes
        self.incidents += [one._replace(move=one.move + shift) for one in other.incidents]

    def data(self) -> dict[str, Any]:
        """As JSON has it, to the last bit."""
        return {
            "moves": [
                {
                    **vars(one),
                    "frame": np.asarray(one.frame).tolist(),
                    "joints_deg": None if one.joints_deg is None else [*map(float, one.joints_deg)],
                }
                for one in self.moves
            ],
            "problems": [fact_data(one) for one in self.problems],
            "notes": [fact_data(one) for one in self.notes],
            "incidents": [{**one._asdict(), "fact": fact_data(one.fact)} for one in self.incidents],
            "figures": self.figures,
        }

    @classmethod
    def from_data(cls, data: Json) -> Whole:
        """Of what ``data`` gives."""
        problems, notes = ([_fact(one) for one in data[key]] for key in ("problems", "notes"))
        return cls(
            [_move(one) for one in data["moves"]],
            problems,
            notes,
            dict(data["figures"]),
            [_incident(one) for one in data["incidents"]],
        )


def _move(data: Json) -> Move:
    joints = None if data["joints_deg"] is None else np.array(data["joints_deg"])
    given: dict[str, Any] = {
        **data,
        "frame": np.array(data["frame"]),
        "joints_deg": joints,
        "external": tuple(data["external"]),
    }
    return Move(**given)


def _incident(data: Json) -> Incident:
    given: dict[str, Any] = {
        **data,
        "fact": _fact(data["fact"]),
        "bodies": tuple(data["bodies"]),
    }
    return Incident(**given)


def _fact(data: Json) -> Fact:
    return Fact(data["code"], data["text"], **data["arguments"])
