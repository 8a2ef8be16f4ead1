#!/usr/bin/env python3
"""Fuzzes every reader of robot programs (beltgrinding.programs.READERS) with damaged programs.

    tests/fuzz/fuzz_programs.py --inputs 200000 --keep /tmp/findings

A reader gives a Program or raises ProgramError, within LIMIT seconds, whatever the bytes. Poses are
finite and rigid, speeds positive or None. Where a file is cut, each motion that is still there is
one that the whole file has in the same line, or a Problem or ProgramError tells from that line on.
Seeds are tests/fuzz/programs and, where they are, the real programs of BELTGRINDING_SHARED. An
input is known by its seed file and number: --replay FILE:NUMBER writes it out and reads it again.
"""

import argparse
import collections
import gzip
import math
import multiprocessing
import os
import random
import re
import resource
import signal
import sys
import tempfile
import time
import traceback
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
for folder in (HERE, HERE.parents[1] / "Mod" / "BeltGrinding"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

from beltgrinding.programs.registry import READERS, read_program  # noqa: E402
from beltgrinding.programs.program import ProgramError  # noqa: E402
from beltgrinding.programs.table import poses_csv, summary  # noqa: E402
from program_mutations import cut, damaged, excerpt  # noqa: E402

LIMIT = (
    5.0  # s of processor time for one file: endless ones take 1 s, twice as long beside other work
)
PATH_LIMIT = 10.0  # s for the path of what was read, arcs as chords
SILENCE = 60.0  # s without a sign of life after which a worker is lost
MEMORY = 4 << 30  # bytes
OWN = HERE / "programs"
SHARED = Path(os.environ.get("BELTGRINDING_SHARED", "/nowhere")) / "data" / "programs"
SHORT = 4000  # bytes; a program up to here is cut at every place
CUTS = 0.25  # part of the inputs that are files cut off, compared with the whole file
CONTROLLERS = re.compile(
    r"(?:BASE|TOOL)_DATA\[\d+\]"
)  # a frame of which a program has the name only
BRACKETS = {ord("("): 1, ord("["): 1, ord("{"): 1, ord(")"): -1, ord("]"): -1, ord("}"): -1}


class Seed(NamedTuple):
    """A program and the files beside it that belong to it, by name."""

    name: str
    files: dict


class Slow(BaseException):
    """A reader used up its time; no reader may catch it."""


class Finding(Exception):
    """What a reader did wrong: (kind, words)."""


def seeds(folders=None):
    """{suffix: [Seed]} of the languages there are readers for. A folder that is named as a file in it is one
    program with all that lies beside it."""
    found = collections.defaultdict(list)
    folders = folders or [OWN, SHARED / "real", SHARED / "same_path_crs_part5"]
    for folder in folders:
        paths = sorted(folder.glob("*")) if folder.is_dir() else []
        for path in paths:
            if path.suffix.lower() in READERS and path.name != "truth.csv" and path.is_file():
                beside = [p for p in paths if p.stem.lower() == path.stem.lower()]
                files = {p.name: p.read_bytes() for p in beside if p.suffix.lower() in MATES[path]}
                found[path.suffix.lower()].append(Seed(path.name, files))
        for path in (p for p in paths if p.is_dir() and (p / p.name).is_file()):
            files = {p.name: p.read_bytes() for p in sorted(path.iterdir())}
            found[path.suffix.lower()].append(Seed(path.name, files))
    return dict(found)


class _Mates(dict):
    """Suffixes of the files that make up one program."""

    def __missing__(self, path):
        groups = ({".src", ".dat"}, {".pgx", ".dtx"})
        own = path.suffix.lower()
        return next((g for g in groups if own in g), {own})


MATES = _Mates()


def uncovered(folders=None):
    """Suffixes whose reader no seed reaches."""
    reached = {READERS[suffix] for suffix in seeds(folders)}
    return sorted(suffix for suffix, reader in READERS.items() if reader not in reached)


def files_of(seed, number, others):
    """(files, whole files or None, line of the cut) of one input."""
    dice = random.Random(f"{seed.name}:{number}")
    if number < len(seed.files[seed.name]) <= SHORT:  # every place once
        part = seed.files[seed.name][:number]
        place = (seed.name, part.count(b"\n") + 1)
        return {**seed.files, seed.name: part}, dict(seed.files), place
    files = {name: excerpt(data, dice) for name, data in seed.files.items()}
    mates = [name for name in files if name != seed.name]
    name = dice.choice(mates) if mates and dice.random() < 0.25 else seed.name
    if dice.random() < CUTS:
        whole = dict(files)
        within = dice.random() < 0.4
        files[name], line = _line_cut(files[name], dice) if within else _end_cut(files[name], dice)
        return files, whole, (name, line)
    files[name] = damaged(files[name], others, dice)
    if name.endswith(".urp") and dice.random() < 0.3:  # PolyScope packs it, and so it may be cut
        files[name] = _end_cut(gzip.compress(files[name], 1), dice)[0]
    return files, None, None


def _end_cut(data, dice):
    data = cut(data, (), dice)
    return data, data.count(b"\n") + 1


def _line_cut(data, dice):
    """A line's end is missing, brackets in it stay open; as it is where none can."""
    lines = data.splitlines(keepends=True)
    at = dice.randrange(len(lines))
    places, depth = [], 0
    for k, byte in enumerate(lines[at]):
        if depth > 0:
            places.append(k)
        depth += BRACKETS.get(byte, 0)
    if places:
        lines[at] = lines[at][: dice.choice(places)] + b"\n"
    return b"".join(lines), at + 1


def read(files, name, folder):
    """The Program of ``name`` among ``files`` and its processor time in s. Raises Finding, or
    ProgramError as the reader does."""
    for path in folder.iterdir():
        path.unlink()
    for other, data in files.items():
        (folder / other).write_bytes(data)
    begin = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, LIMIT)
    try:
        program = read_program(folder / name)
        seconds = time.process_time() - begin
        signal.setitimer(signal.ITIMER_PROF, PATH_LIMIT)
        arrays = program.path_arrays(100.0)
        poses_csv(program)
        summary(program)
    except ProgramError as error:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        if "\n" in str(error) or Path(name).stem.lower() not in str(error).lower():
            raise Finding("message", f"names no file or has lines: {error!r}") from None
        raise
    except Slow:
        raise Finding("slow", f"after {time.process_time() - begin:.1f} s") from None
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{Path(where.filename).name}:{where.name}"
        raise Finding("crash", f"{type(error).__name__} in {place}: {error}"[:200]) from None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    check(program, arrays)
    return program, seconds


