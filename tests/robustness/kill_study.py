#!/usr/bin/env python3
"""Runs a study on processes that are killed at random moments, and compares its table with the serial one.

    tests/robustness/kill_study.py --jobs 1000 --job build/demo/job.json --set sampling.spacing_mm=2

Now and then all of them are killed at once. What does not come to an end so, since each worker that had it was
killed, is made by the same study again, as a user does; then both tables are compared byte for byte. Without --job the
job is a plate.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from contextlib import nullcontext
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
for folder in (ROOT / "Mod" / "BeltGrinding", ROOT / "tests", ROOT / "tests" / "robustness"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

BETWEEN = (
    0.2,
    1.5,
)  # between two kills, in times what a process takes here and now from its start to a first run
WHOLE = 0.1  # of the kills are of all workers
MOST_KILLS = 1_000_000
ROUNDS = 10  # of the same study, until each run has come to an end
SWAPPED = [0.05, -0.05]  # mm, a tolerance of which no job can be run


class Outcome(NamedTuple):
    """What came of it."""

    equal: bool  # both tables, byte for byte
    runs: int
    done: int  # runs that have figures; the others cannot be run
    killed: int  # workers
    at_once: int  # times that all were killed
    not_ended: int  # runs that did not come to an end the first time
    rounds: int  # of the same study
    serial_s: float
    killed_s: float


def study(job, jobs, seed=1):
    """A study of so many runs of a job (a dict, or a path); about one in fifty cannot be run."""
    return {
        "job": job,
        "vary": [
            {
                "name": "force",
                "key": "belt_machine.force_N",
                "how": "multiply",
                "range": [0.7, 1.3],
            },
            {
                "name": "allowance",
                "key": "stock.allowance_mm",
                "how": "add",
                "distribution": {"kind": "normal", "mean": 0, "sd": 0.02, "lower": -0.1},
            },
            {
                "name": "off",
                "key": "placement.z_mm",
                "distribution": {"kind": "normal", "mean": 0, "sd": 0.02},
            },
            {
                "name": "band",
                "key": "inspection.tolerance_mm",
                "values": [[-0.05, 0.05], [-0.1, 0.1], SWAPPED],
                "weights": [25, 24, 1],
            },
        ],
        "design": {"method": "monte_carlo", "runs": jobs, "seed": seed},
    }


def first_run(given):
    """s from a process's start to the first runs of a study, on this machine, now."""
    from beltgrinding.studies import making

    few = making.validate({**given, "design": {**given["design"], "runs": 2}})
    prepared = making.prepare(few)  # by a process of its own, before there are workers
    with tempfile.TemporaryDirectory() as folder:
        begun = time.monotonic()
        making.run(prepared, folder, workers=1)
        return time.monotonic() - begun


def kill_studies(
    given, seed, between=BETWEEN, whole=WHOLE, workers=2, tell=lambda text: None, folder=None
):
    """An ``Outcome`` of a study that is made one run after the other, and by workers that are killed. ``folder``: where both
    are kept, and what is there is not made again; None: nowhere."""
    from beltgrinding.engine import InputError
    from beltgrinding.studies import making, table
    from support.workers import Killer

    with nullcontext(folder) if folder else tempfile.TemporaryDirectory() as folder:
        begun = time.monotonic()
        serial = making.study(given, Path(folder, "serial"), workers=0)
        serial_s = time.monotonic() - begun
        tell(f"serial: {serial.table.done.sum()} of {len(serial.table)} in {serial_s:.0f} s")
        pace = first_run(given)
        tell(f"a first run comes {pace:.1f} s after a process's start")
        between = [pace * share for share in between]
        out, begun = Path(folder, "killed"), time.monotonic()
        killer, open_ = Killer(os.getpid(), MOST_KILLS, seed, between, whole, tell), []

        def begin(_):  # the design is made
            if killer.ident is None:
                killer.start()

        try:
            while len(open_) < ROUNDS and (not open_ or open_[-1]):
                try:
                    found = making.study(given, out, workers=workers, told=begin)
                    open_.append(found.broken_off)
                except InputError as error:
                    if error.code != "studies.cluster_not_started":
                        raise
                    # The table does not tell a run that was given up from one that cannot be run.
                    left = table.Table.read(out / table.FILE)
                    open_.append(max(1, int((left[table.STATUS] == table.OPEN).sum())))
                tell(f"round {len(open_)}: {open_[-1]} runs did not come to an end")
                # A machine that has slowed down since would let no single run come to its end.
                killer.between = [1.5 * pause for pause in killer.between]
        finally:
            killer.stop()
        same = Path(folder, "serial", table.FILE).read_bytes() == (out / table.FILE).read_bytes()
        return Outcome(
            same,
            len(serial.table),
            int(serial.table.done.sum()),
            killer.killed,
            killer.at_once,
            open_[0],
            len(open_),
            serial_s,
            time.monotonic() - begun,
        )


def set_key(job, text):
    """Sets KEY=VALUE of a job, as JSON."""
    key, _, value = text.partition("=")
    *parents, last = key.split(".")
    for name in parents:
        job = job.setdefault(name, {})
    job[last] = json.loads(value)


def main():
    import kill
    from beltgrinding.engine import core
    from beltgrinding.job import load as loading

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=100)
    parser.add_argument("--job", help="job.json (default: a plate)")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="of the job"
    )
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--between", type=float, nargs=2, default=BETWEEN, metavar="SHARE")
    parser.add_argument("--whole", type=float, default=WHOLE, help="share of all at once (0.1)")
    parser.add_argument("--seed", type=int, default=1, help="of the study and the kills")
    parser.add_argument("--folder", help="keep both tables and all runs there, and go on from them")
    arguments = parser.parse_args()
    job = loading.load(arguments.job) if arguments.job else kill.plate()
    for one in arguments.set:
        set_key(job, one)
    core.set_threads(1)
    given = study(job, arguments.jobs, arguments.seed)
    found = kill_studies(
        given,
        arguments.seed,
        arguments.between,
        arguments.whole,
        arguments.workers,
        lambda text: print(text, flush=True),
        arguments.folder,
    )
    print(json.dumps(found._asdict()))
    return 0 if found.equal else 1


if __name__ == "__main__":
    sys.exit(main())
