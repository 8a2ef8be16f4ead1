"""How long work is waited for. A window puts a way in here that keeps it alive and can be cancelled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..base.kinds import Context, T

wait_in_window: Any = None  # (work, text) -> what work(context) gives: put in by gui/workbench.py


def wait(work: Callable[[Context], T], text: str) -> T:
    """What ``work(context)`` gives, or raises. ``context``: a RunContext, or None where nobody can
    cancel. ``text``: what is done, in the window's language. Raises Cancelled.
    """
    return work(None) if wait_in_window is None else wait_in_window(work, text)
