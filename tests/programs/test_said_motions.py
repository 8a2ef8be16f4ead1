"""Motions that a file says by means that many programs use: what is passed by name or left away, lists over
several lines, objects, pressing with a force, statements that are still to be written."""

import os
from pathlib import Path

import pytest

from beltgrinding.programs.registry import read_program

SHARED = Path(os.environ.get("BELTGRINDING_SHARED", Path(__file__).resolve().parents[3] / "shared"))
FAULTS = SHARED / "faults"
needs_faults = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {SHARED}")
TARGET = "CONST robtarget s:=[[0,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"


def rows(program):
    """(x, y, z, mm/s, N) of each motion that is read."""
    return [
        (*(round(float(v), 6) + 0.0 for v in m.pose[:3, 3]), m.speed_mm_s, m.force_N)
        for m in program.motions
        if m.pose is not None
    ]


def read(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    return read_program(tmp_path / name)


def rapid(tmp_path, routines, body):
    return read(
        tmp_path,
        "a.mod",
        f"MODULE m\n{TARGET}{routines}\nPROC main()\n{body}\nENDPROC\nENDMODULE\n",
    )


def told(program):
    return [str(problem) for problem in program.problems]


RIGHT = {
    "defaults.script": [
        (x, y, z, v, None)
        for y, z, v in ((-200, 300, 100), (-100, 300, 100), (0, 300, 50), (100, 350, 100))
        for x in (400, 600)
    ],
    "list_lines.script": [(x, -200, 300, 100, None) for x in (400, 500, 600)],
    "rpc_call.script": [(x, -200, 300, 100, None) for x in (400, 500)],
    "force_pass.script": [
        (400, -200, 300, 100, None),
        (500, -200, 300, 20, 20),
        (500, -200, 400, 100, None),
    ],
    "present.mod": [(x, y, z, 100, None) for y, z in ((0, 300), (10, 299.5)) for x in (500, 580)],
    "smt.mod": [(500, 0, 300, 100, None), (560, 0, 300, 100, None)],
    "fcpress.mod": [
        (500, 0, 350, 200, None),
        (500, 0, 300, 20, None),
        (550, 0, 300, 20, 30),
        (600, 0, 300, 20, 30),
        (600, 0, 350, 100, None),
        (600, 0, 300, 20, None),
        (500, 0, 350, 200, None),
    ],
}


@needs_faults
@pytest.mark.parametrize("name", RIGHT)
def test_the_shared_programs_are_read_whole(name):
    program = read_program(FAULTS / name)
    assert rows(program) == RIGHT[name]
    assert program.lost == 0 and not program.problems


@pytest.mark.parametrize(
    "call, height",
    [
        ("lift;", 0),
        ("lift \\by:=5;", 5),
        ("lift \\twice;", 100),
        ("lift \\by:=5 \\twice;", 105),
        ("over;", 0),
        ("over \\more:=3;", 3),
        ("VAR num h:=7;\nlift \\by:=h;", 7),
    ],
)
def test_rapid_knows_which_optional_arguments_are_given(tmp_path, call, height):
    routines = """
    PROC lift(\\num by, \\switch twice | switch thrice)
      VAR num z:=0;
      IF Present(by) z:=by;
      IF Present(twice) THEN
        z:=z+100;
      ELSEIF Present(thrice) THEN
        z:=z+200;
      ENDIF
      MoveL Offs(s,0,0,z), v100, fine, tool0;
    ENDPROC
    PROC over(\\num more)
      lift \\by?more;
    ENDPROC
    """
    program = rapid(tmp_path, routines, call)
    assert [row[2] for row in rows(program)] == [height] and not program.problems


def test_a_rapid_function_takes_optional_arguments(tmp_path):
    routines = """
    FUNC num raised(num z \\num by)
      IF Present(by) RETURN z+by;
      RETURN z;
    ENDFUNC
    """
    body = "MoveL Offs(s,0,0,raised(1)), v100, fine, tool0;\n"
    body += "MoveL Offs(s,0,0,raised(1\\by:=2)), v100, fine, tool0;"
    program = rapid(tmp_path, routines, body)
    assert [row[2] for row in rows(program)] == [1, 3] and not program.problems


def test_what_is_given_to_a_procedure_that_nothing_calls_is_not_known(tmp_path):
    text = f"MODULE m\n{TARGET}PROC p(\\num dz)\nIF Present(dz) MoveL s, v100, fine, tool0;\n"
    program = read(tmp_path, "a.mod", text + "MoveL s, v50, fine, tool0;\nENDPROC\nENDMODULE\n")
    assert [row[3] for row in rows(program)] == [50] and program.lost == 1
    assert "whether dz is given, the caller decides" in " ".join(told(program))


def test_a_placeholder_that_runs_is_a_gap(tmp_path):
    program = rapid(tmp_path, "", "MoveL s, v100, fine, tool0;\n<SMT>\nMoveL s, v50, fine, tool0;")
    assert program.lost == 1 and len(rows(program)) == 2
    assert "<SMT> stands for a statement that is still to be written" in told(program)[0]


@pytest.mark.parametrize(
    "force, newton", [("30", 30), ("2*f", 24), ("unknown", None), ("f+", None)]
)
def test_a_rapid_force_is_computed_or_the_motion_is_left_out(tmp_path, force, newton):
    routines = "CONST num f:=12;"
    program = rapid(tmp_path, routines, f"FCPressL s, v20, {force}, z5, tool0;")
    assert [row[4] for row in rows(program)] == ([] if newton is None else [newton])
    assert program.lost == (newton is None)


def test_a_rapid_arc_under_force_has_its_force(tmp_path):
    body = "MoveL s, v100, fine, tool0;\n"
    body += "FCPressC Offs(s,10,10,0), Offs(s,20,0,0), v20, 15, fine, tool0;"
    program = rapid(tmp_path, "", body)
    assert [m.kind for m in program.motions] == ["LIN", "CIRC", "CIRC"]
    assert [row[4] for row in rows(program)] == [None, 15, 15] and not program.problems


MOVE = "movel(p[{x},0,0,0,0,0], v=0.1)"


@pytest.mark.parametrize(
    "before, force, count",
    [
        ("force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,-12,0,0,0], 2, [1,1,1,1,1,1])", 12, 0),
        ("force_mode(p[0,0,0,0,0,0], [1,1,0,0,0,0], [3,4,9,0,0,0], 2, [1,1,1,1,1,1])", 5, 0),
        ("f = 9\nforce_mode(tool_pose(), [0,0,1,0,0,0], [0,0,f,0,0,0], 2, [1])", 9, 0),
        ("force_mode(tool_pose(), [0,0,0,0,0,1], [0,0,9,0,0,2], 2, [1])", None, 0),
        ("force_mode(tool_pose(), [0,0,1,0,0,0], [0,0,get_f(),0,0,0], 2, [1])", None, 1),
        ("force_mode(tool_pose())", None, 1),
        ("if (get_x() > 1):\nforce_mode(tool_pose(), [0,0,1], [0,0,9], 2, [1])\nend", None, 1),
        ("force_mode(tool_pose(), [0,0,1], [0,0,9], 2, [1])\nend_force_mode()", None, 0),
    ],
)
def test_urscript_moves_on_under_force(tmp_path, before, force, count):
    program = read(tmp_path, "a.script", f"{before}\n{MOVE.format(x=0.1)}\n")
    assert rows(program) == [(100, 0, 0, 100, force)]
    assert program.lost == 0 and len(told(program)) == count


@pytest.mark.parametrize(
    "text, xs",
    [
        ("movel(\n p[0.1,0,0,0,0,0],\n v=0.1\n)", [100]),
        ("l = [ p[0.1,0,0,0,0,0],\n p[0.2,0,0,0,0,0] ]\nmovel(l[1])\nmovel(l[0])", [200, 100]),
        ('textmsg("(")\nmovel(p[0.1,0,0,0,0,0])', [100]),
        ("movel(p[0.1,0,0,0,0,0]\nmovel(p[0.2,0,0,0,0,0])", [200]),
        ("q = [0.1, # a comment with ]\n 0.2]\nmovel(p[q[1],0,0,0,0,0])", [200]),
        ("movel(p[[0.1,0.2][0],0,0,0,0,0])", [100]),
    ],
)
def test_urscript_statements_go_on_over_lines(tmp_path, text, xs):
    program = read(tmp_path, "a.script", text + "\n")
    assert [row[0] for row in rows(program)] == xs


@pytest.mark.parametrize(
    "call, x, lost",
    [
        ("go()", 100, 0),
        ("go(0.2)", 200, 0),
        ("go(b=0.3)", 400, 0),
        ("go(a=0.2, b=0.1)", 300, 0),
        ("go(0.2, a=0.1)", None, 1),
        ("go(c=0.1)", None, 1),
        ("go(0.1, 0.2, 0.3)", None, 1),
    ],
)
def test_urscript_routines_are_called_with_names_and_defaults(tmp_path, call, x, lost):
    text = f"def go(a = 0.1, b = 0):\nmovel(p[a + b,0,0,0,0,0])\nend\n{call}\n"
    program = read(tmp_path, "a.script", text)
    assert [row[0] for row in rows(program)] == ([] if x is None else [x])
    assert program.lost == lost


LOOPS = {  # by language: file, head, move to x, tail, and loops
    "rapid": (
        "a.mod",
        f"MODULE m\n{TARGET}PROC main()\nVAR num i:=0;\n",
        "MoveL Offs(s,i,0,0), v100, fine, tool0;\n",
        "ENDPROC\nENDMODULE\n",
        {
            "counted": "WHILE i<3 DO\ni:=i+1;\n{move}ENDWHILE\n",
            "left": "WHILE TRUE DO\ni:=i+1;\n{move}IF i=3 RETURN;\nENDWHILE\n",
            "endless": "WHILE TRUE DO\ni:=i+1;\n{move}ENDWHILE\n",
            "never": "WHILE i=0 DO\n{move}ENDWHILE\n",
            "unknown": "WHILE TRUE DO\ni:=i+1;\n{move}IF di1=1 RETURN;\nENDWHILE\n",
            "asked": "WHILE i<n DO\n{move}i:=i+1;\nENDWHILE\n",
        },
    ),
    "urscript": (
        "a.script",
        "i = 0\n",
        "movel(p[i/1000.0,0,0,0,0,0], v=0.1)\n",
        "",
        {
            "counted": "while i < 3:\ni = i + 1\n{move}end\n",
            "left": "while True:\ni = i + 1\n{move}if i == 3:\nbreak\nend\nend\n",
            "endless": "while (True):\ni = i + 1\n{move}end\n",
            "never": "while i == 0:\n{move}end\n",
            "unknown": "while True:\ni = i + 1\n{move}if get_x() > 1:\nbreak\nend\nend\n",
            "asked": "while i < n:\n{move}i = i + 1\nend\n",
        },
    ),
    "krl": (
        "a.src",
        "DEF a()\nDECL INT i\ni=0\nPTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n",
        "LIN {X i}\n",
        "END\n",
        {
            "counted": "WHILE i<3\ni=i+1\n{move}ENDWHILE\n",
            "left": "LOOP\ni=i+1\n{move}IF i==3 THEN\nEXIT\nENDIF\nENDLOOP\n",
            "endless": "LOOP\ni=i+1\n{move}ENDLOOP\n",
            "never": "WHILE i==0\n{move}ENDWHILE\n",
            "unknown": "LOOP\ni=i+1\n{move}IF $IN[1] THEN\nEXIT\nENDIF\nENDLOOP\n",
            "asked": "WHILE i<n\n{move}i=i+1\nENDWHILE\n",
        },
    ),
}
PASSES = {"counted": [1, 2, 3], "left": [1, 2, 3], "endless": [1], "never": [0], "unknown": [1]}


@pytest.mark.parametrize("language", LOOPS)
@pytest.mark.parametrize("loop", [*PASSES, "asked"])
def test_loops_run_as_far_as_they_are_known(tmp_path, language, loop):
    file, head, move, tail, loops = LOOPS[language]
    program = read(tmp_path, file, head + loops[loop].format(move=move) + tail)
    xs = [round(m.pose[0, 3], 6) for m in program.motions if m.kind == "LIN"]
    assert xs == PASSES.get(loop, [])
    sentences = {
        "endless": "is followed once",
        "never": "is followed once",
        "unknown": "its further motions are left out",
        "asked": "decided at run time",
    }
    assert sentences.get(loop, "") in " ".join(told(program))
    assert bool(program.problems) == (loop in sentences)


def test_a_switch_at_run_time_within_a_loop_leaves_the_loop_alone(tmp_path):
    code = "for k=0 to 1\nmovel(p[k],flange,m)\nswitch aio\ncase 1\nbreak\nendSwitch\nendFor\n"
    (tmp_path / "a.pgx").write_text(
        '<Programs xmlns="ProgramNameSpace"><Program name="a"><Locals><Local name="k" type="num" size="1"/>'
        f"</Locals><Code><![CDATA[begin\n{code}end]]></Code></Program></Programs>"
    )
    (tmp_path / "a.dtx").write_text(
        '<Database xmlns="DataNameSpace"><Datas><Data name="m" type="mdesc" size="1"><Value key="0" tmax="20"/></Data>'
        '<Data name="p" type="pointRx" size="2"><Value key="0" x="1" fatherId="world[0]"/>'
        '<Value key="1" x="2" fatherId="world[0]"/></Data></Datas></Database>'
    )
    program = read_program(tmp_path / "a.pgx")
    assert [row[0] for row in rows(program)] == [1, 2] and program.lost == 0


@pytest.mark.parametrize(
    "text", ["f(", "f(a", "f(a,", "a+", "Offs(s,0,0", "[", "[1", "s{", "s.", "\\"]
)
def test_an_expression_that_ends_too_early_is_told(tmp_path, text):
    for name, head, tail in (
        (
            "a.mod",
            f"MODULE m\n{TARGET}PROC main()\nMoveL ",
            ",v100,fine,tool0;\nENDPROC\nENDMODULE\n",
        ),
        ("b.mod", f"MODULE m\n{TARGET}PROC main()\nMoveL s,v100,fine,", ";\nENDPROC\nENDMODULE\n"),
        ("a.script", "movel(", "\n"),
        ("a.src", "DEF a()\nLIN ", "\nEND\n"),
    ):
        program = read(tmp_path, name, head + text + tail)
        assert program.lost and program.problems


@pytest.mark.parametrize(
    "condition, xs, sentence",
    [
        ("i < 3", [0], "is followed once"),
        ("i > 3", [], ""),
        ("get_x() > 1", [], "decided at run time"),
    ],
)
def test_a_loop_that_is_cut_off_begins_only_where_its_condition_holds(
    tmp_path, condition, xs, sentence
):
    text = f"i = 0\nwhile {condition}:\nmovel(p[i/1000.0,0,0,0,0,0], v=0.1)\ni = i + 1\n"
    program = read(tmp_path, "a.script", text)
    assert [row[0] for row in rows(program)] == xs
    assert sentence in " ".join(told(program)) and "cut off" in " ".join(told(program))


def test_a_loop_may_ask_where_the_robot_is(tmp_path):
    body = (
        "MoveL s, v100, fine, tool0;\nWHILE Distance([0,0,0],above(CRobT(\\Tool:=tool0)))<2.5 DO\n"
    )
    body += "MoveL Offs(CRobT(\\Tool:=tool0),0,0,1), v100, fine, tool0;\nENDWHILE\n"
    routines = "FUNC pos above(robtarget p)\nRETURN p.trans;\nENDFUNC"
    program = rapid(tmp_path, routines, body)
    assert [row[2] for row in rows(program)] == [0, 1, 2, 3] and not program.problems


def test_a_loop_of_as_may_ask_where_the_robot_goes(tmp_path):
    text = ".PROGRAM a()\nLMOVE TRANS(0, 0, 0, 0, 0, 0)\nWHILE DISTANCE(DEST, TRANS(0, 0, 0, 0, 0, 0)) < 2.5 DO\n"
    program = read(tmp_path, "a.as", text + "DRAW 1, 0, 0\nEND\n.END\n")
    assert [row[0] for row in rows(program)] == [0, 1, 2, 3] and program.lost == 0
