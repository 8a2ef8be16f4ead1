"""What ``beltgrind program`` says of a program: what is lost first, the count, and what it asks for."""

import json
import os
from pathlib import Path

import pytest

from beltgrinding.cli import main
from beltgrinding.cli.messages import HANDFUL, Messages
from beltgrinding.engine import InputError
from beltgrinding.job.poses import program_arrays
from beltgrinding.programs import problems
from beltgrinding.programs.program import Problem
from beltgrinding.programs.registry import read_program, told_problems

ROOT = Path(__file__).resolve().parents[2]

FAULTS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "faults"
needs_shared = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {FAULTS}")
LOST = "UNITS/MM\nFEDRAT/9,MMPR\nGOTO/0,0,0\nGOHOME\nGOTO/1,0,0\nFINI\n"
TP = "/PROG P\n/MN\n{}/POS\n/END\n"


@pytest.fixture
def program(tmp_path, capsys):
    """Runs the command on a text; returns (status, standard output, standard error)."""

    def run(name, text, *options):
        (tmp_path / name).write_text(text)
        status = main(["--language", "en", "program", str(tmp_path / name), *options])
        out = capsys.readouterr()
        return status, out.out, out.err

    return run


def test_the_count_comes_last_and_strict_minds_what_is_lost(program):
    status, out, err = program("p.apt", LOST)
    found = json.loads(out)
    assert status == 0 and (found["read"], found["in_program"]) == (2, 3)
    assert err.splitlines()[-1] == "note: read 2 of 3 motions"
    assert program("p.apt", LOST, "--strict")[0] == 1
    assert program("p.apt", LOST.replace("GOHOME\n", ""), "--strict")[0] == 0


def test_strict_converts_nothing_where_a_motion_is_lost(program, tmp_path):
    new = tmp_path / "new.csv"
    (tmp_path / "p.apt").write_text(LOST)
    assert main(["program", "convert", str(tmp_path / "p.apt"), "-o", str(new), "--strict"]) == 1
    assert not new.exists()
    assert main(["program", "convert", str(tmp_path / "p.apt"), "-o", str(new)]) == 0
    assert new.exists()


def test_what_loses_motions_comes_first(program):
    found = json.loads(program("p.apt", LOST)[1])
    assert ["GOHOME" in text for text in found["first_problems"]] == [True, False]


@pytest.mark.parametrize(
    "name, text",
    [
        ("d.mod", "MODULE d\n  CONST num n:=1;\nENDMODULE\n"),
        ("d.ls", TP.format("")),
        ("d.src", "DEF d()\nEND\n"),
        ("d.nc", "G21\nM30\n"),
        ("d.script", 'def d():\n  textmsg("a")\nend\n'),
        ("d.jbi", "/JOB\n//NAME D\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\nNOP\nEND\n"),
        ("d.apt", "UNITS/MM\nGOHOME\nFINI\n"),
    ],
)
def test_no_motion_is_an_error_that_says_why(program, name, text):
    status, out, err = program(name, text)
    assert status == 2 and json.loads(out)["read"] == 0
    assert err.splitlines()[-1].startswith(f"beltgrind: {name}: no motion is read: ")


def test_data_is_no_program(program):
    status, _, err = program("d.dat", "DEFDAT d\nENDDAT\n")
    assert status == 2 and err.startswith("beltgrind: ") and "give d.src instead" in err


def test_points_of_a_dtx_alone_are_told_to_be_data(tmp_path):
    data = (
        '<Database xmlns="http://www.staubli.com/robotics/VAL3/Data/2"><Datas>'
        '<Data name="p" access="public" xsi:type="array" type="pointRx" size="1" '
        'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">'
        '<Value key="0" x="1" y="2" z="3" fatherId="world[0]"/></Data></Datas></Database>'
    )
    (tmp_path / "d.dtx").write_text(data)
    first = told_problems(read_program(tmp_path / "d.dtx"), None)[0]
    assert "holds data, no program" in first and ".pgx" in first


def test_all_values_are_asked_for_in_one_round(program, tmp_path):
    text = (
        "1: IF R[7]>3,JMP LBL[2] ;\n2: L PR[15] 9mm/sec FINE ;\n3: LBL[2] ;\n"
        "4: L PR[16] R[5]mm/sec FINE ;\n"
    )
    status, out, err = program("p.ls", TP.format(text), "--write-values")
    assert status == 0 and json.loads(out)["to_be_given"] == 4 and "depends on" in err
    data = json.loads((tmp_path / "p.values.json").read_text())
    assert set(data["variables"]) == {"R[7]", "R[5]", "PR[15]", "PR[16]"}
    data["variables"]["R[7]"] = 1
    (tmp_path / "p.values.json").write_text(json.dumps(data))
    status, out, err = program("p.ls", TP.format(text), "--write-values")
    assert json.loads(out)["to_be_given"] == 3 and not err  # what is given decides
    kept = json.loads((tmp_path / "p.values.json").read_text())
    assert kept["variables"]["R[7]"] == 1


