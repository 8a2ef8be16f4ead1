"""A statement that is not understood makes what it touches unknown, in every language: never others."""

import os
import random
from pathlib import Path

import numpy as np
import pytest
from support.thorough import cases

import unknowing
from unknowing_programs import BESIDE, PROGRAMS, fanuc

from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program

from fuzz_programs import OWN, seeds

ROOT = Path(__file__).resolve().parents[2]

SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
FAULTS = SHARED / "faults"
needs_faults = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {SHARED}")
FOLDERS = [
    OWN,
    FAULTS,
    *(SHARED / "data" / "programs" / one for one in ("real", "same_path_crs_part5")),
]
SEED = int(os.environ.get("BELTGRINDING_SEED") or random.SystemRandom().randrange(1_000_000))
OTHER_SUFFIX = {".gcode": ".nc", ".cls": ".apt", ".prg": ".mod", ".modx": ".mod"}
LONG = 20_000  # characters of a program of which fewer statements are tried


def corpora():
    """{name: {file: text}} of the programs: the name's file is the one that is read."""
    found = {name: {name: text, **BESIDE.get(name, {})} for name, text in PROGRAMS.items()}
    for programs in seeds(FOLDERS).values():
        for seed in programs:
            found[seed.name] = {n: data.decode("latin-1") for n, data in seed.files.items()}
    return found


CORPORA = corpora()


def place(folder, files):
    for name, text in files.items():
        (folder / name).write_bytes(text.encode("latin-1"))


def read(folder, name, text, **given):
    (folder / name).write_bytes(text.encode("latin-1"))
    return read_program(folder / name, **given)


@pytest.mark.parametrize("name", [name for name in CORPORA if not name.endswith(".dtx")])
def test_what_is_not_understood_makes_no_other_motions(tmp_path, name):
    suffix = Path(name).suffix.lower()
    suffix = OTHER_SUFFIX.get(suffix, suffix)
    text = CORPORA[name][name]
    place(tmp_path, CORPORA[name])
    try:
        whole = read_program(tmp_path / name)
    except ProgramError:
        return
    found = unknowing.mutants(text, suffix)
    random.Random(f"{SEED}:{name}").shuffle(found)
    language, wrong = unknowing.LANGUAGES[suffix], []
    for mutant in found[: cases(8 if len(text) > LONG else 30, 100 if len(text) > LONG else 1000)]:
        try:
            changed = read(tmp_path, name, mutant.text)
        except ProgramError:
            continue
        finding = unknowing.finding(whole, mutant, changed, language.procedures)
        if finding:
            wrong.append(f"{mutant} -> {finding}")
    assert not wrong, f"BELTGRINDING_SEED={SEED}:\n" + "\n".join(wrong)


def test_another_motion_speed_or_frame_is_seen(tmp_path):
    """The test itself: a reader that went on with old values would be found."""
    name = "values.mod"
    whole = read(tmp_path, name, PROGRAMS[name])
    for old, new, word in (
        ("d := 4", "", ""),
        ("q.trans.x := 120", "q.trans.x := 121", "motion"),
        ("vG.v_tcp := 20", "vG.v_tcp := 21", "speed"),
        ("[0, 10, 0]", "[0, 11, 0]", "frame"),
        ("shift q, 4", "", "motion"),
    ):
        text = PROGRAMS[name].replace(old, new)
        mutant = unknowing.Mutant(text, 1, 0, False)
        finding = unknowing.finding(whole, mutant, read(tmp_path, name, text), False)
        assert (word in finding) if word else finding is None


KEYS = ("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg")
RAPID = """MODULE M
  CONST robtarget p0 := [[100,0,50],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS robtarget p1 := [[110,0,50],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num h;
  PERS num n;
  {data}
  PROC main()
    VAR robtarget q;
    VAR robtarget r;
    {body}
  ENDPROC
ENDMODULE
"""


def rapid(tmp_path, body, data="", **variables):
    text = RAPID.replace("{data}", data).replace("{body}", "\n    ".join(body))
    return read(tmp_path, "p.mod", text, values={"variables": variables} if variables else None)


