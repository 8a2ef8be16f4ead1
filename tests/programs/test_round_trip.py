"""Programs of several bases and tools: what is written has the robot where the source has it."""

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.writers.frames import frame_in_words
from beltgrinding.programs.writers.writer import write_program
from test_frames import (
    DATA,
    FRAMES,
    LONG,
    PLAN,
    POINTS,
    SHORT,
    SIDE,
    TOP,
    TURN,
    fanuc_program,
    inform_program,
    krl,
    krl_by_number,
    krl_program,
    matrix,
    rapid_program,
    read,
    values_file,
)


def flange_poses():
    """Where PLAN has the robot's flange, in the robot's own base."""
    return [
        matrix(FRAMES[base])
        @ frames.from_abc(POINTS[k], TURN)
        @ np.linalg.inv(matrix(FRAMES[tool]))
        for base, tool, k in PLAN
    ]


def sources(folder):
    """{name: Program} of PLAN: frames that the program sets, that its data have, and that a person gave."""
    assigned = krl_program(
        lambda base, tool: [f"$BASE={krl(FRAMES[base])}", f"$TOOL={krl(FRAMES[tool])}"]
    )
    (folder / "n.dat").write_text(DATA.replace("DEFDAT p", "DEFDAT n"))
    found = {
        "krl": read(folder, "p.src", assigned),
        "krl numbers": read(folder, "n.src", krl_program(krl_by_number).replace("p()", "n()")),
        "rapid": read(folder, "p.mod", rapid_program()),
    }
    for name, text, base, tool in (
        ("f.ls", fanuc_program(), "UFRAME", "UTOOL"),
        ("i.jbi", inform_program(), "USER", "TOOL"),
    ):
        values_file(
            folder / f"{name[0]}.values.json",
            {f"{base} 4": "TOP", f"{base} 5": "SIDE"},
            {f"{tool} 2": "SHORT", f"{tool} 3": "LONG"},
        )
        found[name] = read(folder, name, text)
    return found


def flanges_of(program):
    """Flange poses of what is read, by the frames that the reader knows or has in its words."""

    def numbers(known, words):
        return known[words] if words in known else frame_in_words(words)

    return [
        numbers(program.base_frames, m.base)
        @ m.pose
        @ np.linalg.inv(numbers(program.tool_frames, m.tool))
        for m in program.motions
    ]


@pytest.mark.parametrize("source", ["krl", "krl numbers", "rapid", "f.ls", "i.jbi"])
@pytest.mark.parametrize("suffix", [".src", ".mod", ".script", ".csv"])
def test_two_frames_come_back_as_they_were_written(tmp_path, suffix, source):
    program = sources(tmp_path)[source]
    (tmp_path / "out").mkdir()
    out = tmp_path / "out" / f"written{suffix}"
    notes = write_program(out, None, program, tools="as-known", bases="as-known")
    again = read_program(out)
    assert not again.problems
    if suffix == ".csv":  # a table has no frames: its poses are those of the reference
        found = [matrix(TOP) @ m.pose @ np.linalg.inv(matrix(SHORT)) for m in again.motions]
    else:
        found = flanges_of(again)
    assert len(found) == len(PLAN)
    for mine, wanted in zip(found, flange_poses()):
        assert np.linalg.norm(mine[:3, 3] - wanted[:3, 3]) < 1e-3
        assert np.linalg.norm(mine[:3, :3] - wanted[:3, :3]) / np.sqrt(2.0) < 1e-4  # rad
    told = [note for note in notes if note.code == "programs.writers.in_one_base"]
    assert len(told) == (1 if suffix == ".script" else 0)
    if told:
        assert told[0].arguments["count"] == sum(base == "SIDE" for base, _, _ in PLAN)
        assert "# 3 poses of the source are in another base" in out.read_text()
        assert "lies at X 120 Y -60 Z -120 A 90 B 0 C 30" in out.read_text()
        assert out.read_text().count("ref_frame = ") == 1


