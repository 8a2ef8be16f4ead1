"""Ctrl-C in a process of the command line."""

import os
import signal
import sys

TEXT = "interrupted; nothing was written"


class Interrupted(KeyboardInterrupt):
    """Ctrl-C, with an InputError that says what of the work is kept."""

    def __init__(self, error):
        super().__init__()
        self.error = error


def stop(*_):
    """Ends the process at once. Wherever something is to be tidied up, ``base.files.interruptible`` makes
    Ctrl-C a KeyboardInterrupt; anywhere else one could come inside an import, where C code takes it for
    a module that does not fit."""
    files = sys.modules.get("beltgrinding.base.files")
    path = files.last_written() if hasattr(files, "last_written") else None
    if hasattr(files, "tidy"):
        files.tidy()
    text = f"beltgrind: {TEXT}" if path is None else f"beltgrind: interrupted; {path} was written"
    os.write(2, os.fsencode(text + "\n"))
    os._exit(130)


stop.ends_process = True


def install(before=None):
    """For the main thread of a process of its own, unless its parent has Ctrl-C ignored. ``before``: the
    handler that the process began with, if it has another one already."""
    if (before or signal.getsignal(signal.SIGINT)) is signal.default_int_handler:
        signal.signal(signal.SIGINT, stop)