def frame(*six):
    return dict(zip(KEYS, six))


def points(program):
    """Positions, None for gaps."""
    return [
        None if m.pose is None else tuple(np.round(m.pose[:3, 3], 6).tolist())
        for m in program.motions
    ]


def move(target, speed="v100"):
    return f"MoveL {target}, {speed}, fine, tool0;"


VALUES_LOOP = [
    "FOR k FROM 0 TO 2 DO",
    "q := Offs(taught, 0, 20*k, 0);",
    "r := Offs(taught, 100, 20*k, 0);",
    move("q"),
    move("r"),
    "ENDFOR",
]
PASSES = [(500 + x, y, 300) for y in (0, 20, 40) for x in (0, 100)]


def test_rapid_asks_for_the_first_cause_alone(tmp_path):
    assert rapid(tmp_path, VALUES_LOOP).asked == {"TAUGHT": "frame"}
    program = rapid(tmp_path, VALUES_LOOP, taught=frame(500, 0, 300, 0, 0, 0))
    assert points(program) == PASSES and not program.problems


@needs_faults
def test_the_shared_loop_of_values():
    path = FAULTS / "values_loop.mod"
    assert read_program(path).asked == {"TAUGHT": "frame"}
    program = read_program(path, values={"variables": {"taught": frame(500, 0, 300, 0, 0, 0)}})
    assert points(program) == PASSES and not program.problems


def test_rapid_asks_for_what_decides_what_is_left_out(tmp_path):
    body = [
        "VAR num twice;",
        "twice := 2 * n;",
        "IF twice > 4 THEN",
        move("p0"),
        "ELSE",
        move("p1"),
        "ENDIF",
    ]
    assert rapid(tmp_path, body).asked == {"N": "number"}
    assert points(rapid(tmp_path, body, n=3)) == [(100, 0, 50)]
    assert points(rapid(tmp_path, body, n=2)) == [(110, 0, 50)]
    program = rapid(tmp_path, ["FOR k FROM 1 TO n DO", move("Offs(p0, k, 0, 0)"), "ENDFOR"], n=2)
    assert points(program) == [(101, 0, 50), (102, 0, 50)]


def test_rapid_takes_a_value_until_the_program_changes_it(tmp_path):
    body = ["FOR k FROM 1 TO 2 DO", "h := AInput(ai1);", move("Offs(p0, 0, 0, h)"), "ENDFOR"]
    program = rapid(tmp_path, body, h=7)
    assert points(program) == [(100, 0, 57), None]
    assert "more than once" in str(program.problems[0])
    own = ["VAR num mine;", "mine := AInput(ai1);", move("Offs(p0, 0, 0, mine)")]
    assert not rapid(tmp_path, own).asked  # a routine's own data are never asked for


@pytest.mark.parametrize(
    "body, expected",
    [
        (["q := p0;", "q.trans.x := AInput(a);", move("q"), "q := p1;", move("q")], [None, (110, 0, 50)]),
        (["Calibrate p1, 5;", move("p1"), move("p0")], [None, (100, 0, 50)]),
        (["h := Measure(p1);", move("p1"), move("p0")], [None, (100, 0, 50)]),
        (["SearchL di1, p1, p0, v10, tool0;", move("p1"), move("p0")], [(100, 0, 50), None, (100, 0, 50)]),
        (["IF DInput(d) = 1 THEN", "p1.trans.z := 4;", "ENDIF", move("p1"), move("p0")], [None, (100, 0, 50)]),
        (["q := p0;", "q.trans := [1,2,AInput(a)];", move("q"), "q.trans := [1,2,3];", move("q")], [None]),
        (["PDispSet Measure();", move("p0"), "PDispOff;", move("p0")], [None, (100, 0, 50)]),
        (["arr{2} := p1;", "arr{AInput(i)} := p0;", move("arr{2}"), move("p0")], [None, (100, 0, 50)]),
    ],
)  # fmt: skip
def test_rapid_loses_what_is_touched(tmp_path, body, expected):
    program = rapid(tmp_path, body, "VAR robtarget arr{2};")
    assert points(program) == expected and program.problems


