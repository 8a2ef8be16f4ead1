#!/usr/bin/env python3
"""Kills runs and documents at random moments, and looks at what is left.

    tests/robustness/kill.py run --kills 50
    tests/robustness/kill.py document --kills 50

run: `beltgrind run` into one folder, again and again. The folder holds one whole result, or one that
says that it is none.
document: a process inside FreeCAD that changes a setting, simulates and saves, again and again. The
document that lies in the file opens, and its result is the one that belongs to its settings.
"""

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
for folder in (ROOT / "Mod" / "BeltGrinding", ROOT / "tests", ROOT / "tests" / "robustness"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

SPACINGS = (1.0, 1.1, 1.2, 1.3)  # mm, one after the other: what was written says which
START = 240.0  # s for FreeCAD to begin, on a busy machine

GRIND = """
import json, sys
import beltgrinding
job, out, spacings = json.load(open(sys.argv[1])), sys.argv[2], json.loads(sys.argv[3])
print("ready", flush=True)
while True:
    for spacing in spacings:
        job["sampling"]["spacing_mm"] = spacing
        beltgrinding.run(job).write(out)
        print(spacing, flush=True)
"""

DOCUMENT = """
import os
import FreeCAD
import beltgrinding
from beltgrinding.objects import job_inputs
path = os.environ["KILL_DOCUMENT"]
document = FreeCAD.openDocument(path)
job = next(o for o in document.Objects if hasattr(o, "DesignFaces"))
os.write(2, b"ready\\n")
while True:
    for spacing in SPACINGS:
        job.Spacing = spacing
        beltgrinding.simulate(job)
        document.save()
        os.write(2, b"saved\\n")
"""

LOOK = """
import os
import FreeCAD
import beltgrinding
from beltgrinding.objects.job_object import child
from beltgrinding.objects.simulation import Simulation
document = FreeCAD.openDocument(os.environ["KILL_DOCUMENT"])
job = next(o for o in document.Objects if hasattr(o, "DesignFaces"))
document.recompute()
simulation = child(job, Simulation)
field = simulation.Proxy.field(simulation)
assert field is not None and field.size == simulation.Samples, "its height field is missing"
assert abs(field.spacing - job.Spacing.Value) < 1e-9, "its result is of other settings"
assert not simulation.OutOfDate, "its result is out of date"
for text in ("FaultyFeature", "Invalid"):
    assert not any(text in o.State for o in document.Objects), text
"""


def plate():
    """A job on a plate, as plain data."""
    from random_jobs import box

    ends = [{"x_mm": x, "y_mm": 15, "z_mm": 10.2, "feed_mm_s": 30} for x in (5, 35)]
    down = {"qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}
    return {
        "design": {"brep": box().write_brep()},
        "sampling": {"spacing_mm": SPACINGS[0]},
        "stock": {"allowance_mm": 0.2},
        "belt_machine": {"wheel": {"radius_mm": 60, "width_mm": 15}, "force_N": 30},
        "programs": [{"poses": [{**end, **down} for end in ends]}],
    }


def kill_after_start(command, delay, environment, stream):
    """Starts a process, waits until it says "ready" on ``stream``, and ``delay`` s more; kills it.
    Raises RuntimeError with what it said if it ends before."""
    streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, stream: subprocess.PIPE}
    process = subprocess.Popen(
        command, env=environment, text=True, stdin=subprocess.DEVNULL, **streams
    )
    said = []
    try:
        for line in getattr(process, stream):
            said.append(line)
            if line.strip() == "ready":
                break
        time.sleep(delay)
        if process.poll() is not None:
            raise RuntimeError("it ended by itself: " + "".join(said)[-2000:])
    finally:
        process.kill()
        process.wait()


def first_result(command, environment):
    """How long (s) a process takes from "ready" to its first whole result, on this machine, now."""
    process = subprocess.Popen(
        command, env=environment, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE
    )
    try:
        assert process.stdout.readline().strip() == "ready", "it did not begin"
        begin = time.monotonic()
        assert process.stdout.readline(), "it ended without a result"
        return time.monotonic() - begin
    finally:
        process.kill()
        process.wait()


def kill_runs(kills, seed, longest, tell=lambda text: None):
    """Kills command-line runs, each after ``longest`` times what a first result takes or earlier.
    Returns {what was left: how often}; raises AssertionError."""
    from beltgrinding.engine import InputError
    from beltgrinding.simulation.result import Result

    dice, counts = random.Random(seed), {}
    with tempfile.TemporaryDirectory(prefix="beltgrinding-kill-") as folder:
        job, out = Path(folder, "job.json"), Path(folder, "out")
        job.write_text(json.dumps(plate()))
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}

        def command(out):
            return [sys.executable, "-c", GRIND, str(job), str(out), json.dumps(SPACINGS)]

        longest *= first_result(command(Path(folder, "timed")), environment)
        for number in range(kills):
            kill_after_start(command(out), dice.uniform(0.0, longest), environment, "stdout")
            try:
                result = Result.read(out)
                spacing = result.job["sampling"]["spacing_mm"]
                assert result.field.size == result.summary["samples"], "files of two results"
                assert abs(result.field.spacing - spacing) < 1e-9, "files of two results"
                found = "a whole result"
            except InputError as error:
                assert not (out / "summary.json").exists(), f"a result that cannot be read: {error}"
                found = "no result, and said so"
            counts[found] = counts.get(found, 0) + 1
            tell(f"{number + 1}: {found}")
    return counts


