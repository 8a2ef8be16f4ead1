"""Run by tools/bench start: what the workbench costs those who only start something.

Writes Google Benchmark's JSON to BELTGRINDING_BENCH_OUT. Figures in ms, each the median of runs that take
turns, so that what else the machine does falls on all alike:

- import: Python from its start to its end with ``import beltgrinding``, and without it (``bare``), with the
  compiled core loaded too, and the command line's ``--help``;
- freecad: FreeCAD from its start until its window answers, without the workbench and with it, and the
  difference. On a new home each, which knows the window's first start already. ``_cpu``: processor time of
  the same, which a busy machine disturbs less;
- freecad_own_cpu: processor time of FreeCAD's process from the begin to the end of our Init.py and InitGui.py, which
  is all that FreeCAD runs of the workbench before its window answers. The difference of two whole starts varies by
  more than that on a busy machine.
"""

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MOD = ROOT / "Mod" / "BeltGrinding"
PYTHON = {
    "bare": ["-c", "pass"],
    "package": ["-c", "import beltgrinding"],
    "with_core": ["-c", "from beltgrinding import core"],
    "help": ["-m", "beltgrinding", "--help"],
}
# FreeCAD's window answers when a timer of no delay runs; the moment is told by the file's own contents,
# since FreeCAD may be slow to end.
ANSWER = """
import os, time
from PySide import QtCore
def done():
    with open(os.environ["ANSWERED"], "w") as file:
        file.write(repr((time.clock_gettime(time.CLOCK_MONOTONIC), sum(os.times()[:4]))))
    os._exit(0)
QtCore.QTimer.singleShot(0, done)
"""


# Around the text of Init.py and of InitGui.py.
BEGIN = "import time as _time; _begin = _time.process_time()\n"
END = """
with open(__import__("os").environ["OWN"], "a") as _file:
    _file.write(f"{_time.process_time() - _begin}\\n")
"""
MOST_OWN = 50.0  # ms that a start may take longer


def children_s():
    """Processor time of the processes that ended so far, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def python_ms(arguments):
    """(wall, processor) time of one Python, ms."""
    environment = {**os.environ, "PYTHONPATH": str(MOD)}
    before, start = children_s(), time.perf_counter()
    subprocess.run(
        [sys.executable, *arguments], env=environment, stdout=subprocess.DEVNULL, check=True
    )
    wall = time.perf_counter() - start
    return 1e3 * wall, 1e3 * (children_s() - before)


def freecad_ms(home, script):
    """(wall, processor) time of one FreeCAD until its window answers, ms."""
    answered = home / "answered"
    answered.unlink(missing_ok=True)
    environment = {**os.environ, "HOME": str(home), "ANSWERED": str(answered)}
    environment["OWN"] = str(home / "own")
    environment["QTWEBENGINE_DISABLE_SANDBOX"] = "1"
    environment.pop("PYTHONPATH", None)  # FreeCAD finds its workbenches itself
    start = time.clock_gettime(time.CLOCK_MONOTONIC)
    done = subprocess.run(
        ["freecad", str(script)],
        env=environment,
        cwd=home,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=180,
    )
    if not answered.exists():
        sys.exit(f"FreeCAD did not start: {done.stdout[-2000:].decode(errors='replace')}")
    end, used = json.loads(answered.read_text().replace("(", "[").replace(")", "]"))
    return 1e3 * (end - start), 1e3 * used


def in_turns(runs, kinds, measure):
    """{kind: [(wall, processor)]}: a first round that fills caches, then ``runs`` that count. The order
    turns over each time."""
    found = {kind: [] for kind in kinds}
    for turn in range(runs + 1):
        for kind in list(kinds) if turn % 2 else reversed(list(kinds)):
            found[kind].append(measure(kind))
    return {kind: values[1:] for kind, values in found.items()}


def medians(found):
    """{kind: (wall, processor)}"""
    return {
        kind: tuple(statistics.median(value[k] for value in values) for k in (0, 1))
        for kind, values in found.items()
    }


def extra(found, k):
    """The median of what each run with the workbench took longer than its neighbour without."""
    return statistics.median(a[k] - b[k] for a, b in zip(found["with"], found["without"]))


def starts(folder, runs):
    script = folder / "answer.py"
    script.write_text(ANSWER)
    homes = {kind: folder / kind for kind in ("without", "with")}
    for kind, home in homes.items():
        mods = home / ".local" / "share" / "FreeCAD" / "Mod"
        mods.mkdir(parents=True)
        if kind == "with":
            lay_timed(mods / "BeltGrinding")
    return in_turns(runs, homes, lambda kind: freecad_ms(homes[kind], script)), own_ms(
        homes["with"]
    )


def lay_timed(folder):
    """The workbench, whose two files that FreeCAD runs tell how long they took."""
    folder.mkdir()
    for entry in MOD.iterdir():
        (folder / entry.name).symlink_to(entry)
    for name in ("Init.py", "InitGui.py"):
        text = (folder / name).read_text()
        (folder / name).unlink()
        (folder / name).write_text(BEGIN + text + END)


def own_ms(home):
    """Processor time of both files, ms: the median of the starts but the first."""
    told = [float(line) for line in (home / "own").read_text().split()]
    both = [1e3 * sum(told[k : k + 2]) for k in range(2, len(told), 2)]
    return statistics.median(both)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=20, help="of FreeCAD, with and without")
    arguments = parser.parse_args()
    results = {}
    for kind, (wall, used) in medians(
        in_turns(2 * arguments.runs, PYTHON, lambda kind: python_ms(PYTHON[kind]))
    ).items():
        results[f"start/import_{kind}"] = wall
        results[f"start/import_{kind}_cpu"] = used
    with tempfile.TemporaryDirectory() as folder:
        found, own = starts(Path(folder), arguments.runs)
    for kind, (wall, used) in medians(found).items():
        results[f"start/freecad_{kind}"] = wall
        results[f"start/freecad_{kind}_cpu"] = used
    results["start/freecad_extra"] = extra(found, 0)
    results["start/freecad_extra_cpu"] = extra(found, 1)
    results["start/freecad_own_cpu"] = own
    for name, value in results.items():
        print(f"{name:40} {value:10.1f}")
    if own > MOST_OWN:
        print(f"start/TOO SLOW: the workbench may take {MOST_OWN:.0f} ms of FreeCAD's start")
    benchmarks = [
        {"name": name, "real_time": value, "time_unit": "ms"} for name, value in results.items()
    ]
    if "BELTGRINDING_BENCH_OUT" in os.environ:
        Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
            json.dumps({"context": {}, "benchmarks": benchmarks})
        )


main()