def test_frames_before_and_after_a_change_that_is_not_known_are_two(tmp_path):
    data = 'PERS wobjdata w := [FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];'
    go = move("p0").replace("tool0", r"tool0\WObj:=w")
    program = rapid(
        tmp_path, [go, "w.uframe.trans.x := AInput(a);", go, go, "w := Measure();", go], data
    )
    assert len({m.base for m in program.motions}) == 3
    assert len(program.path_arrays(9.0)["frames"]) == 2
    text = fanuc(["UFRAME_NUM=1", "L P[1] 9mm/sec FINE", "UFRAME[1]=PR[3]", "L P[2] 9mm/sec FINE"])
    program = read(tmp_path, "p.ls", text)
    assert [m.base for m in program.motions] == ["UFRAME 1", "UFRAME 1 after line 5"]


def test_a_rapid_jump_back_is_followed_as_long_as_its_condition_holds(tmp_path):
    body = ["n := 1;", "again:", "n := n + 1;", move("Offs(p0, n, 0, 0)"), "IF n < 4 GOTO again;"]
    program = rapid(tmp_path, [*body, move("Offs(p0, n, 9, 0)"), move("p1")])
    rounds = [(102, 0, 50), (103, 0, 50), (104, 0, 50)]
    assert points(program) == [*rounds, (104, 9, 50), (110, 0, 50)] and not program.problems


def test_rapid_speeds_are_not_known_after_a_velset_that_is_not(tmp_path):
    program = rapid(tmp_path, ["VelSet n, 5000;", move("p0"), "VelSet 50, 5000;", move("p1")])
    assert [m.speed_mm_s for m in program.motions] == [None, 50]
    program = rapid(tmp_path, ["IF DInput(d) = 1 THEN", "VelSet 10, 50;", "ENDIF", move("p0")])
    assert [m.speed_mm_s for m in program.motions] == [None] and program.problems


def test_a_rapid_motion_with_an_argument_that_is_not_known_is_left_out(tmp_path):
    program = rapid(tmp_path, [r"MoveL p0, v100, fine, tool0\WObjX:=wobj1;", move("p1")])
    assert points(program) == [None, (110, 0, 50)] and "wobjx" in str(program.problems[0])


URSCRIPT = "def main():\n  a = p[0.1, 0, 0, 0, 0, 0]\n  global z = 0.01\n{}end\nmain()\n"


@pytest.mark.parametrize(
    "body, expected",
    [
        ("row = [0.1, 0.2]\nother = row\nother[0] = 0.5\nmovel(p[row[0],0,0,0,0,0])\nmovel(p[other[0],0,0,0,0,0])",
         [(100, 0, 0), (500, 0, 0)]),
        ("b = a\nb[1] = get_standard_analog_in(0)\nmovel(b)\nmovel(a)", [None, (100, 0, 0)]),
        ("def up():\nglobal z = z + 0.01\nreturn z\nend\nmovel(p[0,0,up(),0,0,0], u=1)\nmovel(p[0,0,z,0,0,0])\nmovel(a)",
         [None, None, (100, 0, 0)]),
        ("def up():\nglobal z = 0.5\nend\nif get_digital_in(1):\nup()\nend\nmovel(p[0,0,z,0,0,0])\nmovel(a)",
         [None, None, (100, 0, 0)]),
        ("thread watch():\nglobal z = 0.3\nend\nrun watch()\nz = 0.2\nmovel(p[0,0,z,0,0,0])\nmovel(a)", [None, None, (100, 0, 0)]),
        ("def own():\nlocal z = 0.7\nreturn z\nend\nmovel(p[own(),0,z,0,0,0])", [(700, 0, 10)]),
        ("path_offset_set(a, 1)\nmovel(a)\npath_offset_disable()\nmovel(a)", [None, (100, 0, 0)]),
        ("ok = track_conveyor_linear(a, 5)\nmovel(a)\nstop_conveyor_tracking()\nmovel(a)", [None, (100, 0, 0)]),
        ("if get_digital_in(1):\nset_user_frame(a)\nend\nmovel(a)", [None]),
        ("textmsg(a)\nset_payload(2)\nset_digital_out(1, True)\nx = get_actual_tcp_pose()\nmovel(a)", [(100, 0, 0)]),
        ("a[0] = foo()\nmovel(a)\na = p[0.2, 0, 0, 0, 0, 0]\nmovel(a)", [None, (200, 0, 0)]),
    ],
)  # fmt: skip
def test_urscript_loses_what_is_touched(tmp_path, body, expected):
    program = read(tmp_path, "p.script", URSCRIPT.format(body + "\n"))
    found = [
        p
        for k, p in enumerate(points(program))
        if p is not None or k == 0 or points(program)[k - 1]
    ]
    wanted = [p for k, p in enumerate(expected) if p is not None or k == 0 or expected[k - 1]]
    assert found == wanted
    assert None not in wanted or program.problems


