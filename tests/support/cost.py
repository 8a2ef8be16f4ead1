"""What work costs, compared with other work of the same run: a limit in seconds would measure the machine,
its load, or the counters of tools/coverage.
"""

import time

SUSPECT = 2.0  # times dearer: measured once more, for what else the machine does can look like it


def cost(work):
    """CPU time of ``work()`` in seconds, the least of three."""
    return min(_once(work) for _ in range(3))


def _once(work):
    begin = time.process_time()
    work()
    return time.process_time() - begin


def growth(work, size):
    """How much dearer per item ``work(8 * size)`` is than ``work(size)``: 1 if the cost is in proportion,
    8 if it goes with the square.
    """
    found = _growth(work, size)
    return found if found < SUSPECT else min(found, _growth(work, size))


def _growth(work, size):
    return cost(lambda: work(8 * size)) / (8 * cost(lambda: work(size)))
