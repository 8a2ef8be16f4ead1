"""What RAPID, URScript, VAL3, PolyScope and Kawasaki AS say that they follow, is what they do, word by word."""

import pytest

from beltgrinding.programs.languages.kawasaki import reader as kawasaki
from beltgrinding.programs.languages.rapid import reader as rapid
from beltgrinding.programs.languages.rapid.motion import spec_of
from beltgrinding.programs.languages.urp import reader as urp
from beltgrinding.programs.languages.urscript import reader as urscript
from beltgrinding.programs.languages.val3 import reader as val3
from beltgrinding.programs.registry import read_program
from test_urp import document, expression, move, old

MODULE = """MODULE M
CONST robtarget a:=[[1,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget b:=[[2,0,1],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR jointtarget j:=[[1,2,3,4,5,6],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR num n:=1;
PROC main()
MoveL a,v100,fine,tool0;
{}
MoveL b,v100,fine,tool0;
ENDPROC
ENDMODULE
"""
AS = """.PROGRAM p()
SPEED 10 MM/S ALWAYS
LMOVE TRANS(1,0,0,0,0,0)
{}
LMOVE TRANS(2,0,0,0,0,0)
.END
"""
SCRIPT = """def p():
movel(p[1,0,0,0,0,0])
{}
movel(p[2,0,0,0,0,0])
end
"""
PGX = """<Programs><Program name="p"><Locals><Local name="k" type="num" size="1"/></Locals><Code><![CDATA[begin
movel(a, flange, slow)
{}
movel(b, flange, slow)
end]]></Code></Program></Programs>"""
DTX = """<Database><Datas><Data name="a" type="pointRx"><Value key="0" x="1"/></Data>
<Data name="b" type="pointRx"><Value key="0" x="2"/></Data>
<Data name="slow" type="mdesc"><Value key="0" tmax="20"/></Data></Datas></Database>"""


def read(folder, language, text):
    suffix, form = {
        rapid: (".mod", MODULE),
        kawasaki: (".as", AS),
        urscript: (".script", SCRIPT),
        val3: (".pgx", PGX),
    }[language]
    path = folder / f"p{suffix}"
    path.write_text(form.format(text))
    if language is val3:
        (folder / "p.dtx").write_text(DTX)
    return read_program(path)


def polyscope(folder, node):
    path = folder / "p.urp"
    between = f"{move(old('0.1, 0, 0, 0, 0, 0'))}{node}{move(old('0.2, 0, 0, 0, 0, 0'))}"
    path.write_text(document(between))
    return read_program(path)


def words(language, group):
    return [(language, word) for word in getattr(language.STATEMENTS, group)]


WRITTEN = {
    rapid: "{} x1,1;",
    kawasaki: "{} 1",
    urscript: "{}(1)",
    val3: "{}(1)",
}


@pytest.mark.parametrize(
    "language, word", [one for language in WRITTEN for one in words(language, "ignored")]
)
def test_an_ignored_statement_changes_nothing(tmp_path, language, word):
    text = WRITTEN[language].format(word.replace("*", "x"))
    assert_nothing_changed(read(tmp_path, language, text))


def assert_nothing_changed(program):
    assert [motion.kind for motion in program.motions] == ["LIN", "LIN"]
    assert not program.problems and program.lost == 0


@pytest.mark.parametrize("word", urp.STATEMENTS.ignored)
def test_an_ignored_node_changes_nothing(tmp_path, word):
    assert_nothing_changed(polyscope(tmp_path, f"<{word}/>"))


# Left out where a word alone is no statement of the language.
LOST = {
    "<SMT>": "<SMT>",
    "thread": "thread t():\nmovel(p[3,0,0,0,0,0])\nend",
    "sec": "sec t():\nmovel(p[3,0,0,0,0,0])\nend",
    "taskCreate": 'taskCreate "t",10,b()',
    "taskCreateSync": 'taskCreateSync "t",0.01,b,b()',
}


@pytest.mark.parametrize(
    "language, word", [one for language in WRITTEN for one in words(language, "left_out")]
)
def test_what_is_left_out_is_told_at_its_line(tmp_path, language, word):
    program = read(tmp_path, language, LOST.get(word, WRITTEN[language].format(word)))
    line = {rapid: 8, kawasaki: 4, urscript: 3, val3: 3}[language]
    assert line in [problem.line for problem in program.problems]
    assert program.lost >= 1 and "GAP" in [motion.kind for motion in program.motions]


NODES = {
    "Force": f"<Force><children>{move(old('0.15, 0, 0, 0, 0, 0'))}</children></Force>",
    "Contributed": '<Contributed strategyProgramNodeType="Screw"/>',
    "Direction": "<Direction/>",
    "Switch": "<Switch/>",
}


