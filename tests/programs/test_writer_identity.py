"""A written program, read and written again, is the same file; a program, written and read again, the same motions.

What a file does not hold as a statement is no part of it: comments, the force where the language has none, and
what its language has not (splines beside KRL, arcs in CSV).
"""

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import Motion, Program
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.writers.writer import write_program

COMMENT = {".src": (";", "&"), ".mod": ("!",), ".script": ("#",), ".csv": ("#",)}
ROUNDS = 3  # random programs each


def some_frame(rng):
    if rng.random() < 0.2:  # at gimbal lock, half turns, none
        angles = [(0, 90, 0), (30, -90, 20), (180, 0, 0), (0, 180, 0), (0, 0, 180), (0, 0, 0)]
        return frames.from_abc(rng.uniform(-900, 900, 3), angles[rng.integers(6)])
    q = rng.normal(size=4)
    return frames.from_quaternion(rng.uniform(-900, 900, 3), q / np.linalg.norm(q))


def some_program(seed, count, held=False, bases=2, tools=2):
    """A Program with motions of all kinds, speeds, zones, forces, bases and tools; ``held``: the part is."""
    rng = np.random.default_rng(seed)
    at = " held by the robot" if held else ""
    program = Program("of a test", "somewhere")
    for k in range(bases):
        frame = some_frame(rng)
        program.base_frames[f"part {k} {frames.in_words(frame)}{at}"] = frame
        program.held.update({f"part {k} {frames.in_words(frame)}{at}"} if held else ())
    for k in range(tools):
        frame = some_frame(rng)
        fixed = " fixed in the room" if held else ""
        program.tool_frames[f"belt {k} {frames.in_words(frame)}{fixed}"] = frame
    place, motions = rng.uniform(-500, 500, 3), program.motions
    while len(motions) < count:
        kind = rng.choice(["PTP", "LIN", "LIN", "LIN", "CIRC", "SPL"]) if motions else "PTP"
        speed = None if kind == "PTP" else float(rng.choice([50.0, 33.3, 0.125, 1234.56789]))
        zone = [None, 0.0, 0.3, 1.0, 7.5, 10.0, 0.1234][rng.integers(7)]
        force = [None, 12.5][rng.integers(2)]
        base, tool = (
            list(known)[rng.integers(len(known))]
            for known in (program.base_frames, program.tool_frames)
        )
        for aux in (True, False) if kind == "CIRC" else (False,):
            place = place + rng.uniform(-40, 40, 3)
            pose = some_frame(rng)
            pose[:3, 3] = place
            motions.append(Motion(kind, pose, len(motions) + 1, "somewhere", speed, force))
            motions[-1].zone_mm, motions[-1].aux = None if kind == "SPL" else zone, aux
            motions[-1].base, motions[-1].tool = base, tool
    return program


def again(folder, suffix, program, **options):
    """(the text of a program as it is written, what is read of it)."""
    folder.mkdir(exist_ok=True)
    path = folder / f"p{suffix}"
    write_program(path, None, program, **options)
    return path.read_text(encoding="ascii"), read_program(path)


def statements(suffix, text):
    """The lines of a file that are no comment."""
    return [row for row in text.splitlines() if not row.lstrip().startswith(COMMENT[suffix])]


def assert_same(first, second):
    assert len(first) == len(second)
    for a, b in zip(first, second):
        assert (a.kind, a.aux, a.tool, a.base) == (b.kind, b.aux, b.tool, b.base)
        assert (a.speed_mm_s, a.zone_mm) == (b.speed_mm_s, b.zone_mm)
        assert a.force_N == b.force_N
        assert np.abs(a.pose - b.pose).max() < 1e-8


CASES = {
    "frames": dict(tools="as-known", bases="as-known", bases_of=2, tools_of=2),
    "one frame": dict(tools="as-known", bases="as-known", bases_of=1, tools_of=1),
    "left to the controller": dict(tools=None, bases=None, bases_of=1, tools_of=1),
    "no blend": dict(tools="as-known", bases="as-known", bases_of=1, tools_of=2, blend_mm=0.0),
    "held": dict(tools="as-known", bases="as-known", bases_of=2, tools_of=2, held=True),
}
ALL = [(suffix, case) for suffix in COMMENT for case in CASES if case != "held" or suffix == ".mod"]


@pytest.mark.parametrize("suffix, case", ALL)
def test_a_written_program_is_itself(tmp_path, suffix, case):
    options = dict(CASES[case])
    shape = dict(bases=options.pop("bases_of"), tools=options.pop("tools_of"))
    shape["held"] = options.pop("held", False)
    for seed in range(ROUNDS):
        source = some_program(seed, 40, **shape)
        options["comment"] = f"blade {seed}, über alles\nsecond line"
        one, read_one = again(tmp_path / "a", suffix, source, **options)
        if suffix == ".csv":  # has no frames
            options.update(tools=None, bases=None)
        two, read_two = again(tmp_path / "b", suffix, read_one, **options)
        three, read_three = again(tmp_path / "c", suffix, read_two, **options)
        four, _ = again(tmp_path / "d", suffix, read_three, **options)
        assert statements(suffix, one) == statements(suffix, two)
        assert three == four  # whose heads say the same of what was read
        assert_same(read_one.motions, read_two.motions)
        assert_same(read_two.motions, read_three.motions)


@pytest.mark.parametrize("suffix", COMMENT)
def test_a_program_comes_back_with_its_speeds_and_zones(tmp_path, suffix):
    for seed in range(ROUNDS):
        source = some_program(seed, 40, bases=1, tools=1)
        kinds = ("PTP", "LIN") if suffix == ".csv" else ("PTP", "LIN", "CIRC")
        source.motions = [m for m in source.motions if m.kind in kinds]
        _, found = again(tmp_path, suffix, source, tools="as-known", bases="as-known")
        assert len(found.motions) == len(source.motions)
        for a, b in list(zip(source.motions, found.motions))[:-1]:
            if a.aux or b.line == found.motions[-1].line:  # where it stops
                continue
            assert (a.kind, a.aux) == (b.kind, b.aux)
            if a.kind != "PTP":
                assert b.speed_mm_s == pytest.approx(a.speed_mm_s, abs=1e-6)
            zone = 1.0 if a.zone_mm is None else a.zone_mm  # write_program's own
            if suffix == ".csv":
                assert (a.zone_mm, a.force_N) == (b.zone_mm, b.force_N)
            elif a.kind == "PTP" and (suffix == ".src" or a.zone_mm is None):
                assert suffix == ".mod" or b.zone_mm == 0.0
            elif suffix == ".script":  # never to the middle of the way
                assert b.zone_mm <= zone + 1e-9
            else:
                assert b.zone_mm == pytest.approx(round(zone, 3))


def test_many_poses_are_themselves(tmp_path):
    source = some_program(99, 1000)
    for suffix in COMMENT:
        options = dict(tools="as-known", bases="as-known")
        one, read_one = again(tmp_path / "a", suffix, source, **options)
        if suffix == ".csv":  # has no frames
            options.update(tools=None, bases=None)
        two, _ = again(tmp_path / "b", suffix, read_one, **options)
        assert statements(suffix, one) == statements(suffix, two)
