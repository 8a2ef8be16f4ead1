"""Work in plain Python that can be cancelled from another thread.

What works step by step asks ``check`` at each; outside of ``stoppable`` that does nothing.
"""

import contextlib
import threading

_here = threading.local()


@contextlib.contextmanager
def stoppable(context):
    """In this thread, ``check`` raises Cancelled once the RunContext ``context`` is cancelled."""
    before = getattr(_here, "context", None)
    _here.context = context
    try:
        yield
    finally:
        _here.context = before


def check():
    """Raises Cancelled if the work in this thread is to end."""
    context = getattr(_here, "context", None)
    if context is not None:
        context.throw_if_cancelled()