def test_a_tool_that_may_be_set_is_not_the_one_before(tmp_path):
    body = "set_tcp(p[0,0,0.1,0,0,0])\nmovel(a)\nif get_digital_in(1):\nset_tcp(p[0,0,0.2,0,0,0])\nend\nmovel(a)\n"
    first, second = (m.tool for m in read(tmp_path, "p.script", URSCRIPT.format(body)).motions)
    assert first == "p[0, 0, 0.1, 0, 0, 0]" and "line" in second
    for call in ("set_tcp_by_name(1)", "ok = gripper_set_tcp()"):
        body = f"set_tcp(p[0,0,0.1,0,0,0])\nmovel(a)\n{call}\nmovel(a)\n"
        program = read(tmp_path, "p.script", URSCRIPT.format(body))
        assert "line" in program.motions[-1].tool


@pytest.mark.parametrize(
    "statements, expected",
    [
        (["R[1]=2", "R[2]=R[1]+AI[1]", "L P[R[2]] 9mm/sec FINE", "L P[R[1]] 9mm/sec FINE"], [None, (21, 11, 9)]),
        (["R[1]=2", "FOO(R[1])", "L P[R[1]] 9mm/sec FINE", "R[1]=1", "L P[R[1]] 9mm/sec FINE"], [None, (10.5, 6, 8)]),
        (["R[1]=1", "LBL[1]", "L P[R[1]] 9mm/sec FINE", "R[1]=R[1]+1", "IF DI[1]=ON,JMP LBL[1]", "L P[R[1]] 9mm/sec FINE",
          "L P[4] 9mm/sec FINE"], [(10.5, 6, 8), None, (42, 4, 11)]),
        (["WHEN R[1]=1,JMP LBL[2]", "L P[1] 9mm/sec FINE", "LBL[2]", "L P[2] 9mm/sec FINE"], [None, (21, 11, 9)]),
        (["IF R[1]=1 THEN", "L P[1] 9mm/sec FINE"], [None]),
        (["L P[2] 9mm/sec FINE MyOffset,PR[1]", "L P[1] 9mm/sec FINE"], [None, (10.5, 6, 8)]),
        (["R[1]=1", "IF DI[1]=ON,R[1]=3", "L P[R[1]] 9mm/sec FINE", "L P[1] 9mm/sec FINE"], [None, (10.5, 6, 8)]),
        (["A P[1] 9mm/sec FINE", "A P[77] 9mm/sec FINE", "A P[3] 9mm/sec FINE", "L P[4] 9mm/sec FINE"],
         [(10.5, 6, 8), None, (42, 4, 11)]),
    ],
)  # fmt: skip
def test_fanuc_loses_what_is_touched(tmp_path, statements, expected):
    program = read(tmp_path, "p.ls", fanuc(statements))
    assert points(program) == expected and program.problems


def test_fanuc_asks_for_the_register_that_is_missing(tmp_path):
    text = fanuc(["R[2]=R[7]*2", "R[3]=R[2]+1", "L P[1] R[3]mm/sec FINE", "R[4]=R[9]"])
    assert read(tmp_path, "p.ls", text).asked == {"R[7]": ""}
    program = read(tmp_path, "p.ls", text, values={"variables": {"R[7]": 5}})
    assert program.motions[0].speed_mm_s == 11 and not program.problems