@pytest.mark.parametrize("word", urp.STATEMENTS.left_out)
def test_a_node_that_is_left_out_is_told_at_its_line(tmp_path, word):
    if word == "Thread":
        moves = f"<Thread><children>{move(old('0.1, 0, 0, 0, 0, 0'))}</children></Thread>"
        (tmp_path / "p.urp").write_text(document(move(old("0.2, 0, 0, 0, 0, 0")), moves))
        program = read_program(tmp_path / "p.urp")
        assert [problem.line for problem in program.problems] == [2]
        return
    program = polyscope(tmp_path, NODES[word])
    (problem,) = program.problems
    rows = (tmp_path / "p.urp").read_text().splitlines()
    assert f"<{word}" in rows[problem.line - 1]


@pytest.mark.parametrize(
    "language, word", [one for language in (rapid, kawasaki) for one in words(language, "asked")]
)
def test_what_is_asked_for_is_not_known_behind(tmp_path, language, word):
    if language is rapid:
        text = f"{word} n;\nMoveL Offs(a,n,0,0),v100,fine,tool0;"
    else:
        text = f"n = 1\n{word} n\nLMOVE TRANS(n,0,0,0,0,0)"
    program = read(tmp_path, language, text)
    assert program.lost == 1 and len(program.problems) == 1
    told = str(program.problems[0])
    assert "n is not known" in told or "N has no value" in told


CIRCLE = "[[1,1,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],b"
RAPID = {
    "IF": "IF n=1 THEN\nn:=2;\nENDIF",
    "FOR": "FOR i FROM 1 TO 2 DO\nn:=i;\nENDFOR",
    "WHILE": "WHILE n<3 DO\nn:=n+1;\nENDWHILE",
    "TEST": "TEST n\nCASE 1: n:=2;\nENDTEST",
    "GOTO": "GOTO over;\nMoveL a,v10,fine,tool0;\nover:",
    "VelSet": "VelSet 50,800;",
    "PDispSet": "PDispSet [[1,0,0],[1,0,0,0]];",
    "Add": "Add n,2;",
    **{word: f"{word} n;" for word in ("Incr", "Decr", "Clear")},
}


def motion_of(word):
    """A statement of RAPID with a motion instruction of any form."""
    spec = spec_of(word.lower())
    target = "j" if spec.joint else CIRCLE if spec.kind == "CIRC" else "b"
    between = ["n"] * spec.before + [target, "v100"] + ["1"] * (spec.to_tool - 2)
    if spec.to_tool > 1:
        between.append("fine")
    return f"{word} {','.join([*between, 'tool0'])};"


@pytest.mark.parametrize("word", rapid.STATEMENTS.followed)
def test_what_rapid_follows_is_told_of_nothing(tmp_path, word):
    if spec_of(word.lower()):
        program = read(tmp_path, rapid, motion_of(word))
        assert len(program.motions) == (4 if spec_of(word.lower()).kind == "CIRC" else 3)
    else:
        program = read(tmp_path, rapid, RAPID.get(word, f"{word};"))
    assert not program.problems and program.lost == 0


