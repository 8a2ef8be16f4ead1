#!/usr/bin/env python3
"""Lets every call of the file system, and every allocation of ours, fail once in turn; kills a writer at
each of its calls of the file system. As SQLite tests itself.

    tests/robustness/fault_injection.py files
    tests/robustness/fault_injection.py memory --share 0.01

files: a result replaces another, both ways (``base.folders``), and a C++ file is written whole. Each of their
calls fails, or is the last that the process makes: what is found afterwards is wholly the old or wholly the new
one, and what succeeded is the new.
memory: a small job; each allocation fails: it ends in MemoryError or InputError, and the same job
run again gives the same bytes.

Starts itself again with faults.cpp preloaded, which it builds with the system's compiler.
"""

import argparse
import ctypes
import errno
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
for folder in (ROOT / "Mod" / "BeltGrinding", ROOT / "tests" / "workbench", HERE):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

PRELOADED = "BELTGRINDING_FAULTS"  # the library's path, in the process that has it
FAILED, DONE = 3, 0  # status of a child that wrote
ERRORS = (errno.EIO, errno.ENOSPC)
MOST = 10_000  # calls of one writing: more is a loop


class Finding(Exception):
    """What was wrong after a fault."""


def build(folder):
    """The preloaded library's path."""
    target = Path(folder, "libfaults.so")
    source = HERE / "faults" / "faults.cpp"
    command = ["c++", "-std=c++20", "-O1", "-shared", "-fPIC", "-w", source, "-o", target, "-ldl"]
    subprocess.run([*map(str, command)], check=True)
    return target


def faults():
    library = ctypes.CDLL(os.environ[PRELOADED])
    library.fault_files.argtypes = [ctypes.c_long, ctypes.c_int, ctypes.c_int]
    library.fault_memory.argtypes = [ctypes.c_long, ctypes.c_size_t, ctypes.c_size_t]
    for name in ("fault_files_seen", "fault_memory_seen"):
        getattr(library, name).restype = ctypes.c_long
    return library


def in_child(work, nth, error, kills):
    """(status or -signal, calls seen) of ``work()`` in a fork of this process with a fault."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        library, status = faults(), DONE
        library.fault_files(nth, error, kills)
        try:
            work()
        except BaseException as problem:  # told to the parent, which decides
            status = FAILED if type(problem).__name__ == "InputError" else 4
            told = f"{type(problem).__name__}: {problem}"
        else:
            told = ""
        seen = library.fault_files_seen()
        library.fault_files(-1, 0, 0)
        os.write(writer, json.dumps([seen, told]).encode())
        os._exit(status)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        data = pipe.read()
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    seen, told = json.loads(data) if data else (0, "")
    if status == 4:
        raise Finding(f"call {nth}: {told}")
    return status, seen


def every_call(work, look, before):
    """Each call of ``work`` fails, then kills. ``look()`` is True for the new, False for the old state and
    raises for any other; ``before()`` makes the old one. Returns the number of faults."""
    count = 0
    for kills in (0, 1):
        for nth in range(MOST):
            before()
            status, seen = in_child(work, nth, ERRORS[nth % 2], kills)
            new = look()
            if status == DONE and not new:
                raise Finding(f"call {nth}: said to be done, and the old is there")
            count += 1
            if status == DONE and seen <= nth:
                break  # the fault never came
    return count


def results():
    import beltgrinding
    from beltgrinding.simulation import result_folder
    from test_job import plate_job

    found = []
    for spacing in (4.0, 5.0):
        job = plate_job()
        job["sampling"]["spacing_mm"] = spacing
        result = beltgrinding.run(job)
        result.summary["run_id"] = result_folder.run_id(result.summary)
        found.append((result, result._contents()))
    return found


def check_files(tell):
    from beltgrinding.base import folders
    from beltgrinding.simulation import result_folder
    from beltgrinding.simulation.result import Result

    (old, old_files), (new, new_files) = results()
    counts = {}
    with tempfile.TemporaryDirectory() as place:
        out = Path(place, "out")

        def before():
            shutil.rmtree(place)
            out.mkdir(parents=True)
            if way == "journal":
                (out / "pictures").mkdir()  # it cannot change places then
            result_folder.write(out, old_files, old.summary)
            (out / "notes.txt").write_text("mine")

        def work():
            result_folder.write(out, new_files, new.summary)

        def look():
            if way == "exchange":
                seen = samples(out)  # without any help
            found = Result.read(out).summary["samples"]
            if way == "exchange" and seen != {found}:
                raise Finding(f"mixed: {seen}")
            if (out / "notes.txt").read_text() != "mine":
                raise Finding("the user's file is not as it was")
            return found == new.summary["samples"]

        for way in ("exchange", "journal"):
            counts[way] = every_call(work, look, before)
            tell(f"{way}: {counts[way]} faults")

        path = out / "field.h5"
        images = [one.field.hdf5("") for one in (old, new)]

        def look_at_one():
            return images.index(path.read_bytes()) == 1

        counts["C++ file"] = every_call(
            lambda: new.field.write_hdf5(str(path), ""),
            look_at_one,
            lambda: path.write_bytes(images[0]),
        )
        tell(f"C++ file: {counts['C++ file']} faults")
    return counts


def samples(out):
    """Numbers of samples that the files of a result tell, each for itself."""
    head = (out / "deviation.ply").read_bytes()[:400].split(b"element vertex ")[1]
    return {json.loads((out / "summary.json").read_text())["samples"], int(head.split()[0])}


def own_code():
    """(begin, end) of the core's code in memory."""
    from beltgrinding.engine import core

    spans = [
        [int(word, 16) for word in line.split()[0].split("-")]
        for line in Path("/proc/self/maps").read_text().splitlines()
        if line.endswith(Path(core.__file__).name) and "x" in line.split()[1]
    ]
    return min(begin for begin, _ in spans), max(end for _, end in spans)


