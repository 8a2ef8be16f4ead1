#!/usr/bin/env python3
"""Flips one bit of what a document holds, opens it in freecadcmd, and checks that nothing worse comes of it.

    tests/robustness/fuzz_documents.py --cases 500

A document opens, or FreeCAD refuses it; no traceback, no crash, no more than MOST of memory, within LIMIT; and its job,
if it has one still, is run on or says in one line why not. Case ``number`` of ``seed`` is the same each time;
``--keep FOLDER`` keeps the documents of findings.
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LIMIT = 60.0  # s for a document
MOST = 1000  # MB that a process may take at any time
ADDRESS_SPACE = 4_000_000  # KiB
BATCH = 25  # documents that one FreeCAD opens
MODULE_GONE = (
    r"<class '(ImportError|ModuleNotFoundError)'>"  # FreeCAD's one line on a damaged class's name
)
DOCUMENTS = ROOT / "tests" / "gui" / "documents"
SHAPES = (".brp", ".h5")  # FreeCAD's own, and what has checksums: seldom

OPENS = """
import os, resource, sys, traceback
import FreeCAD
from beltgrinding.engine import InputError
from beltgrinding.objects import api, job_inputs
for path in os.environ["DAMAGED"].split(os.pathsep):
    print("\\n@@", path, flush=True)
    with open("/proc/self/clear_refs", "w") as file:
        file.write("5")  # VmHWM begins anew
    try:
        document = FreeCAD.openDocument(path)
        for job in [one for one in document.Objects if api.is_job(one)]:
            try:
                job_inputs.fingerprint(job)
                with job_inputs.scratch_folder() as folder:
                    job_inputs.to_data(job, folder)
            except InputError as error:
                print("told:", error, flush=True)
            document.recompute()
        FreeCAD.closeDocument(document.Name)
    except OSError as error:
        print("refused:", error, flush=True)
    except Exception:
        traceback.print_exc()
    told = dict(line.split(":", 1) for line in open("/proc/self/status"))
    print("\\n@peak", int(told["VmHWM"].split()[0]) // 1024, flush=True)
sys.stdout.flush()
os._exit(0)
"""


def damage(seed, number, target):
    """Writes case ``number`` of ``seed`` to ``target``; says what it is."""
    dice = random.Random(f"{seed} {number}")
    source = dice.choice(sorted(DOCUMENTS.glob("*/*.FCStd")))
    with zipfile.ZipFile(source) as file:
        held = {name: bytearray(file.read(name)) for name in file.namelist()}
    names = sorted(name for name in held if held[name] and name != "thumbnails/Thumbnail.png")
    few = [name for name in names if name.endswith(SHAPES)]
    names = [name for name in names if name not in few]
    kind = dice.random()
    if kind < 0.4:
        name = "Document.xml"
    elif kind < 0.9 or not few:
        name = dice.choice(names)
    else:
        name = dice.choice(few)
    data = held[name]
    # The head of a list, its length, is short and matters more than what follows.
    at = dice.randrange(min(len(data), 4) if dice.random() < 0.3 else len(data))
    bit = dice.randrange(8)
    data[at] ^= 1 << bit
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as file:
        for one, content in held.items():
            file.writestr(one, bytes(content))
    return f"{source.parent.name}: {name}, byte {at}, bit {bit}"


def run(paths, home):
    """{path: what FreeCAD said of it, and its peak in MB, None where it died}"""
    script = home / "opens.py"
    script.write_text(OPENS)
    mods = home / ".local" / "share" / "FreeCAD" / "Mod"
    if not mods.exists():
        mods.mkdir(parents=True)
        (mods / "BeltGrinding").symlink_to(ROOT / "Mod" / "BeltGrinding")
    command = f"ulimit -v {ADDRESS_SPACE}; exec freecadcmd {ROOT / 'tools' / 'in_freecad.py'}"
    environment = {
        **os.environ,
        "HOME": str(home),
        "BELTGRINDING_RUN": str(script),
        "DAMAGED": os.pathsep.join(map(str, paths)),
    }
    try:
        done = subprocess.run(
            ["bash", "-c", command],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=LIMIT * len(paths),
        )
        output = done.stdout
    except subprocess.TimeoutExpired as error:
        output = error.stdout or b""
    found = {}
    for part in output.decode(errors="replace").split("\n@@ ")[1:]:
        path, _, said = part.partition("\n")
        said, _, peak = said.partition("\n@peak ")
        found[Path(path)] = (said, int(peak.split()[0]) if peak.strip() else None)
    return found


def opened(paths):
    """``run`` in a home of its own."""
    with tempfile.TemporaryDirectory() as folder:
        return run(paths, Path(folder))


def judge(said, peak):
    """What is wrong, '' for nothing."""
    if peak is None:
        return "died, or did not end"
    said = re.sub(MODULE_GONE, "", said)
    if "Traceback" in said or "<class '" in said:
        return "a traceback"
    return f"took {peak} MB" if peak > MOST else ""


def cases(seed, numbers, keep=None):
    """Yields (number, what was damaged, what is wrong, what FreeCAD said)."""
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        numbers = list(numbers)
        while numbers:
            paths, about = {}, {}
            for number in numbers[:BATCH]:
                path = home / f"case{number}.FCStd"
                about[number] = damage(seed, number, path)
                paths[number] = path
            found = run(list(paths.values()), home)
            done = 0
            for number, path in paths.items():
                if path not in found:
                    break
                said, peak = found[path]
                wrong = judge(said, peak)
                if wrong and keep:
                    keep.mkdir(parents=True, exist_ok=True)
                    shutil.copy(path, keep)
                yield number, about[number], wrong, said
                done += 1
            if not done:
                raise RuntimeError("FreeCAD does not start")
            numbers = numbers[done:]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for documents of findings")
    arguments = parser.parse_args()
    numbers = range(arguments.first, arguments.first + arguments.cases)
    findings = told = 0
    for number, about, wrong, said in cases(arguments.seed, numbers, arguments.keep):
        told += "damaged" in said or "told:" in said or "refused:" in said or "failed" in said
        if wrong:
            findings += 1
            print(f"{number}: {about}: {wrong}\n{said[-1500:]}", flush=True)
    print(f"seed {arguments.seed}: {arguments.cases} documents, {told} told, {findings} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
