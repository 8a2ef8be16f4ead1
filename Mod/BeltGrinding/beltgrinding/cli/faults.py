"""What a command cannot go on with: output that nobody takes, memory, and faults of this program."""

import contextlib
import errno
import os
import platform
import sys
import tempfile
import time
import traceback

OUTPUT_ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EBADF, errno.EFBIG)


@contextlib.contextmanager
def standard_streams():
    """Streams that take every character, and are there. A reader that has gone, as ``head`` goes, is no
    error."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by who called us
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        _to_nowhere()


def _to_nowhere():
    """What is still in a stream's buffer must not fail again when Python ends."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def of_output(error):
    """Whether an error is of standard output: those of files name them."""
    return isinstance(error, OSError) and error.filename is None and error.errno in OUTPUT_ERRORS


def output_error(error):
    """The InputError of one."""
    from ..base.files import reason_of
    from ..engine import InputError

    _to_nowhere()
    return InputError(
        "cli.output", "standard output cannot be written: {reason}", reason=reason_of(error)
    )


def ours(error, messages):
    """Says that an unexpected error is a fault of this program, and writes what tells of it to a file;
    the exit status."""
    from ..engine import InputError

    text = "".join(
        [
            f"{time.strftime('%Y-%m-%d %H:%M:%S')}  {platform.platform()}  Python {sys.version}\n",
            f"{_versions()}\n{sys.argv!r}\n\n",
            *traceback.format_exception(error),
        ]
    )
    try:
        number, path = tempfile.mkstemp(prefix="beltgrind-fault-", suffix=".txt")
        with open(number, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write(text)
    except OSError:
        print(text, file=sys.stderr)
        path = "what stands above"
    messages.print_error(
        InputError(
            "cli.own_fault",
            "a fault of this program, not of yours ({kind}: {reason}); please send {report} to its developers",
            kind=type(error).__name__,
            reason=str(error).split("\n", 1)[0][:200],
            report=path,
        )
    )
    return 2


def _versions():
    try:
        from ..engine import core

        return core.versions()
    except Exception:  # it may be the core that is at fault
        return "no core"
