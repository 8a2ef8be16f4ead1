"""Warnings that say the same of many places become one; nothing is lost."""

import json
from pathlib import Path

import pytest

from beltgrinding import cli
from beltgrinding.base.grouping import grouped
from beltgrinding.base.messages import fact_data, sentence, warnings
from beltgrinding.engine import Fact
from beltgrinding.job.poses import program_arrays
from beltgrinding.programs.program import Problem
from beltgrinding.programs.registry import read_program, told_problems

ROOT = Path(__file__).resolve().parents[2]


def problem(line, code="programs.left_out", file="p.src", reason="programs.x"):
    told = Fact(reason, "it is so {n}", n=line)
    return Problem(file, line, code, "{what} is left out: {reason}", what="LIN", reason=told)


def test_many_of_a_kind_are_one_with_the_count_and_the_last_line():
    one = problem(900, "programs.ignored")
    told = [problem(3), one, *(problem(k) for k in range(10, 990))]
    assert [str(fact) for fact in grouped(told)] == [
        "p.src:3: LIN is left out: it is so 3 (and 980 more like it, up to line 989)",
        str(one),
    ]
    as_json = json.loads(json.dumps([fact_data(fact) for fact in told]))
    for language in ("en", "de"):
        plain = [sentence(fact, language) for fact in grouped(told)]
        assert plain == [sentence(fact, language) for fact in grouped(as_json)]
        assert warnings({"warning_facts": as_json}, language) == plain
    assert "980 weitere" in sentence(grouped(told)[0], "de")


@pytest.mark.parametrize(
    "other",
    [
        {"file": "q.src"},
        {"code": "programs.ignored"},
        {"reason": "programs.y"},
    ],
)
def test_other_files_kinds_and_reasons_stay_apart(other):
    told = [problem(1), problem(2), problem(3, **other)]
    assert grouped(told) == told


def test_two_are_no_many_and_sentences_without_a_code_stay():
    told = [problem(1), problem(2), "a", "a", "a", "a"]
    assert grouped(told) == told and grouped([]) == []
    facts = [Fact("base.x", "seen {n}", n=n) for n in range(4)]
    assert [str(fact) for fact in grouped(facts)] == ["seen 0 (and 3 more like it)"]


def fanuc(tmp_path, motions=40, speed="12deg/sec"):
    moves = "".join(f"{k:4}:L P[{k}] {speed} CNT50    ;\n" for k in range(1, motions + 1))
    rows = "".join(
        f"P[{k}]{{\n   GP1:\n\tUF : 0, UT : 1,\n\tX = {k}.0 mm,\tY = 0.0 mm,\tZ = 0.0 mm,\n"
        "\tW = 0.0 deg,\tP = 0.0 deg,\tR = 0.0 deg\n};\n"
        for k in range(1, motions + 1)
    )
    path = tmp_path / "p.ls"
    path.write_text(f"/PROG  P\n/ATTR\n/MN\n{moves}/POS\n{rows}/END\n")
    return path


def test_speeds_that_are_not_known_are_one_warning_with_the_speed_that_is_taken(tmp_path):
    path, told = fanuc(tmp_path), []
    program = read_program(path)
    assert len(program.problems) == 40
    arrays = program_arrays({"file": str(path)}, "p", told)
    (note,) = told
    assert note.code == "programs.speeds_assumed_since" and note.line == 4
    assert note.arguments["count"] == 40 and note.arguments["speed"] == 100.0
    assert "12deg/sec" in note and (arrays["feeds"] == 100.0).all()
    told = []
    program_arrays({"file": str(path), "feed_mm_s": 20.0}, "p", told)
    assert told == [], "the job gives the feed"
    assert told_problems(read_program(fanuc(tmp_path, speed="12mm/sec")), 100.0) == []


def test_a_program_without_a_word_of_speed_says_what_is_taken(tmp_path):
    (tmp_path / "p.nc").write_text("G21 G0 X0 Y0 Z0\nG1 X9\nG1 X20\nM30\n")
    (note,) = told_problems(read_program(tmp_path / "p.nc"), 100.0)
    assert note.code == "programs.speeds_assumed" and (note.line, note.arguments["count"]) == (2, 2)
    (tmp_path / "p.csv").write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,1,0,0,0\n9,0,0,1,0,0,0\n")
    assert told_problems(read_program(tmp_path / "p.csv"), 100.0) == []


def test_the_command_line_groups_and_prints_all_when_asked(tmp_path, capsys):
    path = fanuc(tmp_path)
    assert cli.main(["program", str(path)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["problems"] == 40 and len(found["first_problems"]) == 1
    assert "39 more like it" in found["first_problems"][0]
    for words in (["program", str(path), "--all"], ["--all", "program", str(path)]):
        assert cli.main(words) == 0
        assert len(json.loads(capsys.readouterr().out)["first_problems"]) == 40


def test_warnings_of_a_kind_are_a_line(capsys):
    from beltgrinding.cli.messages import Messages

    told = [problem(k) for k in range(1, 982)]
    messages = Messages("en")
    messages.print_warnings(told)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2 and "980 more" in lines[0] and "--all" in lines[1]
    messages.everything = True
    messages.print_warnings(told)
    assert len(capsys.readouterr().err.splitlines()) == 981


def test_motions_in_a_frame_that_is_not_known_are_told_by_the_job(tmp_path):
    poses = "LIN {{X {0}, Y 0, Z 0, A 0, B 0, C 180}}\n"
    (tmp_path / "p.src").write_text(
        "DEF p()\n$VEL.CP = 0.1\n$BASE = BASE_DATA[1]\n"
        + "".join(poses.format(x) for x in (0, 10, 20))
        + "$BASE = BASE_DATA[2]\n"
        + poses.format(5)
        + "END\n"
    )
    told = []
    program_arrays({"file": str(tmp_path / "p.src")}, "p", told)
    assert "programs.other_frame" in {problem.code for problem in told}