def test_units_are_given_on_the_command_line(program):
    text = "GOTO/1,2,3\nGOTO/2,2,3\nFINI\n"
    status, _, err = program("p.apt", text)
    assert status == 2 and "--units mm or --units inch" in err
    status, out, err = program("p.apt", text, "--units", "inch", "--strict")
    assert status == 0 and json.loads(out)["extents_mm"]["x"] == pytest.approx([25.4, 50.8])


def test_chains_of_reasons_name_the_first_cause(tmp_path):
    text = (
        "MODULE c\n VAR robtarget p1;\n VAR robtarget p2;\n VAR robtarget p3;\n PROC main()\n"
        "  p1 := GetIt(4);\n  p2 := Offs(p1,1,0,0);\n  p3 := Offs(p2,1,0,0);\n  p3 := Offs(p3,1,0,0);\n"
        "  MoveL p3, v100, fine, tool0;\n ENDPROC\nENDMODULE\n"
    )
    (tmp_path / "c.mod").write_text(text)
    (problem,) = read_program(tmp_path / "c.mod").problems
    assert "GetIt" in problem and problem.count("is not known") <= 2 and "p2" not in problem


BLOCKS = {
    "b.src": "DEF b()\nLIN {0}\nIF $IN[1] THEN\nLIN {0}\nIF $IN[2] THEN\nLIN {0}\nENDIF\nENDIF\nLIN {0}\nEND\n",
    "b.script": "def b():\n  movel({1})\n  if get_digital_in(1):\n    movel({1})\n    movel({1})\n  end\n"
    "  movel({1})\nend\n",
    "b.mod": "MODULE b\nPROC main()\nMoveL {2}\nIF diX = 1 THEN\nMoveL {2}\nIF diX = 2 MoveL {2}\nENDIF\nMoveL {2}\n"
    "ENDPROC\nENDMODULE\n",
    "b.ls": "/PROG B\n/MN\n1: L {3} ;\n2: IF DI[1]=ON,JMP LBL[1] ;\n3: L {3} ;\n4: L {3} ;\n5: LBL[1] ;\n6: L {3} ;\n"
    "/POS\n{4}/END\n",
}
POSES = {
    "{0}": "{X 1,Y 2,Z 3,A 0,B 0,C 0}",
    "{1}": "p[0.5,0,0.3,0,0,0], a=1, v=0.1",
    "{2}": "[[1,2,3],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;",
    "{3}": "P[1] 9mm/sec FINE",
    "{4}": "P[1]{\n GP1:\n UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = 1 mm, Y = 2 mm, Z = 3 mm,\n"
    " W = 0 deg, P = 0 deg, R = 0 deg\n};\n",
}


@pytest.mark.parametrize("name", BLOCKS)
def test_motions_in_a_block_that_is_left_out_are_counted(tmp_path, name):
    text = BLOCKS[name]
    for key, pose in POSES.items():
        text = text.replace(key, pose)
    (tmp_path / name).write_text(text)
    assert read_program(tmp_path / name).counted() == (2, 4)


@needs_shared
def test_a_comment_of_inform_is_no_problem():
    program = read_program(FAULTS / "commented.jbi")
    assert [m.kind for m in program.motions] == ["LIN", "LIN"] and not program.problems