@pytest.mark.parametrize(
    "statements, expected",
    [
        (["OFFSET CONDITION PR[1]", "L P[1] 9mm/sec FINE", "L P[2] 9mm/sec FINE Offset", "L P[4] 9mm/sec FINE"],
         [(10.5, 6, 8), None, (42, 4, 11)]),
        (["Touch Offset PR[1]", "L P[1] 9mm/sec FINE", "Touch Offset End", "L P[2] 9mm/sec FINE"], [None, (21, 11, 9)]),
        (["IF DI[1]=ON,Touch Offset PR[1]", "L P[1] 9mm/sec FINE"], [None]),
        (["PAYLOAD[1]", "SKIP CONDITION DI[1]=ON", "$WAITTMOUT=5", "L P[1] 9mm/sec FINE"], [(10.5, 6, 8)]),
    ],
)  # fmt: skip
def test_fanuc_shifts_lose_the_motions_after_them(tmp_path, statements, expected):
    program = read(tmp_path, "p.ls", fanuc(statements))
    assert points(program) == expected
    assert bool(program.problems) == (None in expected)


@pytest.mark.parametrize(
    "statement, base",
    [
        ("SET_UFRAME(1,2)", "UFRAME after line 5"),
        ("$MNUFRAMENUM[1]=2", "UFRAME after line 5"),
        ("IF DI[1]=ON,UFRAME[1]=PR[3]", "UFRAME 1 after line 5"),
        ("PAYLOAD[2]", "UFRAME 1"),
    ],
)
def test_fanuc_frames_that_may_be_others(tmp_path, statement, base):
    move = "L P[1] 9mm/sec FINE"
    program = read(tmp_path, "p.ls", fanuc(["UFRAME_NUM=1", move, statement, move, move]))
    assert [m.base for m in program.motions if m.pose is not None] == ["UFRAME 1", base, base]


JOB = (
    "/JOB\n//NAME P\n//POS\n///NPOS 4,0,0,2,0,0\n///USER 1\n///TOOL 0\n///POSTYPE USER\n///RECTAN\n"
    "C00000=0,0,0,0,0,0\nC00001=10,0,0,0,0,0\nC00002=20,5,0,0,0,0\nC00003=30,0,0,0,0,0\n"
    "P00001=40,0,0,0,0,0\nP00002=1,2,3,0,0,0\n//INST\nNOP\n{}\nEND\n"
)


@pytest.mark.parametrize(
    "statements, expected",
    [
        ("SETE P001 (3) D000\nMOVL P001 V=9.0\nMOVL C00001 V=9.0", [None, (10, 0, 0)]),
        ("GETE D000 P001 (3)\nMOVL P001 V=9.0", [(40, 0, 0)]),
        ("SUBX P001 P002\nMOVL P001 V=9.0\nMOVL C00001 V=9.0", [None, (10, 0, 0)]),
        ("SET P[I000] P002\nMOVL P001 V=9.0\nMOVL C00001 V=9.0", [None, (10, 0, 0)]),
        ("SFTON P002 UF#(1)\nMOVL C00000 V=9.0\nSFTOF\nMOVL C00001 V=9.0", [None, (10, 0, 0)]),
        ("MOVC C00001 V=9.0\nMOVC C00099 V=9.0\nMOVC C00003 V=9.0\nMOVL C00000 V=9.0", [(10, 0, 0), None, (0, 0, 0)]),
        ("SHIFTON P002\nMOVL C00000 V=9.0\nSHIFTOF\nMOVL C00001 V=9.0", [None, (10, 0, 0)]),
        ("MSHIFT P001 BF P002 P001\nMOVL P001 V=9.0\nMOVL C00001 V=9.0", [None, (10, 0, 0)]),
        ("CLEAR P000 5\nMOVL P001 V=9.0\nMOVL C00001 V=9.0", [None, (10, 0, 0)]),
        ("SHCKSET R1\nDOUT OT#(1) ON\nMOVL P001 V=9.0", [(40, 0, 0)]),
        ("MOVL C00001 V=9.0 SHIFT=P002\nMOVL C00000 V=9.0", [None, (0, 0, 0)]),
        ("*A\nIMOV P002 V=9.0 UF#(1)\nMOVL C00000 V=9.0\nIMOV P002 V=9.0 UF#(1)\nJUMP *A IF IN#(1)=ON\n"
         "IMOV P002 V=9.0 UF#(1)\nMOVL C00001 V=9.0", [None, (0, 0, 0), (1, 2, 3), None, (10, 0, 0)]),
    ],
)  # fmt: skip
def test_inform_loses_what_is_touched(tmp_path, statements, expected):
    program = read(tmp_path, "p.jbi", JOB.format(statements))
    assert points(program) == expected
    assert None not in expected or program.problems


