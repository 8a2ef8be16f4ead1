"""The command line as a program: ``env --block-signal=INT python3 beltgrind.py run job.json -o out/``.

Python takes Ctrl-C for a fault while it starts itself; blocked, it waits until somebody hears it.
"""

import os
import signal


def _stop(*_):
    os.write(2, b"beltgrind: interrupted; nothing was written\n")
    os._exit(130)


if __name__ == "__main__":
    # Before all else is imported, which takes a while: Ctrl-C ends with 130 there, too.
    before = signal.getsignal(signal.SIGINT)
    if before is signal.default_int_handler:
        signal.signal(signal.SIGINT, _stop)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    from beltgrinding.cli import process

    process(before)
