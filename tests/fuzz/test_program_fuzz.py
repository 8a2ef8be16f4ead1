"""A short run of fuzz_programs.py, and proof that its oracles see what they are for."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import fuzz_programs as fuzzing
from beltgrinding.programs.registry import READERS
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.program import Motion, Problem, Program

HERE = Path(__file__).resolve().parent

INPUTS = 30  # of each seed: damaged files
STRIDE = 29  # bytes between the cuts of each seed
# Shares of the damaged inputs: at least so many are still read, or nothing would be learnt of what is
# read; and of so many the damage is told, by a Problem or by refusing the file.
STILL_READ, TOLD = 0.15, 0.65
SEEDS = [seed for group in fuzzing.seeds([fuzzing.OWN]).values() for seed in group]


@pytest.mark.parametrize("seed", SEEDS, ids=lambda seed: seed.name)
def test_damaged_programs(seed):
    every = fuzzing.seeds([fuzzing.OWN])
    others = fuzzing.others_of(Path(seed.name).suffix, every)
    numbers = [*range(0, fuzzing.SHORT, STRIDE), *range(10_000, 10_000 + INPUTS)]
    counts, _, findings = fuzzing.fuzz(seed, numbers, others)
    assert not findings, f"replay with fuzz_programs.py --replay {seed.name}:NUMBER"
    assert sum(counts.values()) == len(numbers)
    assert not lopsided(counts)


def lopsided(counts):
    """What is wrong with the shares of inputs that were read, read with doubts, or refused."""
    total = sum(counts.values())
    if counts["read"] + counts["doubtful"] < STILL_READ * total:
        return f"too few are read: {dict(counts)}"
    if counts["doubtful"] + counts["refused"] < TOLD * total:
        return f"of too few the damage is told: {dict(counts)}"
    return ""


def test_a_reader_that_refuses_or_swallows_everything_is_lopsided():
    assert "too few are read" in lopsided(Counter(refused=100))
    assert "damage is told" in lopsided(Counter(read=100))
    assert not lopsided(Counter(read=10, doubtful=10, refused=80))


@pytest.mark.parametrize("seed", SEEDS, ids=lambda seed: seed.name)
def test_an_undamaged_seed_is_read(seed, tmp_path):
    program, _ = fuzzing.read(seed.files, seed.name, tmp_path)
    assert sum(motion.pose is not None for motion in program.motions) >= 2


@pytest.mark.parametrize(
    "name, idle", [("cell.mod", {"cell.pgf"}), ("lists.src", set())], ids=["RAPID", "KRL"]
)
def test_what_lies_beside_a_seed_is_read(name, idle, tmp_path):
    """Else its damage would be no test of the reader. The list of modules is all of the folder, here."""
    (seed,) = [one for one in SEEDS if one.name == name]
    whole, _ = fuzzing.read(seed.files, name, tmp_path)
    assert not whole.problems, whole.problems
    for other in seed.files.keys() - {name} - idle:
        less, _ = fuzzing.read({k: v for k, v in seed.files.items() if k != other}, name, tmp_path)
        assert less.problems, other
    assert len(seed.files) == 4


def test_every_language_has_a_seed():
    assert fuzzing.uncovered([fuzzing.OWN]) == []
    assert {Path(seed.name).suffix for seed in SEEDS} <= set(READERS)


def program(*motions, problems=()):
    return Program("KRL", "a.src", list(motions), list(problems))


def motion(x=1.0, line=1, **changes):
    pose = np.eye(4)
    pose[0, 3] = x
    return Motion("LIN", changes.pop("pose", pose), line, "a.src", **changes)


def test_another_pose_after_a_cut_is_a_finding():
    whole = program(motion(1.25, 1), motion(2.5, 2))
    fuzzing.compare(program(motion(1.25, 1)), whole, ("a.src", 2))
    cut = program(motion(1.25, 1), motion(2.0, 2))
    with pytest.raises(fuzzing.Finding, match="a.src:2: LIN is another"):
        fuzzing.compare(cut, whole, ("a.src", 2))
    cut.problems.append(Problem("a.src", 2, "test.cut", "it is cut"))
    fuzzing.compare(cut, whole, ("a.src", 2))
    whole.problems.append(Problem("a.src", 2, "test.cut", "it is cut"))  # no news: it does not tell
    with pytest.raises(fuzzing.Finding):
        fuzzing.compare(cut, whole, ("a.src", 2))


def test_a_frame_that_a_cut_list_no_longer_has_is_the_controllers():
    whole = program(motion(base="X 1", tool="T"))
    fuzzing.compare(program(motion(base="BASE_DATA[3]", tool="T")), whole, ("other.dat", 2))
    for wrong in (motion(base="X 2", tool="T"), motion(x=2.0, base="BASE_DATA[3]", tool="T")):
        with pytest.raises(fuzzing.Finding):
            fuzzing.compare(program(wrong), whole, ("other.dat", 2))
    with pytest.raises(fuzzing.Finding):  # its own text has the number
        fuzzing.compare(program(motion(base="BASE_DATA[3]", tool="T")), whole, ("a.src", 2))


@pytest.mark.parametrize(
    "wrong, kind",
    [
        (motion(x=np.nan), "pose"),
        (motion(pose=np.diag([1.0, 1.0, -1.0, 1.0])), "pose"),
        (motion(pose=2.0 * np.eye(4)), "pose"),
        (motion(speed_mm_s=0.0), "speed"),
        (motion(speed_mm_s=np.inf), "speed"),
        (motion(force_N=-1.0), "speed"),
    ],
)
def test_unsound_motions_are_findings(wrong, kind):
    arrays = {"frames": np.eye(4)[None]}
    fuzzing.check(program(motion()), arrays)
    with pytest.raises(fuzzing.Finding) as found:
        fuzzing.check(program(wrong), arrays)
    assert found.value.args[0] == kind


def spin(path):
    while True:
        pass


def refuse(path):
    raise ProgramError(f"{path.name}: no")


@pytest.mark.parametrize(
    "reader, kind",
    [
        (spin, "slow"),
        (lambda path: 1 / 0, "crash"),
        (lambda path: exec("import os; os._exit(3)"), "crash"),
        (lambda path: refuse(path.with_name("other")), "message"),
        (refuse, None),
    ],
)
def test_wrong_readers_are_found(monkeypatch, reader, kind):
    monkeypatch.setattr(fuzzing, "read_program", reader)
    monkeypatch.setattr(fuzzing, "LIMIT", 0.2)
    seed = fuzzing.Seed("small.src", {"small.src": b"DEF a()\nEND\n"})
    counts, _, findings = fuzzing.fuzz(seed, range(10_000, 10_002), [b"x"], most=1)
    assert [found[1] for found in findings] == ([kind] if kind else [])
    assert counts["refused"] == (0 if kind else 2)