@pytest.mark.parametrize(
    "instruction, base, tool",
    [
        ("MFRAME UF#(1) C00000 C00001 C00002", "USER 1 after line 15", "TOOL 0"),
        ("SETTOOL TL#(0) P002", "USER 1", "TOOL 0 after line 15"),
        ("SETUFRAME UF#(I000) P002", "USER 1 after line 15", "TOOL 0"),
        ("MFRAME UF#(2) C00000 C00001 C00002", "USER 1", "TOOL 0"),
        ("CNVRT P001 P002 UF#(1)", "USER 1", "TOOL 0"),
    ],
)
def test_inform_frames_that_may_be_others(tmp_path, instruction, base, tool):
    body = f"MOVL C00000 V=9.0\n{instruction}\nMOVL C00001 V=9.0"
    before, after = read(tmp_path, "p.jbi", JOB.format(body)).motions
    assert (before.base, before.tool) == ("USER 1", "TOOL 0")
    line = JOB.format(body).split("\n").index(instruction) + 1
    assert (after.base, after.tool) == tuple(w.replace("15", str(line)) for w in (base, tool))


@pytest.mark.parametrize(
    "blocks, expected",
    [
        ("G91 G1 X#5\nG1 X5\nG90 X7", [None, (7, 0, 0)]),  # G91 is understood, X is not
        ("G991\nX5 Y1\nG90 G21 G1 X7 Y2 Z3", [None, (7, 2, 3)]),
        ("G#1\nX5 Y1 Z1\nG90 G20 G17 G1 X1 Y2 Z3", [None, (25.4, 50.8, 76.2)]),
        ("/G91\nX5\nG90 X7 Y0 Z0", [None, (7, 0, 0)]),
        ("IF [#1 EQ 1] GOTO 10\nG91\nX5\nN10 X9 Y9 Z9\nG90 G21 G1 X7 Y0 Z0", [None, (7, 0, 0)]),
        ("WHILE [#1 LT 3] DO1\nX5\nEND1\nG90 G21 G1 X7 Y0 Z0", [None, (7, 0, 0)]),
        ("G16\nX5 Y30\nG15\nX7 Y0 Z0", [None, (7, 0, 0)]),
        ("G68 X0 Y0 R30\nX5\nG69\nX7 Y0 Z0", [None, (7, 0, 0)]),
        ("G51 X0 Y0 P2\nX5\nG50\nX7 Y0 Z0", [None, (7, 0, 0)]),
        ("G68 X50 Y20 R30\nX5\nG69\nX7\nX1 Y2 Z3", [None, (1, 2, 3)]),
        ("TRANS X10\nX5\nTRANS\nX7", [(15, 0, 0), (7, 0, 0)]),
        ("TRANS X=R99\nX5\nTRANS\nX7", [None, (7, 0, 0)]),
        ("TRANS Y10\nX5 Y1\nTRANS\nX7\nX1 Y2 Z3", [(5, 11, 0), (7, 11, 0), (1, 2, 3)]),
        ("TRANS Y=$P_X\nX5 Y1\nTRANS\nX7\nX1 Y2 Z3", [None, (1, 2, 3)]),
        ("G69\nX7", [(7, 0, 0)]),
        ("G25 X10 Y20\nX7", [(7, 0, 0)]),
        ("L100\nX7\nX1 Y2 Z3", [None, (1, 2, 3)]),
        ("G92 X0\nX5", [None]),
        ("#1=5\nX7", [(7, 0, 0)]),
        ("#5221=10\nX7", [None]),
        ("R1=10*SIN(30)\nX=R1\nX7", [(5, 0, 0), (7, 0, 0)]),
        ("R1=5*ZZ(3)\nX=R1\nX7", [None, (7, 0, 0)]),
    ],
)
def test_gcode_loses_what_is_touched(tmp_path, blocks, expected):
    program = read(tmp_path, "p.nc", f"G21 G90 G17\nG1 X0 Y0 Z0 F600\n{blocks}\nM30\n")
    assert points(program) == [(0, 0, 0), *expected]
    assert None not in expected or program.problems


