"""What the parts of KRL's interpreter (reader.py) have of each other."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Any, TypeAlias

from ....base.kinds import Json
from ...program import Program, Why
from .blocks import Routine
from .modules import Home
from .turning import Turning
from .values import Values

Body: TypeAlias = tuple[Routine, int, int]  # its statements from a place to before another


class Parts:
    """What one part sets or does, and others use."""

    program: Program
    file: str
    line: int
    rounds: int
    doubt: bool
    given: Json  # where neither the program nor a data list tells
    values: Values
    turning: Turning
    home: Home  # where the routine stands that runs
    homes: dict[str, Home]  # of other modules
    calls: int  # of routines in each other
    missing: set[Any]  # what was told once
    joins: dict[tuple[int, int], int]  # (id of the routine, place): since where
    forgetting: int
    called: int
    forgotten: set[Any]
    beside: bool
    zeroed: bool
    covered: Any  # (name, steps) of a path that is not known, before the index that is not

    frame_names: dict[Any, str]  # words of frames that are not known
    frame_counts: dict[str, int]
    in_words: dict[
        str, tuple[int, str, Any]
    ]  # of $TOOL and $BASE: the version, the words, the aggregate
    here: Any  # components of the current pose, None: unknown
    here_frames: Any  # the words of its frames
    last_components: Any
    spline: bool | None  # within a SPLINE block; None: it may be
    block_saved: list[tuple[str, Any]]  # what its WITH set
    block_reason: Why | None  # or why that is not known

    tick: Callable[..., None]
    problem: Callable[..., None]
    gap: Callable[..., None]
    reached: Callable[..., None]
    evaluate: Callable[..., Any]
    value_or_lost: Callable[..., Any]
    ask: Callable[..., Any]
    given_for: Callable[..., Any]
    path: Callable[..., tuple[str, tuple[Any, ...]]]
    assign: Callable[..., None]
    store: Callable[..., None]
    lose: Callable[..., None]
    lose_names: Callable[..., None]
    lose_calls: Callable[..., None]
    touches: Callable[..., Why]
    touch: Callable[..., None]
    touch_bas: Callable[..., None]
    may_set: Callable[..., Why]
    may_set_force: Callable[..., None]
    may_leave: Callable[..., None]
    may_jump: Callable[..., None]
    forget: Callable[..., None]
    forget_routine: Callable[..., None]
    elsewhere: Callable[..., None]
    not_understood: Callable[..., None]
    bas: Callable[..., None]
    routine: Callable[..., str]
    at_home: Callable[..., AbstractContextManager[None]]
    system_function: Callable[..., Any]
    speed_now: Callable[..., float | None]
    frames_now: Callable[..., list[str]]
    frame_value: Callable[..., Any]

    @property
    def routines(self) -> Mapping[str, Routine]:
        """The routines that are seen here, by name."""
        return self.home.routines
