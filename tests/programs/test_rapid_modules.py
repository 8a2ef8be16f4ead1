"""RAPID functions of the program, and other modules of its folder."""

from pathlib import Path

import pytest

from beltgrinding.programs.patch.patch import patch
from beltgrinding.programs.registry import read_program

ROOT = Path(__file__).resolve().parents[2]

REST = "[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


def target(name, x, local=""):
    return f"{local} CONST robtarget {name}:=[[{x},0,0],{REST};\n"


def program(tmp_path, body, rest="", **others):
    (tmp_path / "p.mod").write_text(
        f"MODULE p\n{target('p1', 1)}{rest}PROC main()\n{body}ENDPROC\nENDMODULE\n"
    )
    for name, text in others.items():
        (tmp_path / f"{name}.mod").write_text(f"MODULE {name}\n{text}ENDMODULE\n")
    return read_program(tmp_path / "p.mod")


def xs(found):
    return [round(m.pose[0, 3], 6) for m in found.motions if m.pose is not None]


MOVE = "MoveL {}, v100, fine, tool0;\n"


def test_functions_of_the_program_are_evaluated(tmp_path):
    functions = (
        "FUNC robtarget shifted(robtarget p, num k)\nVAR num d;\nd:=0;\n"
        "FOR i FROM 1 TO 3 DO\nd:=d+k;\nENDFOR\n"
        "IF d>20 THEN\nRETURN Offs(p,20,0,0);\nENDIF\nRETURN Offs(p,d,0,0);\nENDFUNC\n"
        "FUNC num twice(num n)\nRETURN 2*n;\nENDFUNC\n"
    )
    found = program(
        tmp_path,
        MOVE.format("shifted(p1,2)") + MOVE.format("shifted(p1,twice(50))"),
        functions,
    )
    assert xs(found) == [7, 21] and not found.problems


@pytest.mark.parametrize(
    "body",
    [
        "IF DInput(di1)=1 THEN\nRETURN p1;\nENDIF\nRETURN Offs(p1,5,0,0);\n",
        "WHILE di1=1 DO\nRETURN p1;\nENDWHILE\nRETURN p1;\n",
        "MoveL p1, v100, fine, tool0;\nRETURN p1;\n",
        "unknown_thing;\nRETURN p1;\n",
        "RETURN CRobT();\n",
        "a: GOTO a;\nRETURN p1;\n",
        "RETURN f(p1);\n",
        'TPWrite "none";\n',
    ],
)
def test_what_is_decided_at_run_time_gives_no_value(tmp_path, body):
    functions = f"FUNC robtarget f(robtarget q)\n{body}ENDFUNC\n"
    found = program(tmp_path, MOVE.format("f(p1)") + MOVE.format("p1"), functions)
    assert xs(found) == [1] and len(found.problems) == 1, found.problems


def test_data_and_procedures_of_other_modules(tmp_path):
    other = target("p9", 9) + f"PROC path_9()\n{MOVE.format('p9')}ENDPROC\n"
    found = program(tmp_path, MOVE.format("p9") + "path_9;\n" + MOVE.format("p1"), paths=other)
    assert xs(found) == [9, 9, 1] and not found.problems
    lines = [(m.file, m.line) for m in found.motions]
    assert lines == [("p.mod", 4), ("p.mod", 5), ("p.mod", 6)]


def test_what_is_local_is_its_module_s(tmp_path):
    other = (
        target("p1", 50, "LOCAL") + target("p2", 60, "LOCAL") + "VAR robtarget p3;\n"
        f"PROC go()\n{MOVE.format('p1')}inner;\nENDPROC\n"
        f"LOCAL PROC inner()\n{MOVE.format('p2')}ENDPROC\n"
        f"FUNC robtarget where()\nRETURN p2;\nENDFUNC\n"
    )
    body = "go;\n" + MOVE.format("p1") + MOVE.format("where()") + "inner;\n" + MOVE.format("p2")
    found = program(tmp_path, body, paths=other)
    assert xs(found) == [50, 60, 1, 60]
    assert [p.code for p in found.problems] == ["programs.not_in_file", "programs.left_out"] or len(
        found.problems
    ) == 2


def test_names_of_two_modules_and_mains_of_others_are_not_taken(tmp_path):
    found = program(
        tmp_path,
        MOVE.format("p9") + MOVE.format("p1"),
        a=target("p9", 9),
        b=target("p9", 10) + f"PROC main()\n{MOVE.format('p9')}ENDPROC\n",
    )
    assert xs(found) == [1] and len(found.problems) == 1


def test_the_module_s_own_comes_first_and_a_pgf_says_which_belong(tmp_path):
    found = program(
        tmp_path, MOVE.format("p1") + MOVE.format("p9"), a=target("p1", 7) + target("p9", 9)
    )
    assert xs(found) == [1, 9]
    (tmp_path / "p.pgf").write_text("<Program><Module>p.mod</Module></Program>")
    assert xs(read_program(tmp_path / "p.mod")) == [1]


def test_damaged_modules_beside_stop_nothing(tmp_path):
    (tmp_path / "x.mod").write_bytes(b"MODULE x\0")
    (tmp_path / "y.mod").write_text("MODULE y\nPROC q(\n")
    (tmp_path / "z.mod").mkdir()
    found = program(tmp_path, MOVE.format("p1"))
    assert xs(found) == [1] and not found.problems


def test_changes_go_back_where_points_are_in_another_module(tmp_path):
    program(tmp_path, MOVE.format("p9") + MOVE.format("p1"), a=target("p9", 9))
    patch(tmp_path / "p.mod", [{"index": 0, "speed_mm_s": 50.0}], tmp_path / "q.mod")
    assert [m.speed_mm_s for m in read_program(tmp_path / "q.mod").motions] == [50.0, 100.0]