def test_urscript_is_written_in_the_base_most_is_ground_in(tmp_path):
    program = sources(tmp_path)["krl numbers"]
    top, side, turned = program.motions[0].base, program.motions[3].base, matrix(TOP)
    turned[:3, 3] += 7.0
    out = tmp_path / "w.script"
    # Nothing is set: the way from base to base is what the program knows of both.
    write_program(out, None, program, tools="as-known")
    assert "# The poses mean: " + top in out.read_text()
    path = [matrix(TOP) @ m.pose for m in read_program(out).motions]
    wanted = [f @ matrix(FRAMES[tool]) for f, (_, tool, _) in zip(flange_poses(), PLAN)]
    np.testing.assert_allclose(path, wanted, atol=1e-5)
    # What is given of a base goes over what the program knows of it.
    write_program(out, None, program, tools="as-known", bases={top: matrix(TOP), side: turned})
    poses = flanges_of(read_program(out))
    short = np.linalg.inv(matrix(SHORT))
    np.testing.assert_allclose(
        poses[3], turned @ frames.from_abc(POINTS[0], TURN) @ short, atol=1e-5
    )
    np.testing.assert_allclose(poses[0], flange_poses()[0], atol=1e-5)


def test_urscript_with_a_base_that_lies_nobody_knows_where_is_refused(tmp_path):
    program = read(tmp_path, "p.src", krl_program(krl_by_number))
    out = tmp_path / "w.script"
    for bases in (None, "as-known", matrix(TOP), {"BASE_DATA[1]": matrix(TOP)}):
        with pytest.raises(
            ProgramError, match=r"where the base 'BASE_DATA\[.\]' lies is not known"
        ):
            write_program(out, None, program, tools=matrix(SHORT), bases=bases)
        assert not out.exists()
    given = {"BASE_DATA[1]": matrix(TOP), "BASE_DATA[2]": matrix(SIDE)}
    write_program(out, None, program, tools=matrix(SHORT), bases=given)
    np.testing.assert_allclose(flanges_of(read_program(out))[3], flange_poses()[3], atol=1e-5)


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script"])
def test_one_base_for_a_program_of_several_is_that_of_most_poses(tmp_path, suffix):
    program = sources(tmp_path)["krl numbers"]
    (tmp_path / "out").mkdir()
    out = tmp_path / "out" / f"w{suffix}"
    notes = write_program(out, None, program, tools="as-known", bases=matrix(TOP))
    assert [note.code for note in notes] == ["programs.writers.in_one_base"]
    again = read_program(out)
    np.testing.assert_allclose(flanges_of(again), flange_poses(), atol=1e-5)
    assert len({m.base for m in again.motions}) == 1
    notes = write_program(out, None, program, tools=matrix(SHORT), bases=matrix(TOP))
    codes = [note.code for note in notes]
    assert codes == ["programs.writers.in_one_base", "programs.writers.one_for_all"]
    assert "TOOL_DATA" in str(notes[1]) or "X 10 " in str(notes[1])


@pytest.mark.parametrize("suffix, base", [(".src", "5"), (".mod", "wPart"), (".src", matrix(TOP))])
def test_one_base_for_several_that_are_not_known_is_told(tmp_path, suffix, base):
    program = read(tmp_path, "p.src", krl_program(krl_by_number))
    (tmp_path / "out").mkdir()
    out = tmp_path / "out" / f"w{suffix}"
    tools = {"TOOL_DATA[3]": matrix(SHORT), "TOOL_DATA[4]": matrix(LONG)}
    notes = write_program(out, None, program, tools=tools, bases=base)
    (told,) = [note for note in notes if note.code == "programs.writers.one_for_all"]
    assert "'BASE_DATA[1]', 'BASE_DATA[2]'" in str(told)
    for mine, (_, _, k) in zip(read_program(out).motions, PLAN):
        np.testing.assert_allclose(mine.pose, frames.from_abc(POINTS[k], TURN), atol=1e-5)
