#!/usr/bin/env python3
"""Fuzzes the readers of robot programs along what they do: an input that reaches new code is kept.

    tests/fuzz/coverage_fuzz.py --minutes 60 --corpus /tmp/corpus

The corpus, a folder a language, grows by the inputs that took a line of the readers after another line
as none did before; new inputs are made of it (program_mutations.py, structure.py). Each is judged as
in fuzz_programs.py: a Program or a ProgramError within LIMIT seconds, sound poses. Findings are
written to CORPUS/findings. --replay FILE reads one input again.
"""

import argparse
import collections
import gzip
import hashlib
import multiprocessing
import random
import resource
import signal
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
for folder in (HERE, HERE.parents[1] / "Mod" / "BeltGrinding"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

import fuzz_programs as fuzzing  # noqa: E402
from beltgrinding.programs import program as programs  # noqa: E402
from beltgrinding.programs.program import ProgramError  # noqa: E402
from beltgrinding.programs.registry import READERS  # noqa: E402
from program_mutations import damaged  # noqa: E402
from structure import restructured, words_of  # noqa: E402

WATCHED = str(Path(programs.__file__).parent)  # the folder whose code is watched
LARGEST = 6_000  # bytes of an input in the corpus: short ones are read often
LIMIT = fuzzing.LIMIT  # s
WATCHED_LIMIT = 4 * LIMIT  # s; being watched takes several times as long
PATIENCE, SELDOM = 200, 25  # calls of a function without news; it is watched in one of so many then
ROUND = 500  # inputs of a process, which then hands on what it found
SIZES = 64 << 20, 4 << 30  # bytes: a whole reader must do with the second


class Arcs:
    """Which line followed which, in the readers' files: ``known``, and of one input ``new``.

    To be watched is dear: a function that has shown nothing new for long is looked at now and then.
    """

    def __init__(self, known=()):
        self.known, self.new = set(known), set()
        self.files, self.idle = {}, {}

    def __enter__(self):
        self.new = set()
        sys.settrace(self._call)
        return self

    def __exit__(self, *_):
        sys.settrace(None)
        self.known |= self.new

    def _call(self, frame, event, _):
        code = frame.f_code
        idle = self.idle.get(code, 0)
        self.idle[code] = idle + 1
        if idle > PATIENCE and idle % SELDOM:
            return None
        name = code.co_filename
        number = self.files.get(name)
        if number is None:
            watched = name.startswith(WATCHED)
            text = name[len(WATCHED) :].encode()
            number = int(hashlib.md5(text).hexdigest()[:6], 16) + 1 if watched else 0
            self.files[name] = number
        if not number:
            self.idle[code] = PATIENCE + 1
            return None
        last = 0

        def line(frame, event, _):
            nonlocal last
            if event == "line":
                arc = number, last, frame.f_lineno
                last = frame.f_lineno
                if arc not in self.known and arc not in self.new:
                    self.new.add(arc)
                    self.idle[code] = 0
            return line

        return line


def run(suffix, files, folder, arcs):
    """(Finding or None, how it ended) of one input; what it reached is in ``arcs``."""
    name = f"a{suffix}"
    try:
        with arcs:
            program, _ = fuzzing.read(files, name, folder)
        return None, "doubtful" if program.problems else "read"
    except ProgramError:
        return None, "refused"
    except fuzzing.Finding as finding:
        return _again(name, files, folder) if finding.args[0] == "slow" else (finding, "finding")


def _again(name, files, folder):
    """What took too long while it was watched, unwatched."""
    limit, fuzzing.LIMIT = fuzzing.LIMIT, LIMIT
    try:
        fuzzing.read(files, name, folder)
        return None, "long"
    except ProgramError:
        return None, "refused"
    except fuzzing.Finding as finding:
        return finding, "finding"
    finally:
        fuzzing.LIMIT = limit


def renamed(seed):
    """A seed's files, those with its name named as those of the corpus: 'a' and their suffixes."""
    own = Path(seed.name).stem.lower()
    return {
        "a" + Path(name).suffix.lower() if Path(name).stem.lower() == own else name: data
        for name, data in seed.files.items()
    }


def made(parents, dice, words):
    """A new input of one of the corpus and pieces of others."""
    files = dict(dice.choice(parents))
    others = [data for one in dice.sample(parents, min(4, len(parents))) for data in one.values()]
    name = dice.choice(list(files))
    data = files[name]
    packed = data.startswith(b"\x1f\x8b")
    if packed:
        data = b"<URProgram/>"
    for _ in range(dice.choice((1, 1, 2, 4))):
        change = restructured if dice.random() < 0.5 else damaged
        data = (
            restructured(data, words, dice)
            if change is restructured
            else damaged(data, others, dice)
        )
    data = data[: fuzzing.SHORT * 4]
    files[name] = gzip.compress(data, 1) if packed and dice.random() < 0.5 else data
    return files


def _work(pipe, suffix, parents, known, seed, count):
    resource.setrlimit(resource.RLIMIT_AS, (SIZES[1], SIZES[1]))
    signal.signal(signal.SIGPROF, fuzzing._alarm)
    fuzzing.LIMIT = WATCHED_LIMIT
    arcs = Arcs(known)
    dice, words = random.Random(seed), words_of(READERS[suffix], parents)
    counts = collections.Counter()
    with tempfile.TemporaryDirectory(dir=fuzzing.ramdisk()) as folder:
        for number in range(count):
            files = made(parents, dice, words)
            pipe.send(("begin", files, None))
            finding, end = run(suffix, files, Path(folder), arcs)
            counts[end] += 1
            if finding is not None:
                pipe.send(("finding", files, finding.args))
            elif arcs.new:
                if sum(map(len, files.values())) <= LARGEST * 2:
                    parents.append(files)
                pipe.send(("new", files, arcs.new))
    pipe.send(("done", None, counts))


def explore(suffix, parents, known, seed, count):
    """Reads ``count`` new inputs in a process of its own; adds what is new to ``parents`` and
    ``known``. Returns (Counter of how they ended, findings as (files, kind, words))."""
    here, there = multiprocessing.Pipe(duplex=False)
    worker = multiprocessing.get_context("fork").Process(
        target=_work, args=(there, suffix, list(parents), set(known), seed, count)
    )
    worker.start()
    there.close()
    counts, findings, last = collections.Counter(), [], None
    while True:
        try:
            if not here.poll(fuzzing.SILENCE):
                findings.append((last, "hang", f"no answer in {fuzzing.SILENCE:g} s"))
                break
            what, files, value = here.recv()
        except EOFError:
            findings.append((last, "crash", f"the process ended, {worker.exitcode}"))
            break
        if what == "begin":
            last = files
        elif what == "new":
            known |= value
            parents.append(files)
        elif what == "finding":
            findings.append((files, *value))
        else:
            counts = value
            break
    worker.kill()
    worker.join()
    return counts, findings


def start(suffix, corpus, folders=None):
    """(inputs to begin with, arcs that they reach) of a language: its seeds and what was kept."""
    seeds = fuzzing.seeds(folders)
    same = [s for other, group in seeds.items() if READERS[other] is READERS[suffix] for s in group]
    parents = [renamed(seed) for seed in same]
    parents = [{(f"a{suffix}" if n == f"a{Path(s.name).suffix.lower()}" else n): d for n, d in p.items()}
               for s, p in zip(same, parents)]  # fmt: skip
    for path in sorted((corpus / suffix[1:]).glob("*")) if corpus else ():
        parents.append({file.name: file.read_bytes() for file in path.iterdir()})
    arcs = Arcs()
    with tempfile.TemporaryDirectory(dir=fuzzing.ramdisk()) as folder:
        before = signal.signal(signal.SIGPROF, fuzzing._alarm)
        for files in parents:
            run(suffix, files, Path(folder), arcs)
        signal.signal(signal.SIGPROF, before)
    return parents, arcs.known


def save(folder, files):
    """Writes an input into a folder named by its content."""
    name = hashlib.sha256(repr(sorted(files.items())).encode()).hexdigest()[:16]
    for file, data in files.items():
        (folder / name).mkdir(parents=True, exist_ok=True)
        (folder / name / file).write_bytes(data)
    return folder / name


def languages():
    """A suffix for each reader, the first one."""
    first = {}
    for suffix, reader in READERS.items():
        first.setdefault(reader, suffix)
    return sorted(first.values())


def campaign(minutes, corpus, only=None, seed=0, shown=print):
    """Explores every language for the same time; returns {suffix: (inputs, arcs at first, in the end)}
    and findings."""
    rows, findings = {}, []
    for suffix in languages() if only is None else [only]:
        parents, known = start(suffix, corpus)
        first, total, kept = len(known), collections.Counter(), len(parents)
        end = time.monotonic() + 60.0 * minutes / (1 if only else len(languages()))
        while time.monotonic() < end:
            counts, wrong = explore(suffix, parents, known, f"{seed}:{sum(total.values())}", ROUND)
            total += counts
            for files, kind, words in wrong:
                where = save(corpus / "findings" / suffix[1:], files)
                findings.append((suffix, kind, words))
                shown(f"{where}: {kind}: {words}")
            while kept < len(parents):
                save(corpus / suffix[1:], parents[kept])
                kept += 1
        rows[suffix] = sum(total.values()), first, len(known)
        shown(
            f"{suffix:8} {rows[suffix][0]:8} inputs ({dict(total)}), arcs {first} -> {len(known)}, "
            f"{len(parents)} kept"
        )
    return rows, findings


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="for all languages together")
    parser.add_argument("--corpus", type=Path, required=True, help="folder that grows")
    parser.add_argument("--only", help="a suffix, with its dot")
    parser.add_argument("--seed", default="0", help="of the dice")
    parser.add_argument("--replay", type=Path, help="the folder of one input")
    options = parser.parse_args()
    if options.replay:
        files = {path.name: path.read_bytes() for path in options.replay.iterdir()}
        suffix = next(s for s in languages() if f"a{s}" in files)
        signal.signal(signal.SIGPROF, fuzzing._alarm)
        with tempfile.TemporaryDirectory() as folder:
            print(run(suffix, files, Path(folder), Arcs()))
        return 0
    rows, findings = campaign(options.minutes, options.corpus, options.only, options.seed)
    print(f"{sum(row[0] for row in rows.values())} inputs, {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
