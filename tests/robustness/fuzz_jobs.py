#!/usr/bin/env python3
"""Runs random small jobs and checks what must hold for every one of them.

    tests/robustness/fuzz_jobs.py --jobs 200                      on real parts (random_jobs.py)
    tests/robustness/fuzz_jobs.py --kind valid --jobs 10000       all that the schema has (schema_jobs.py)
    tests/robustness/fuzz_jobs.py --kind nearly --jobs 10000      the same, one or two keys at the edge or beyond
    tests/robustness/fuzz_jobs.py --kind nearly --seed 1 --job 17     prints one
    tests/robustness/fuzz_jobs.py --kind nearly --seed 1 --replay 17  runs it here

Each job ends in a result or in an InputError of one line: no crash, no other error, within LIMIT; or, where it has
more steps than that, it tells how far it is, goes on, and ends when it is asked to. In a result all is finite, no
height has grown, what is gone from the field is what the summary and the steps added up say, between 0 and the
stock; its files read back to the same bits; and, of some, one thread gives the bits that several give, and so does
a run that goes on from an earlier one.
"""

import argparse
import copy
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
for folder in (HERE, HERE.parents[1] / "Mod" / "BeltGrinding"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

LIMIT = 120.0  # s of processor time for one job, sanitizers included
STARVED = 10
PATIENCE = 30.0  # s of processor time after which a job is asked to end, and within which it does
MEMORY = 6 << 30  # bytes of address space of a worker
KINDS = ("parts", "valid", "nearly")
UNLIKE = (
    "run_id",
    "wall_time_s",
    "warnings",
    "files",
    "sha256",
)  # of a summary, from run to run or when it is read
TOLD = 250  # jobs after which it is told how they ended so far
EVERY = 8  # so many jobs of which one is run on one thread, and one resumed
PRELOAD = "BELTGRINDING_FUZZ_PRELOAD"  # libraries that the worker loads first: a sanitizer's
STRICT = "BELTGRINDING_FUZZ_THREADS"  # set: every job runs again on one thread


class Finding(Exception):
    """What a job did wrong."""


def check(job, again, written=False, resumed=False, patience=None):
    """Runs a job dict and checks its result. ``again``: on one thread as well; ``written``: its files are read back;
    ``resumed``: also from the middle of another run; ``patience``: s after which it is asked to end. Returns what came
    of it in one word or a few: an InputError's text, or "ground", "untouched", "long". Raises Finding.
    """
    from beltgrinding.engine import Cancelled, InputError

    before = repr(job)
    try:
        result = _patient(job, patience)
    except InputError as error:
        text = str(error)
        if not text.strip() or "\n" in text or "Traceback" in text:
            raise Finding(f"an InputError that is not one line: {text!r}") from None
        return f"refused: {text}"
    except Cancelled:
        return "long: asked to end, and did"
    if repr(job) != before:
        raise Finding("the job given was changed")
    _check_result(result)
    if again:
        _check_threads(job, result)
    if written:
        _check_written(result)
    if resumed:
        _check_resumed(job, result)
    return "ground" if result.summary["removed_volume_mm3"] > 0 else "untouched"


def _patient(job, patience):
    import beltgrinding

    if patience is None:
        return beltgrinding.run(job)
    context = beltgrinding.RunContext()
    done, late = threading.Event(), []

    begun, wall = time.process_time(), time.monotonic()

    def ask():
        for spent in (patience, 2.0 * patience):  # s of processor time: others may be at work
            while time.process_time() < begun + spent:
                if done.wait(0.1):
                    return
            context.cancel()
        late.append(True)

    asking = threading.Thread(target=ask)
    asking.start()
    try:
        return beltgrinding.run(job, context)
    finally:
        done.set()
        asking.join()
        if late:
            raise Finding(
                f"did not end within {patience:g} s of processor time when it was asked to, at "
                f"{context.progress:.2f}, after {time.monotonic() - wall:.0f} s"
            )


def _check_threads(job, result):
    import beltgrinding

    beltgrinding.core.set_threads(1)
    try:
        other = beltgrinding.run(job)
    finally:
        beltgrinding.core.set_threads(0)
    _compare(other, result, "one thread gives")


def _compare(other, result, what):
    for name, values in _arrays(result).items():
        if _arrays(other)[name].tobytes() != values.tobytes():
            raise Finding(f"{what} another {name}")
    if _told(other.events) != _told(result.events):
        raise Finding(f"{what} other events")
    for key, value in result.summary.items():
        if key not in UNLIKE and _told(other.summary.get(key)) != _told(value):
            raise Finding(f"{what} another {key} in the summary: {other.summary.get(key)}, {value}")


def _told(data):
    return json.dumps(data, sort_keys=True, default=str)


def _arrays(result):
    field = result.field
    names = ("points", "normals", "areas", "stock_height", "height", "height_sd", "faces", "flags")
    found = {name: np.asarray(getattr(field, name)) for name in names}
    for group in ("trace", "heat", "finish"):
        for name, values in (getattr(field, group) or {}).items():
            found[f"{group}.{name}"] = np.asarray(values)
    return found


def _check_written(result):
    """What was written is read again, to the same bits."""
    from beltgrinding.engine import InputError
    from beltgrinding.simulation.result import Result

    with tempfile.TemporaryDirectory(dir=_memory_folder()) as folder:
        path = Path(folder, "result")
        try:
            result.write(path)
            read = Result.read(path)
        except InputError as error:
            raise Finding(f"what was written cannot be read: {error}") from None
        _compare(read, result, "what was written gives")
        if _told(read.job) != _told(result.job):
            raise Finding("what was written gives another job")


def _memory_folder():
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


def _check_resumed(job, result):
    """The same after a run of a job whose last pose is another one, from which it goes on."""
    import beltgrinding
    from beltgrinding.base import kept
    from beltgrinding.engine import InputError

    other = copy.deepcopy(job)
    program = other["programs"][-1]
    if "poses" not in program:
        return
    program["poses"][-1]["z_mm"] += 1.0
    with kept.instead(kept.Kept()):
        try:
            beltgrinding.run(other)
        except InputError:
            return
        _compare(beltgrinding.run(job), result, "a run that goes on from an earlier one gives")


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
    if not 0.0 <= summary["removed_volume_mm3"]:
        raise Finding(f"the removed volume is {summary['removed_volume_mm3']} mm3")
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


def made(kind, seed, number):
    """Job ``number`` of a kind, a dict. Raises InputError where its part cannot be read."""
    if kind == "parts":
        from random_jobs import random_job

        return random_job(number)
    import schema_jobs

    return schema_jobs.job(seed, number, kind == "nearly")


def run_one(kind, seed, number):
    """One line for the job; raises Finding."""
    from beltgrinding.engine import InputError

    try:
        job = made(kind, seed, number)
    except InputError as error:
        return f"no part: {error}"
    if kind == "parts":
        return check(job, STRICT in os.environ or number % 4 == 0)
    if kind == "nearly" and number % 2:
        job = _through_a_file(job)
        if isinstance(job, str):
            return job
    turn = number % EVERY
    return check(job, turn == 0, kind == "valid" or turn == 2, turn == 4, PATIENCE)


def _through_a_file(job):
    """The job as ``jobs.load`` reads it, or what that says."""
    from beltgrinding.engine import InputError
    from beltgrinding.job import load as jobs

    with tempfile.TemporaryDirectory(dir=_memory_folder()) as folder:
        path = Path(folder, "job.json")
        path.write_text(json.dumps(job))
        try:
            return jobs.load(path)
        except InputError as error:
            return f"refused: {error}"


def run_all(numbers, limit=LIMIT, environment=None, kind="parts", seed=1):
    """Runs the jobs, in a process that is begun anew when it dies. Yields (number, words, is it a
    finding)."""
    numbers = list(numbers)
    command = [sys.executable, __file__, "--worker", "--kind", kind, "--seed", str(seed)]
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
        worker.stdin.write(f"{number}\n")
        worker.stdin.flush()
        line, slow = _line(worker, limit)
        if line is None:
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


def _line(worker, limit):
    """(the worker's line, None where it has died or has taken more than ``limit`` s; whether it has). Its processor
    time counts, since others may be at work, up to STARVED times as long."""
    import select

    begun, ends = _spent(worker.pid), time.monotonic() + STARVED * limit
    while True:
        if select.select([worker.stdout], [], [], 0.2)[0]:
            return worker.stdout.readline() or None, False
        if worker.poll() is not None:
            return None, False
        if _spent(worker.pid) > begun + limit or time.monotonic() > ends:
            return None, True


def _spent(process):
    """s of processor time of a process, 0 where it has ended."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _work(kind, seed):
    """Reads numbers from standard input, and answers each with a line of JSON."""
    import traceback

    if PRELOAD not in os.environ:  # a sanitizer's shadow is larger than any limit
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever else is printed
    for line in sys.stdin:
        finding = False
        try:
            words = run_one(kind, seed, int(line))
        except Finding as error:
            words, finding = str(error), True
        except Exception:
            words, finding = traceback.format_exc(), True
        answers.write(json.dumps({"words": words, "finding": finding}) + "\n")
        answers.flush()


def _counted(counts):
    return ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=200, help="how many (default 200)")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument(
        "--limit", type=float, default=LIMIT, help=f"s for a job (default {LIMIT:g})"
    )
    parser.add_argument("--kind", choices=KINDS, default="parts", help="of jobs (default parts)")
    parser.add_argument("--seed", type=int, default=1, help="of valid and nearly (default 1)")
    parser.add_argument("--job", type=int, metavar="NUMBER", help="print a job")
    parser.add_argument("--replay", type=int, metavar="NUMBER", help="print a job, run it here")
    parser.add_argument("--verbose", action="store_true", help="a line a job")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    kind, seed = arguments.kind, arguments.seed
    if arguments.worker:
        return _work(kind, seed)
    if arguments.job is not None:
        print(json.dumps(made(kind, seed, arguments.job), indent=1))
        return 0
    if arguments.replay is not None:
        job = made(kind, seed, arguments.replay)
        shown = {**job, "design": {k: v for k, v in job["design"].items() if k != "brep"}}
        print(json.dumps(shown, indent=1))
        print(check(job, True, True, True))
        return 0
    print(f"{kind} jobs of seed {seed}, from {arguments.first} on", flush=True)
    counts, findings = {}, 0
    numbers = range(arguments.first, arguments.first + arguments.jobs)
    for number, words, finding in run_all(numbers, arguments.limit, kind=kind, seed=seed):
        if number % TOLD == TOLD - 1:
            print(f"up to {number}: {_counted(counts)}", flush=True)
        kind = "finding" if finding else words.split(":")[0]
        counts[kind] = counts.get(kind, 0) + 1
        findings += finding
        if finding or arguments.verbose:
            print(f"{number}: {'FINDING ' if finding else ''}{words}", flush=True)
    print(_counted(counts))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