def check(program, arrays):
    """Raises Finding where a Program is not sound."""
    poses = [motion.pose for motion in program.motions if motion.pose is not None]
    for what, frames in (("pose", np.array(poses).reshape(-1, 4, 4)), ("path", arrays["frames"])):
        if not np.isfinite(frames).all():
            raise Finding(what, "is not finite")
        turns = frames[:, :3, :3]
        identity = np.abs(turns @ turns.transpose(0, 2, 1) - np.eye(3)).max(initial=0.0)
        if identity > 1e-6 or (len(turns) and np.linalg.det(turns).min() < 0.0):
            raise Finding(what, "is no rotation")
        if (frames[:, 3] != (0.0, 0.0, 0.0, 1.0)).any():
            raise Finding(what, "is no rigid transform")
        if np.abs(frames[:, :3, 3]).max(initial=0.0) > 1e9:
            raise Finding(what, "is a thousand kilometres away")
    for motion in program.motions:
        for value in (motion.speed_mm_s, motion.force_N):
            if value is not None and not 0.0 <= value < math.inf:
                raise Finding("speed", f"or force is {value!r}")
        if motion.speed_mm_s == 0.0:
            raise Finding("speed", "is zero")


def compare(part, whole, place):
    """Raises Finding where a motion of a cut file is another than the whole file's, and nothing
    is said. ``place``: (file, line) of the cut."""
    told = {str(problem) for problem in whole.problems}
    new = [problem for problem in part.problems if str(problem) not in told]
    if any(problem.file != place[0] or problem.line >= place[1] for problem in new):
        return
    said = max((problem.line for problem in new), default=0)
    known = collections.defaultdict(set)
    for motion in whole.motions:
        key = _key(motion)
        known[motion.file, motion.line] |= {key, (*key[:-1], None), (*key[:-2], None, key[-1])}
        known[motion.file, motion.line].add((*key[:-2], None, None))
    for motion in part.motions:
        here = motion.file == place[0] and said >= motion.line
        key = _key(motion)
        if motion.file != place[0]:  # what a list no longer has of a frame is the controller's
            key = (*key[:-2], *(None if CONTROLLERS.fullmatch(name) else name for name in key[-2:]))
        if not here and key not in known[motion.file, motion.line]:
            raise Finding("cut", f"{motion.file}:{motion.line}: {motion.kind} is another, silently")


def _key(motion):
    pose = None if motion.pose is None else tuple(np.round(motion.pose, 6).ravel() + 0.0)
    speed = None if motion.speed_mm_s is None else round(motion.speed_mm_s, 6)
    return motion.kind, motion.aux, pose, speed, motion.tool, motion.base


def run_one(seed, number, others, folder):
    """'read', 'doubtful' (problems) or 'refused', and s. Raises Finding."""
    files, whole, place = files_of(seed, number, others)
    try:
        before = read(whole, seed.name, folder)[0] if whole else None
    except ProgramError:
        before = None
    try:
        program, seconds = read(files, seed.name, folder)
    except ProgramError:
        return "refused", 0.0
    if before is not None:
        compare(program, before, place)
    return "doubtful" if program.problems else "read", seconds