def check_memory(tell, share, seed=0):
    """``share``: of the allocations that fail, chosen by chance."""
    import beltgrinding
    from beltgrinding.engine import InputError, core
    from test_job import plate_job

    library, (begin, end) = faults(), own_code()
    core.set_threads(1)
    job = plate_job()
    job["sampling"]["spacing_mm"] = 4.0

    def bytes_of_run():
        result = beltgrinding.run(job)
        return result.field.hdf5("") + result.field.height.tobytes()

    bytes_of_run()  # what is kept for the next run, such as a rim, is there
    library.fault_memory(sys.maxsize, begin, end)
    whole = bytes_of_run()
    most = library.fault_memory_seen()
    if most < 100:
        raise Finding(f"only {most} allocations seen: the library does not see ours")
    dice, done = random.Random(seed), 0
    for nth in range(most):
        if dice.random() > share:
            continue
        library.fault_memory(nth, begin, end)
        try:
            bytes_of_run()
        except (MemoryError, InputError):
            pass
        except Exception as error:
            raise Finding(f"allocation {nth}: {type(error).__name__}: {error}") from error
        library.fault_memory(-1, begin, end)
        done += 1
        if done % 50 == 0 and bytes_of_run() != whole:
            raise Finding(f"after allocation {nth} the same job gives other bytes")
    tell(f"memory: {done} of {most} allocations failed")
    return done


def run(what, share=1.0):
    """Starts this file again with the library preloaded; its CompletedProcess."""
    with tempfile.TemporaryDirectory() as folder:
        library = str(build(folder))
        environment = {**os.environ, PRELOADED: library, "LD_PRELOAD": library}
        return subprocess.run(
            [sys.executable, __file__, what, "--share", str(share)],
            env=environment,
            capture_output=True,
            text=True,
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("files", "memory"))
    parser.add_argument("--share", type=float, default=1.0, help="of the allocations (default all)")
    arguments = parser.parse_args()
    if PRELOADED not in os.environ:
        done = run(arguments.what, arguments.share)
        print(done.stdout, end="")
        print(done.stderr, end="", file=sys.stderr)
        sys.exit(done.returncode)

    def tell(text):
        print(text, flush=True)

    try:
        if arguments.what == "files":
            check_files(tell)
        else:
            check_memory(tell, arguments.share)
    except Finding as finding:
        print(f"FINDING: {finding}")
        sys.exit(1)


if __name__ == "__main__":
    main()