FOLLOWED = {
    urscript: {
        "movec": "movec(p[1,1,0,0,0,0],p[2,0,0,0,0,0])",
        "if": "if True:\nk=1\nend",
        "while": "k=0\nwhile k<2:\nk=k+1\nend",
        "def": "def f():\nk=1\nend",
        "return": "return 1",
        "break": "while True:\nbreak\nend",
        "continue": "k=0\nwhile k<2:\nk=k+1\ncontinue\nend",
        "halt": "halt",
        "optimovel": "optimovel(p[1,0,0,0,0,0])",
        "force_mode": "force_mode(p[0,0,0,0,0,0],[0,0,1,0,0,0],[0,0,9,0,0,0],2,[1,1,1,1,1,1])",
        "end_force_mode": "end_force_mode()",
    },
    val3: {
        "movec": "movec(a, b, flange, slow)",
        "if": "if k==0\nk=1\nendIf",
        "for": "for k=0 to 2\nk=k\nendFor",
        "while": "while k<2\nk=k+1\nendWhile",
        "do": "do\nk=k+1\nuntil k>2",
        "switch": "switch k\ncase 0\nk=1\nbreak\nendSwitch",
        "link": "link(a, world)",
        "resize": "resize(k, 0, 3)",
        "call": "call p()",
        "return": "return",
        "break": "switch k\ncase 0\nbreak\nendSwitch",
    },
    kawasaki: {
        "IF": "IF 1 THEN\nk = 1\nEND",
        "FOR": "FOR k = 1 TO 2\nj = k\nEND",
        "WHILE": "k = 0\nWHILE k<2 DO\nk = k+1\nEND",
        "DO": "k = 0\nDO\nk = k+1\nUNTIL k>2",
        "CASE": "CASE 1 OF\nVALUE 1:\nk = 1\nEND",
        "SPEED": "SPEED 10 MM/S",
        "ACCURACY": "ACCURACY 1",
        "TOOL": "TOOL NULL",
        "BASE": "BASE NULL",
        "CP": "CP OFF",
        "GOTO": "GOTO over\nover:",
        "HERE": "BREAK\nHERE x",
        "POINT": "POINT x = TRANS(1,0,0,0,0,0)",
        "DECOMPOSE": "DECOMPOSE x[0] = TRANS(1,0,0,0,0,0)",
        "C1MOVE": "C1MOVE TRANS(1,1,0,0,0,0)\nC2MOVE TRANS(2,0,0,0,0,0)",
        "C2MOVE": "C1MOVE TRANS(1,1,0,0,0,0)\nC2MOVE TRANS(2,0,0,0,0,0)",
        "DRAW": "DRAW 1,0,0",
        "TDRAW": "TDRAW 1,0,0",
        "JOINT": "JOINT SPEED9 ACCU1 TIMER0 TOOL1 WORK0 CLAMP1 (OFF,0,0,O) OX= WX= #[1,2,3,4,5,6] ;",
        "LINEAR": "LINEAR SPEED9 ACCU1 TIMER0 TOOL1 WORK0 CLAMP1 (OFF,0,0,O) OX= WX= #[1,2,3,4,5,6] ;",
        "BREAK": "BREAK",
        "CALL": "CALL q\n.END\n.PROGRAM q()\nk = 1",
        **{word: f"{word} 10" for word in ("JDEPART", "LDEPART")},
        **{word: f"{word} TRANS(1,0,0,0,0,0),10" for word in ("JAPPRO", "LAPPRO")},
        **dict.fromkeys(("RETURN", "STOP", "HALT")),
    },
}
# Told as a word of their own: of the speed, of a share of what the robot can; of its geometry; of a call to itself.
OWN = {"optimovel": "path_speed_unknown", "LINEAR": "joint_target", "call": "calls_itself"}


@pytest.mark.parametrize(
    "language, word", [one for language in FOLLOWED for one in words(language, "followed")]
)
def test_what_is_followed_is_told_of_nothing(tmp_path, language, word):
    form = {urscript: "{}(p[1,0,0,0,0,0])", val3: "{}(a, flange, slow)"}.get(language, "{}")
    if language is kawasaki and word.endswith("MOVE"):
        form = "{} TRANS(1,0,0,0,0,0)"
    text = FOLLOWED[language].get(word) or form.format(word)
    program = read(tmp_path, language, text)
    told = [problem.code for problem in program.problems]
    if word in OWN:
        assert told
        return
    assert not told and program.lost == 0


def test_nodes_that_are_followed_are_told_of_nothing(tmp_path):
    one = move(old("0.3, 0, 0, 0, 0, 0"))
    variable = '<variable class="GlobalVariable" name="k"/>'
    arc = f"<CircleMove>{old('0.1, 0.1, 0, 0, 0, 0')}{old('0.2, 0, 0, 0, 0, 0')}</CircleMove>"
    nodes = {
        "If": f'<If type="If">{expression("True")}<children>{one}</children></If>',
        "Move": one,
        "Waypoint": one,
        "CircleMove": move(arc, "MoveP"),
        "Folder": f"<Folder><children>{one}</children></Folder>",
        "Loop": f'<Loop type="Count" loopCount="2"><children>{one}</children></Loop>',
        "CallSubProgram": f"<CallSubProgram><subprogram><children>{one}</children></subprogram></CallSubProgram>",
        "Script": "<Script><cachedContents>movel(p[0,0,0,0,0,0])</cachedContents></Script>",
        "Assignment": f"<Assignment>{variable}{expression('1')}</Assignment>",
        "Halt": "<Halt/>",
        "Set": "<Set/>",
    }
    assert sorted(nodes) == sorted(urp.STATEMENTS.followed)
    for node in nodes.values():
        program = polyscope(tmp_path, node)
        assert not program.problems and program.lost == 0, (node, program.problems)


def test_a_word_in_no_group_is_told(tmp_path):
    for language, text in (
        (rapid, "MoveExtJ j,v100,fine;"),
        (kawasaki, "FLY 3"),
        (urscript, "fly(3)"),
        (val3, "fly(3)"),
    ):
        assert read(tmp_path, language, text).problems
    assert polyscope(tmp_path, "<Fly/>").problems