def _alarm(*_):
    raise Slow


def _work(pipe, seed, numbers, others):
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGPROF, _alarm)
    with tempfile.TemporaryDirectory(dir=ramdisk()) as folder:
        for number in numbers:
            pipe.send(("begin", number, None))
            try:
                end, seconds = run_one(seed, number, others, Path(folder))
                pipe.send((end, number, seconds))
            except Finding as finding:
                pipe.send(("finding", number, finding.args))
    pipe.send(("done", None, None))


def ramdisk():
    """Where the many small files are written; None: the usual place."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


def fuzz(seed, numbers, others, most=20):
    """Reads inputs in a process of its own. Returns a Counter, the longest time in s and a list of
    (number, kind, words); ends after ``most`` findings."""
    counts, longest, findings = collections.Counter(), 0.0, []
    numbers = list(numbers)
    while numbers and len(findings) < most:
        here, there = multiprocessing.Pipe(duplex=False)
        worker = multiprocessing.get_context("fork").Process(
            target=_work, args=(there, seed, numbers, others)
        )
        worker.start()
        there.close()
        number = numbers[0]
        while True:
            try:
                if not here.poll(SILENCE):
                    findings.append((number, "hang", f"no answer in {SILENCE:g} s"))
                    break
                what, number, value = here.recv()
            except EOFError:
                findings.append((number, "crash", f"the process ended, {worker.exitcode}"))
                break
            if what == "done":
                number = numbers[-1]
                break
            if what == "finding":
                counts["finding"] += 1
                findings.append((number, *value))
                if len(findings) >= most:
                    break
            elif what != "begin":
                counts[what] += 1
                longest = max(longest, value)
        worker.kill()
        worker.join()
        numbers = [n for n in numbers if n > number]
    return counts, longest, findings


def others_of(suffix, every):
    """Bytes of all files of a language, to take pieces from."""
    reader = READERS[suffix]
    mates = [s for other, group in every.items() if READERS[other] is reader for s in group]
    return [data for seed in mates for data in seed.files.values()]


def campaign(inputs, first=0, only=None, keep=None, shown=print, folders=None):
    """Fuzzes every language with the same share of ``inputs``; returns (rows, findings)."""
    every = seeds(folders)
    suffixes = [s for s in sorted(every) if only in (None, s)]
    rows, findings = [], []
    for suffix in suffixes:
        counts, longest = collections.Counter(), 0.0
        share = -(-inputs // (len(suffixes) * len(every[suffix])))
        others = others_of(suffix, every)
        begin = time.time()
        for seed in every[suffix]:
            numbers = range(first, first + share)
            some, seconds, wrong = fuzz(seed, numbers, others)
            counts += some
            longest = max(longest, seconds)
            for number, kind, words in wrong:
                findings.append((seed.name, number, kind, words))
                shown(f"{seed.name}:{number}: {kind}: {words}")
                if keep:
                    save(seed, number, others, Path(keep) / f"{seed.name}-{number}-{kind}")
        rows.append((suffix, counts, longest, time.time() - begin))
        shown(
            f"{suffix:8} {sum(counts.values()):8} inputs: {counts['read']} read, "
            f"{counts['doubtful']} with problems, {counts['refused']} refused, "
            f"{counts['finding']} findings; longest {longest:.2f} s; {time.time() - begin:.0f} s"
        )
    return rows, findings


def save(seed, number, others, folder):
    """Writes an input's files, and the whole file beside a cut one."""
    files, whole, _ = files_of(seed, number, others)
    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    for name, data in (whole or {}).items():
        (folder / "whole").mkdir(exist_ok=True)
        (folder / "whole" / name).write_bytes(data)


def replay(text, keep):
    """Reads the one input FILE:NUMBER again."""
    name, _, number = text.rpartition(":")
    every = seeds()
    seed = next(s for group in every.values() for s in group if s.name == name)
    others = others_of(Path(name).suffix.lower(), every)
    if keep:
        save(seed, int(number), others, Path(keep))
    signal.signal(signal.SIGPROF, _alarm)
    with tempfile.TemporaryDirectory() as folder:
        print(run_one(seed, int(number), others, Path(folder)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--inputs", type=int, default=200_000, help="of all languages together")
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    parser.add_argument("--only", help="a suffix, with its dot")
    parser.add_argument("--keep", help="folder for the inputs that are findings")
    parser.add_argument("--replay", help="FILE:NUMBER, one input")
    options = parser.parse_args()
    if options.replay:
        replay(options.replay, options.keep)
        return 0
    for suffix in uncovered():
        print(f"{suffix}: no seed in {OWN}")
    rows, findings = campaign(options.inputs, options.first, options.only, options.keep)
    total = sum(sum(counts.values()) for _, counts, _, _ in rows)
    print(f"{total} inputs, {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