HARMLESS = {
    "p.apt": "PARTNO/P\nUNITS/MM\nCOOLNT/ON\nCYCLE/OFF\nTPRINT/T1\nTRNTYP/1\nPPRINT/GOTO\nINSERT/M8\n"
    "SPINDL/100,CLW\nLOADTL/1\nOPSTOP\nGOTO/1,2,3\nDISPLY/ON\nFINI\n",
    "p.mod": 'MODULE p\n PROC main()\n  TPErase;\n  TPWrite "a";\n  SetDO d,1;\n  PulseDO d;\n  WaitTime 1;\n'
    "  WaitDI d,1;\n  ClkStart c;\n  MoveL [[1,2,3],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,"
    "fine,tool0;\n ENDPROC\nENDMODULE\n",
    "p.src": 'DEF p()\nPULSE($OUT[2],TRUE,0.5)\n$OUT[1]=TRUE\nWAIT SEC 0.5\nCWRITE(1,2)\nMsgNotify("a")\n'
    "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\n",
    "p.script": 'def p():\n  textmsg("a")\n  popup("a")\n  set_digital_out(1, True)\n  sleep(1)\n'
    "  movel(p[0.001,0.002,0.003,0,0,0], a=1, v=0.1)\nend\n",
    "p.nc": "G21 G90\nT1 M6\nS3000 M3\nM8\nG1 X1 Y2 Z3 F600\nM9\nM5\nM30\n",
    "p.jbi": "/JOB\n//NAME P\n//POS\n///NPOS 1,0,0,0,0,0\n///TOOL 0\n///POSTYPE ROBOT\n///RECTAN\n"
    "///RCONF 0,0,0,0,0,0,0,0\nC00000=1,2,3,0,0,0\n//INST\nNOP\nCOMM MOVL C00000\nDOUT OT#(1) ON\nHAND 1 OFF\n"
    'TIMER T=1.00\nMSG "a"\nMOVL C00000 V=50.0\nEND\n',
}


@pytest.mark.parametrize("name", HARMLESS)
def test_statements_that_move_nothing_are_no_problem(tmp_path, name):
    (tmp_path / name).write_text(HARMLESS[name])
    program = read_program(tmp_path / name)
    assert not program.problems and program.counted() == (1, 1)
    assert program.motions[0].pose[:3, 3] == pytest.approx([1, 2, 3])


def test_every_code_that_is_graded_is_there():
    told = json.loads((ROOT / "Resources" / "messages" / "de.json").read_text("utf-8"))
    assert problems.OF_UNSURE | problems.OF_NOTE <= set(told)


def test_a_handful_of_lines_about_a_program_is_printed(capsys):
    told = [problems_of(k) for k in range(20)]
    messages = Messages("en")
    messages.print_warnings([*told, "of the run"])
    lines = capsys.readouterr().err.splitlines()
    assert len([line for line in lines if "p.x" in line]) == HANDFUL
    assert "warning: of the run" in lines
    assert f"note: {20 - HANDFUL} more lines about the program; --all prints all" in lines
    messages.everything = True
    messages.print_warnings(told)
    assert len(capsys.readouterr().err.splitlines()) == 20


def problems_of(number):
    """A Problem of a kind of its own."""
    return Problem("p.x", number + 1, f"programs.some{number}", "something is lost")


def test_an_error_of_a_run_says_a_problem_once(tmp_path):
    (tmp_path / "p.apt").write_text("GOTO/1,2,3\nGOTO/2,2,3\nFINI\n")
    warnings = []
    with pytest.raises(InputError, match="neither mm nor inch"):
        program_arrays({"file": tmp_path / "p.apt"}, "programs[0]", warnings)
    assert not warnings
    given = {"file": tmp_path / "p.apt", "values": {"units": "inch"}}
    frames = program_arrays(given, "programs[0]", warnings)["frames"]
    assert frames[1, 0, 3] == pytest.approx(50.8)


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script", ".csv"])
def test_an_own_program_is_written_anew_and_a_foreign_one_refused(program, tmp_path, suffix):
    new = tmp_path / "new" / f"again{suffix}"  # the folder is made
    (tmp_path / "path.csv").write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,1,0,0,0\n9,0,0,1,0,0,0\n")
    convert = ["program", "convert", str(tmp_path / "path.csv"), "-o", str(new)]
    assert main(convert) == 0
    first = new.read_bytes()
    assert main(convert) == 0 and new.read_bytes() == first
    new.write_bytes(first.replace(b"written by BeltGrinding", b"taught by hand"))
    foreign = new.read_bytes()
    assert main(convert) == 2 and new.read_bytes() == foreign
    assert main([*convert, "--force"]) == 0 and new.read_bytes() == first


def test_changes_are_written_into_a_new_folder(tmp_path):
    (tmp_path / "p.csv").write_text("x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s\n0,0,0,1,0,0,0,5\n")
    (tmp_path / "changes.csv").write_text("index,speed_mm_s\n0,7\n")
    new = tmp_path / "deep" / "new" / "p.csv"
    begin = ["program", "write", str(tmp_path / "p.csv"), str(tmp_path / "changes.csv")]
    assert main([*begin, "-o", str(new)]) == 0 and ",7\n" in new.read_text()
    (tmp_path / "file").write_text("")
    assert main([*begin, "-o", str(tmp_path / "file" / "p.csv")]) == 2
