"""Work in plain Python that can be cancelled from another thread.

What works step by step asks ``check`` at each; outside of ``stoppable`` that does nothing.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..engine import RunContext

_here = threading.local()


@contextlib.contextmanager
def stoppable(context: RunContext) -> Iterator[None]:
    """In this thread, ``check`` raises Cancelled once the RunContext ``context`` is cancelled."""
    before = getattr(_here, "context", None)
    _here.context = context
    try:
        yield
    finally:
        _here.context = before


def check() -> None:
    """Raises Cancelled if the work in this thread is to end."""
    context = getattr(_here, "context", None)
    if context is not None:
        context.throw_if_cancelled()