def test_siemens_frames_are_not_joined(tmp_path):
    program = read(
        tmp_path, "p.mpf", "G71 G90\nG1 X0 Y0 Z0 F600\nXTRANS X10\nX1 Y1 Z1\nX2\nX3\nM30\n"
    )
    assert {m.base for m in program.motions if m.pose is not None} == {"", "after line 3"}
    assert len(program.path_arrays(9.0)["frames"]) == 3 and program.problems


@pytest.mark.parametrize("word", ["TOFRAME", "TCARR=1", "PRESETON(X,5)", "OFFN=2", "TRANSMIT"])
def test_siemens_words_that_change_coordinates_begin_another_frame(tmp_path, word):
    text = f"G71 G90\nG1 X0 Y0 Z0 F600\nX1\n{word}\nX2\nX1 Y1 Z1 A0 B0 C0\nM30\n"
    program = read(tmp_path, "p.mpf", text)
    assert points(program) == [(0, 0, 0), (1, 0, 0), None, (1, 1, 1)]
    assert program.motions[-1].base == "after line 4"


def test_each_further_offset_is_a_frame_of_its_own(tmp_path):
    blocks = "G54.1 P1\nX5\nG54.1 P2\nX6"
    program = read(tmp_path, "p.nc", f"G21 G90 G17\nG1 X0 Y0 Z0 F600\n{blocks}\nM30\n")
    assert [m.base for m in program.motions] == ["", "G54.1 P1", "G54.1 P2"]


@pytest.mark.parametrize(
    "statements, expected",
    [
        ("GOTO/1,2,3,A,0,0\nGOTO/4,5,6\nGOTO/7,8,9,0,0,1", [None, (7, 8, 9)]),
        ("M1=MACRO/X\nGOTO/1,1,1\nTERMAC\nGOTO/7,8,9", [None, (7, 8, 9)]),
        ("LOOPST\nGOTO/1,1,1\nLOOPND\nGOTO/7,8,9", [None, (7, 8, 9)]),
        ("CALL/M1\nGODLTA/1,0,0\nGOTO/7,8,9", [None, (7, 8, 9)]),
        ("GOTO/X1,2,3\nGODLTA/1,0,0\nGOTO/7,8,9", [None, (7, 8, 9)]),
    ],
)
def test_apt_loses_what_is_touched(tmp_path, statements, expected):
    program = read(tmp_path, "p.apt", f"UNITS/MM\nGOTO/0,0,0,0,0,1\n{statements}\nFINI\n")
    found = points(program)
    found = [p for k, p in enumerate(found) if p is not None or found[k - 1] is not None]
    assert found == [(0, 0, 0), *expected] and program.problems


