"""Long work of a command: progress on a terminal, and Ctrl-C that is heard."""

import sys
import threading
import time

CANCEL_TIME = 5.0  # s
BAR = 24  # characters
KNOWN, SETTLED = 0.02, 2.0  # of the work, and s: before, nobody knows how long it takes


def run(work, quiet=False, interrupted=None):
    """``work(context)``'s result. It runs in a thread of its own, so that Ctrl-C reaches the main
    thread while C++ computes; then the context is cancelled, unless ``interrupted()`` takes it for something else and says
    so. Raises what the work raises.
    """
    from ..base.files import interruptible
    from ..engine import core

    context, outcome, done = core.RunContext(), {}, threading.Event()
    # What the main thread waits for is a lock: Ctrl-C inside Event.wait (3.11) lets go of what it does not hold,
    # and that error takes the interruption's place; join takes a thread for ended.
    computing = threading.Lock()
    computing.acquire()

    def guarded():
        try:
            outcome["result"] = work(context)
        except BaseException as error:  # handed on to the main thread
            outcome["error"] = error
        finally:
            done.set()
            computing.release()

    threading.Thread(target=guarded, daemon=True).start()
    if sys.stderr.isatty() and not quiet:
        threading.Thread(target=_show_progress, args=(context, done), daemon=True).start()
    try:
        with interruptible():
            _wait(computing, interrupted)
    except KeyboardInterrupt:
        context.cancel()
        if not done.is_set():
            computing.acquire(timeout=CANCEL_TIME)  # what does not hear it ends with the process
        raise
    if "error" in outcome:
        raise outcome["error"]
    return outcome["result"]


def progress_line(share, elapsed):
    """A bar, the share of the work that is done, 0 to 1, and the time left; ``elapsed``: s since it began."""
    bar = "#" * round(BAR * share)
    line = f"[{bar:<{BAR}}] {100 * share:3.0f} %"
    if share < KNOWN or elapsed < SETTLED:
        return line
    left = round(elapsed * (1.0 - share) / share)
    minutes, seconds = divmod(left, 60)
    return f"{line}, {f'{minutes} min ' if minutes else ''}{seconds} s left"


def _wait(computing, interrupted):
    while True:
        try:
            while not computing.acquire(timeout=0.1):  # another thread may have taken the signal
                pass
            return
        except KeyboardInterrupt:
            if interrupted is None or not interrupted():
                raise


def _show_progress(context, done):
    begun, width = time.monotonic(), 0
    while not done.wait(0.2):
        line = progress_line(context.progress, time.monotonic() - begun)
        print(f"\r{line:<{width}}", end="", file=sys.stderr, flush=True)
        width = len(line)
    print(f"\r{'':<{width}}\r", end="", file=sys.stderr, flush=True)
