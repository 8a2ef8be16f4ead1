"""What a program does not tell is a fact: a code, its arguments and its place, in English and German."""

import pickle

import pytest

from beltgrinding.base.messages import sentence
from beltgrinding.engine import Fact, InputError
from beltgrinding.job import poses
from beltgrinding.programs.program import (
    Problem,
    ProgramError,
    Unknown,
    shortened,
)
from beltgrinding.programs.registry import read_program


def read(folder, name, text):
    (folder / name).write_text(text)
    return read_program(folder / name)


def test_an_error_names_its_culprit_in_both_languages(tmp_path):
    with pytest.raises(InputError, match="b.mod:3: the statement has no end") as caught:
        read(tmp_path, "b.mod", "MODULE b\nPROC main()\nIF\n")
    error = caught.value
    assert isinstance(error, ProgramError) and error.code == "programs.rapid.endless_statement"
    assert error.culprit == {"file": "b.mod", "line": 3}
    german = "b.mod:3: die Anweisung endet nicht; ist die Datei abgeschnitten?"
    assert sentence(error, "de") == german


def test_a_problem_is_a_fact_with_a_place(tmp_path):
    (problem,) = read(tmp_path, "a.src", "DEF a()\nLIN XP1\nEND\n").problems
    english = "LIN is left out: XP1 has no value that this file or its .dat gives"
    assert str(problem) == f"a.src:2: {english}" and problem.message == english
    assert (problem.file, problem.line, problem.code) == ("a.src", 2, "programs.left_out")
    assert problem.arguments["what"] == "LIN"
    assert problem.arguments["reason"].code == "programs.krl.no_value"
    german = "LIN bleibt weg: XP1 hat keinen Wert, den diese Datei oder ihre .dat angibt"
    assert sentence(problem, "de") == f"a.src:2: {german}"
    again = pickle.loads(pickle.dumps(problem))
    assert again == problem and (again.line, again.code) == (2, "programs.left_out")


def test_words_of_a_program_are_not_written_as_numbers(tmp_path):
    """G43.7 is a word: no decimal comma."""
    program = read(tmp_path, "a.nc", "G21 G90\nG43.7\nG1 X1 Y2 Z3\nM30\n")
    german = "a.nc:2: der Satz bleibt weg: G43.7 ist hier nicht bekannt"
    assert sentence(program.problems[0], "de") == german


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ProgramError, match="absent.src: cannot be read") as caught:
        read_program(tmp_path / "absent.src")
    assert caught.value.code == "files.cannot_be_read"
    assert caught.value.culprit == {"file": str(tmp_path / "absent.src")}


def test_a_thousand_motions_for_one_reason_are_one_problem(tmp_path):
    moves = "".join(f"G1 X{k}\n" for k in range(1000))
    program = read(tmp_path, "a.nc", f"G21 G90\nG1 X0 Y0 Z0 F100\nG0 A30\n{moves}M30\n")
    (problem,) = program.problems
    assert problem.arguments["reason"].code == "programs.gcode.kinematics"


def test_a_jobs_warnings_stay_facts(tmp_path):
    text = "DEF a()\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN XP1\nLIN {X 9,Y 2,Z 3,A 0,B 0,C 0}\nEND\n"
    (tmp_path / "a.src").write_text(text)
    warnings = []
    poses.program_arrays({"file": tmp_path / "a.src"}, "programs[0]", warnings)
    left_out, speed = warnings  # what loses motions comes first
    assert speed.code == "programs.speeds_assumed" and speed.line == 2
    assert isinstance(left_out, Problem) and left_out.startswith("a.src:3: LIN is left out")
    assert sentence(left_out, "de").startswith("a.src:3: LIN bleibt weg")


def test_what_is_wrong_with_a_quaternion_keeps_its_code(tmp_path):
    text = "x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,2,3,1,0,0,0\n1,2,3,1,0,0,1\n"
    with pytest.raises(ProgramError, match="a.csv:3: the quaternion has length 1.414") as caught:
        read(tmp_path, "a.csv", text)
    assert caught.value.code.startswith("frames.") and caught.value.culprit["line"] == 3
    assert sentence(caught.value, "de").startswith("a.csv:3: das Quaternion hat die Länge 1,414")


def test_an_error_as_a_reason_keeps_its_place():
    error = ProgramError.at("a.script", 3, "programs.too_long", "the program is too long")
    fact = error.fact
    assert fact == str(error) == "a.script:3: the program is too long"
    assert (
        sentence(fact, "de")
        == "a.script:3: das Programm ist zu lang oder endet nicht; es aufteilen oder seine Schleifen kürzen"
    )


def test_reasons_that_hang_on_each_other_stay_short():
    fact = Fact("programs.krl.exit", "EXIT is in no loop; what follows it is left out")
    for k in range(1000):
        fact = shortened(
            Fact(
                "programs.not_known_since",
                "{name} is not known ({reason})",
                name=f"x{k}",
                reason=fact,
            ),
            200,
        )
    first = "x0 is not known (EXIT is in no loop; what follows it is left out)"
    assert fact == f"x999 is not known ({first})"  # the first cause, not those between
    assert sentence(fact, "de").startswith("x999 ist nicht bekannt (")
    assert len(sentence(fact, "de")) < 400


def test_an_unknown_makes_its_fact_once():
    unknown = Unknown("programs.left_out", "{what} is left out: {reason}", what="LIN", reason="x")
    assert str(unknown) == "LIN is left out: x"
    assert unknown.fact is unknown.fact
    assert Unknown(unknown.fact).fact is unknown.fact