def kill_documents(kills, seed, longest, tell=lambda text: None):
    """Kills FreeCAD while it simulates and saves; the same."""
    dice, counts = random.Random(seed), {}
    with tempfile.TemporaryDirectory(prefix="beltgrinding-kill-") as folder:
        home = Path(folder, "home")
        mods = home / ".local" / "share" / "FreeCAD" / "Mod"
        mods.mkdir(parents=True)
        (mods / "BeltGrinding").symlink_to(ROOT / "Mod" / "BeltGrinding")
        path = Path(folder, "blade.FCStd")
        scripts = {}
        make = (
            "import os, beltgrinding, json\nimport FreeCAD\nfrom beltgrinding.objects import api\n"
        )
        make += "document = FreeCAD.newDocument('plate')\njob = beltgrinding.open_job(document, "
        make += "os.environ['KILL_JOB'])\nbeltgrinding.simulate(job)\n"
        make += "document.saveAs(os.environ['KILL_DOCUMENT'])\n"
        texts = {"make": make, "grind": f"SPACINGS = {SPACINGS}\n{DOCUMENT}", "look": LOOK}
        for name, text in texts.items():
            scripts[name] = Path(folder, f"{name}.py")
            scripts[name].write_text(text)
        job = Path(folder, "job.json")
        job.write_text(json.dumps(plate()))
        command = ["freecadcmd", str(ROOT / "tools" / "in_freecad.py")]

        def environment(script):
            return {
                **os.environ,
                "HOME": str(home),
                "BELTGRINDING_RUN": str(scripts[script]),
                "KILL_DOCUMENT": str(path),
                "KILL_JOB": str(job),
            }

        def run(script):
            done = subprocess.run(
                command,
                env=environment(script),
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=START,
            )
            assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]

        run("make")
        for number in range(kills):
            before = path.stat().st_mtime_ns
            kill_after_start(command, dice.uniform(0.0, longest), environment("grind"), "stderr")
            run("look")
            found = "the document as before" if path.stat().st_mtime_ns == before else "a newer one"
            counts[found] = counts.get(found, 0) + 1
            tell(f"{number + 1}: {found}")
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("run", "document"))
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--longest",
        type=float,
        default=3.0,
        help="s until the kill; of a run, in " "times what its first result takes (3.0)",
    )
    arguments = parser.parse_args()
    kill = kill_runs if arguments.what == "run" else kill_documents
    print(kill(arguments.kills, arguments.seed, arguments.longest, print))


if __name__ == "__main__":
    main()
