#!/usr/bin/env python3
"""Runs random small jobs and checks what must hold for every one of them.

    tests/robustness/fuzz_jobs.py --jobs 200
    tests/robustness/fuzz_jobs.py --replay 17

Each job ends in a result or in an InputError: no crash, no other error, within LIMIT. In a result
nothing is NaN, no height has grown, the volume that is gone from the field is the one that the
summary, and the steps added up, say, and one thread gives the bits that several give.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
for folder in (HERE, HERE.parents[1] / "Mod" / "BeltGrinding"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

LIMIT = 120.0  # s of wall time for one job; sanitizers and busy machines included
PRELOAD = "BELTGRINDING_FUZZ_PRELOAD"  # libraries that the worker loads first: a sanitizer's
STRICT = "BELTGRINDING_FUZZ_THREADS"  # set: every job runs again on one thread


class Finding(Exception):
    """What a job did wrong."""


def check(job, again):
    """Runs a job dict and checks its result; ``again``: on one thread as well. Returns what came of
    it in one word or a few: an InputError's text, or "ground", "untouched". Raises Finding.
    """
    import beltgrinding
    from beltgrinding.engine import InputError

    before = json.dumps(job, sort_keys=True)
    try:
        result = beltgrinding.run(job)
    except InputError as error:
        if not str(error).strip():
            raise Finding("an InputError without a word")
        return f"refused: {error}"
    if json.dumps(job, sort_keys=True) != before:
        raise Finding("the job given was changed")
    _check_result(result)
    if again:
        beltgrinding.core.set_threads(1)
        try:
            other = beltgrinding.run(job)
        finally:
            beltgrinding.core.set_threads(0)
        if other.field.height.tobytes() != result.field.height.tobytes():
            raise Finding("one thread gives other heights than several")
        if json.dumps(other.events) != json.dumps(result.events):
            raise Finding("one thread gives other events than several")
    return "ground" if result.summary["removed_volume_mm3"] > 0 else "untouched"


def _check_result(result):
    field, summary = result.field, result.summary
    height, stock, area = field.height, field.stock_height.astype(float), field.areas.astype(float)
    for name, values in {"height": height, "stock": stock, "area": area, **result.steps}.items():
        if not np.isfinite(values).all():
            raise Finding(f"{name} holds a value that is not finite")
    found = (field.flags & 2) == 0  # of a missed sample the stock is not known
    if (height > stock + 1e-6 * (1.0 + np.abs(stock)))[found].any():
        raise Finding(f"a height grew by {np.max((height - stock)[found]):.3g} mm")
    for where, value in _numbers(summary):
        if not math.isfinite(value):
            raise Finding(f"summary: {where} is {value}")
    for event in result.events:
        for where, value in _numbers(event):
            if not math.isfinite(value):
                raise Finding(f"event {event['kind']}: {where} is {value}")
    steps = result.steps
    for name in ("force", "contact_area", "peak_pressure", "removal_rate", "duration"):
        if (steps[name] < 0).any():
            raise Finding(f"{name} of a step is negative")
    gone = float((area * (stock - height))[found].sum())
    said = summary["removed_volume_mm3"]
    # float32 stock and rates: what they may round away
    slack = 1e-6 * float((area * np.abs(stock))[found].sum()) + 1e-5 * abs(gone) + 1e-12
    if abs(gone - said) > slack:
        raise Finding(f"{gone} mm3 are gone, the summary says {said}")
    added = float((steps["removal_rate"].astype(float) * steps["duration"]).sum())
    everywhere = float((area * (stock - height)).sum())
    if abs(everywhere - added) > slack + 1e-4 * abs(added):
        raise Finding(f"{everywhere} mm3 are gone, the steps add up to {added}")


def _numbers(value, where=""):
    if isinstance(value, dict):
        for key, one in value.items():
            yield from _numbers(one, f"{where}.{key}")
    elif isinstance(value, (list, tuple)):
        for i, one in enumerate(value):
            yield from _numbers(one, f"{where}[{i}]")
    elif isinstance(value, float):
        yield where, value


def run_one(number):
    """One line for the job; raises Finding."""
    from beltgrinding.engine import InputError
    from random_jobs import random_job

    try:
        job = random_job(number)
    except InputError as error:
        return f"no part: {error}"
    return check(job, STRICT in os.environ or number % 4 == 0)


def run_all(numbers, limit=LIMIT, environment=None):
    """Runs the jobs, in a process that is begun anew when it dies. Yields (number, words, is it a
    finding)."""
    numbers = list(numbers)
    command = [sys.executable, __file__, "--worker"]
    worker = None
    while numbers:
        if worker is None:
            worker = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE if environment is None else None,
                text=True,
                env=_worker_environment(environment or {}),
            )
        number = numbers.pop(0)
        start = time.monotonic()
        worker.stdin.write(f"{number}\n")
        worker.stdin.flush()
        line = _line(worker, start + limit)
        if line is None:
            slow = time.monotonic() >= start + limit  # else it has just died
            worker.kill()
            said = (worker.stderr.read() if worker.stderr else "")[-2000:]
            worker.wait()
            yield number, f"more than {limit:g} s" if slow else f"died: {said}", True
            worker = None
            continue
        words = json.loads(line)
        yield number, words["words"], words["finding"]
    if worker is not None:
        worker.stdin.close()
        worker.wait()


def _worker_environment(more):
    preload = os.environ.get(PRELOAD)
    return {**os.environ, **more, **({"LD_PRELOAD": preload} if preload else {})}


def _line(worker, deadline):
    import select

    while time.monotonic() < deadline:
        ready, _, _ = select.select([worker.stdout], [], [], 0.2)
        if ready:
            return worker.stdout.readline() or None
        if worker.poll() is not None:
            return None
    return None


def _work():
    """Reads numbers from standard input, and answers each with a line of JSON."""
    import traceback

    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever else is printed
    for line in sys.stdin:
        finding = False
        try:
            words = run_one(int(line))
        except Finding as error:
            words, finding = str(error), True
        except Exception:
            words, finding = traceback.format_exc(), True
        answers.write(json.dumps({"words": words, "finding": finding}) + "\n")
        answers.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=200, help="how many (default 200)")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument(
        "--limit", type=float, default=LIMIT, help=f"s for a job (default {LIMIT:g})"
    )
    parser.add_argument("--replay", type=int, metavar="NUMBER", help="print a job, run it here")
    parser.add_argument("--verbose", action="store_true", help="a line a job")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.worker:
        return _work()
    if arguments.replay is not None:
        from random_jobs import random_job

        job = random_job(arguments.replay)
        shown = {**job, "design": {k: v for k, v in job["design"].items() if k != "brep"}}
        print(json.dumps(shown, indent=1))
        print(check(job, True))
        return 0
    counts, findings = {}, 0
    numbers = range(arguments.first, arguments.first + arguments.jobs)
    for number, words, finding in run_all(numbers, arguments.limit):
        kind = "finding" if finding else words.split(":")[0]
        counts[kind] = counts.get(kind, 0) + 1
        findings += finding
        if finding or arguments.verbose:
            print(f"{number}: {'FINDING ' if finding else ''}{words}", flush=True)
    print(", ".join(f"{count} {kind}" for kind, count in sorted(counts.items())))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
