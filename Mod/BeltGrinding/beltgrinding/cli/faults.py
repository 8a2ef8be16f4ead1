"""What a command cannot go on with: output that nobody takes, memory, and faults of this program."""

import contextlib
import errno
import os
import platform
import sys
import tempfile
import time
import traceback

WITHOUT_MEMORY = (
    "pthread_create has failed",
    "can't start new thread",
    "std::bad_alloc",
    "Cannot allocate memory",
    "failed to map segment",
)
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


def of_memory(error):
    """Whether an error comes of memory that ran out, also of what libraries make of that."""
    while error is not None:
        text = str(error)
        if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
            return True
        if any(words in text for words in WITHOUT_MEMORY):
            return True
        error = error.__cause__ or error.__context__
    return False


def out_of_memory(messages):
    """Says so; the exit status. The core may not have been loaded, for the same reason."""
    try:
        from ..engine import InputError

        messages.print_error(
            InputError(
                "cli.out_of_memory",
                "out of memory; close other programs, or take a smaller part or coarser settings",
            )
        )
    except Exception:
        with contextlib.suppress(OSError):
            os.write(2, b"beltgrind: out of memory; close other programs\n")
    return 2


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