def test_val3_frames_and_components(tmp_path):
    def program(*lines):
        place(tmp_path, BESIDE["values.pgx"])
        text = PROGRAMS["values.pgx"]
        begin, end = text.index("begin\n") + 6, text.index("end\n]]")
        return read(tmp_path, "values.pgx", text[:begin] + "\n".join(lines) + "\n" + text[end:])

    go = "movel(pPath[0],tBelt[0],mGrind[0])"
    lost = program("fPart.trsf.z=aioGet(a)", go, "fPart.trsf={1,2,3,0,0,0}", go)
    assert lost.motions[0].base not in lost.base_frames
    assert len(lost.path_arrays(9.0)["frames"]) == 1 and lost.problems  # one frame is nowhere
    assert lost.motions[1].base.startswith("fPart X 1 Y 2 Z 3")
    for line in ("nErr=setFrame(pWork,pWork,pWork,fPart)", "if calibrate(fPart)==0\nendIf"):
        lost = program(line, go, "fPart.trsf={1,2,3,0,0,0}", go)
        assert lost.motions[0].base not in lost.base_frames and lost.problems
    lost = program("nErr=measure(pPath[0],pWork)", go, "movel(pWork,tBelt[0],mGrind[0])")
    assert points(lost) == [None]
    lost = program("bOk=isInRange(pWork)", "putln(pWork)", "movel(pWork,tBelt[0],mGrind[0])")
    assert points(lost) == [(1, 0, 0)]
    lost = program("pPath[nUnknown].trsf.x=5", go, "movel(pWork,tBelt[0],mGrind[0])")
    assert points(lost) == [None, (1, 0, 0)]
    lost = program("pWork=pPath[0]", "calibrate(pPath)", go, "movel(pWork,tBelt[0],mGrind[0])")
    assert points(lost) == [None, (10, 1, 2)]


LEFT = [  # (name, program, the line of an end that may be reached)
    ("p.mod", "MODULE p\nPROC main()\nIF DInput(d) = 1 THEN\nRETURN;\nENDIF\n{}\nENDPROC\nENDMODULE", 4),
    ("p.mod", "MODULE p\nPROC main()\nIF DInput(d) = 1 EXIT;\n{}\nENDPROC\nENDMODULE", 3),
    ("p.script", "def p():\n  if get_standard_digital_in(1):\n    return 1\n  end\n  {}\nend\n", 3),
    ("p.script", "def p():\n  if get_standard_digital_in(1):\n    halt\n  end\n  {}\nend\n", 3),
    ("p.as", ".PROGRAM p()\nIF SIG(1) THEN\nRETURN\nEND\n{}\n.END\n", 3),
    ("p.src", "DEF p()\nIF $IN[1] THEN\nRETURN\nENDIF\n{}\nEND\n", 3),
]  # fmt: skip
MOTIONS = {
    ".mod": "MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;",
    ".script": "movel(p[0.001,0.002,0.003,0,0,0],v=0.1)",
    ".as": "LMOVE TRANS(1,2,3,0,0,0)",
    ".src": "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}",
}


@pytest.mark.parametrize("name, text, line", LEFT)
def test_an_end_that_may_be_reached_is_a_problem_at_its_line(tmp_path, name, text, line):
    program = read(tmp_path, name, text.replace("{}", MOTIONS[Path(name).suffix]))
    assert points(program) == [(1, 2, 3)]
    told = [one for one in program.problems if one.code == "programs.krl.may_leave"]
    assert [one.line for one in told] == [line], program.problems


def test_the_end_of_a_routine_that_may_be_called_ends_that_routine_alone(tmp_path):
    ends = "PROC b()\nn := 1;\nRETURN;\nENDPROC\n"
    body = "PROC main()\nIF DInput(d) = 1 THEN\nb;\nENDIF\n{}\nENDPROC\n".replace(
        "{}", MOTIONS[".mod"]
    )
    program = read(tmp_path, "p.mod", f"MODULE p\nVAR num n;\n{body}{ends}ENDMODULE")
    assert points(program) == [None, (1, 2, 3)]  # b may move, for all that is looked at
    assert [one.code for one in program.problems] == ["programs.decided_at_run_time"]


def test_a_jump_back_that_may_be_made_leaves_out_where_its_rounds_may_lead(tmp_path):
    rounds = ["n := 1;", "again:", move("p0"), "n := n + 1;", "IF n > 5 GOTO done;", move("p1")]
    body = [*rounds, "IF DInput(d) = 1 GOTO again;", move("p0"), "done:", move("p1")]
    program = rapid(tmp_path, body)
    assert points(program) == [(100, 0, 50), (110, 0, 50), None, (110, 0, 50)]
