"""The reader of ABB RAPID: own small programs, and real files where shared data is there."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.rapid import reader as rapid
from support.cost import growth

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")
REST = "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


def point(x, y, z, q="1,0,0,0"):
    return f"[[{x},{y},{z}],[{q}],{REST}"


def read(tmp_path, source, encoding="latin-1"):
    (tmp_path / "p.mod").write_bytes(source.encode(encoding))
    return rapid.read(tmp_path / "p.mod")


def main(tmp_path, body, declarations=""):
    return read(tmp_path, f"MODULE m\n{declarations}\nPROC main()\n{body}\nENDPROC\nENDMODULE\n")


def positions(program):
    return [m.pose[:3, 3].round(9).tolist() for m in program.motions if m.pose is not None]


def angle_deg(a, b):
    d = a[:3, :3].T @ b[:3, :3]
    axis = [d[2, 1] - d[1, 2], d[0, 2] - d[2, 0], d[1, 0] - d[0, 1]]
    return np.degrees(np.arctan2(np.linalg.norm(axis), np.trace(d) - 1.0))


@needs_shared
def test_flagship_program_against_its_truth():
    program = rapid.read(PROGRAMS / "same_path_crs_part5" / "CrsPart5.mod")
    lines = (PROGRAMS / "same_path_crs_part5" / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    motions = [m for m in program.motions if m.pose is not None]
    assert len(motions) == len(truth) == 423
    assert not program.problems
    for motion, row in zip(motions, truth):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        assert angle_deg(motion.pose, expected) <= 1e-3, row
        assert {"J": "PTP", "L": "LIN", "S": "LIN"}.get(row[1], "CIRC") == motion.kind
        assert motion.aux == (row[1] == "Ca")
        assert motion.tool.startswith("tSander X 12.5") and motion.base.startswith("wPart X 1500")


@needs_shared
def test_real_files():
    forming = rapid.read(PROGRAMS / "real" / "abb_sheetforming_extaxis_excerpt.mod")
    assert not forming.problems
    assert [m.pose is None for m in forming.motions] == [True] + 19 * [False]
    # Its targets depend on data of another module: no pose, and each motion is named.
    writer = rapid.read(PROGRAMS / "real" / "abb_offs_movec_excerpt.mod")
    assert not positions(writer)
    assert {9, 10, 11, 12, 13, 14, 15} <= {p.line for p in writer.problems}
    assert any("renglon" in str(p) for p in writer.problems)
    server = rapid.read(PROGRAMS / "real" / "abb_openabb_fdm_MainModule.mod")
    assert not positions(server) and [p.line for p in server.problems] == [18, 21]


def test_layout_of_the_text(tmp_path):
    program = read(
        tmp_path,
        "%%%\r\n  VERSION:1\r\n%%%\r\nMODULE m (SYSMODULE,\r\n NOSTEPIN)\r\n"
        "! Gr\xfc\xdfe; MoveL nowhere\r\nlocal const ROBTARGET p1:=" + point(1, 2, 3) + ";\r\n"
        'proc MAIN()\r\nTPWrite "MoveL; ""IF"" ! THEN";\r\nmovel P1,\r\n  v50, ! ; comment\r\n fine,'
        "tool0\\wobj := wobj0;MoveJ p1,vmax,z0,tool0;\r\nEndProc\r\nENDMODULE\r\n",
    )
    assert not program.problems
    assert [(m.kind, m.line, m.speed_mm_s) for m in program.motions] == [
        ("LIN", 10, 50.0),
        ("PTP", 12, None),
    ]
    assert positions(program) == [[1, 2, 3], [1, 2, 3]]


@pytest.mark.parametrize(
    "statement, kinds",
    [
        ("MoveL p1,v100,fine,tool0;", ["LIN"]),
        ("MoveL \\Conc, p1\\ID:=7, v100\\V:=100\\Z:=3, z10\\Inpos:=inpos50, tool0\\Corr;", ["LIN"]),
        ("MoveC p1,p2,v100,z10,tool0;", ["CIRC aux", "CIRC"]),
        ("MoveLDO p1,v100,z10,tool0,do1,1;", ["LIN"]),
        ('MoveJSync p1,v100,z10,tool0,"proc1";', ["PTP"]),
        ("TriggL p1,v100,gun1\\T2:=gun2,z10,tool0\\WObj:=wobj0;", ["LIN"]),
        ("TriggLIOs p1,v100\\TriggData1:=a,z10,tool0;", ["LIN"]),
        ("TriggC p1,p2,v100,gun1,z10,tool0;", ["CIRC aux", "CIRC"]),
        ("SearchL di1,found,p1,v100,tool0;", ["LIN"]),
        ("ArcLStart p1,v100,seam1,weld1,fine,tool0;", ["LIN"]),
    ],
)
def test_motion_instructions(tmp_path, statement, kinds):
    data = f"CONST robtarget p1:={point(1, 2, 3)};\nCONST robtarget p2:={point(4, 2, 3)};"
    program = main(tmp_path, statement, data)
    assert not program.problems
    assert [m.kind + " aux" * m.aux for m in program.motions] == kinds
    assert all(m.speed_mm_s == 100.0 for m in program.motions)
    assert positions(program)[0] == [1, 2, 3]


def test_speeds(tmp_path):
    program = main(
        tmp_path,
        f"MoveL {point(0, 0, 0)},v5,fine,tool0;MoveL {point(30, 40, 0)},v10\\T:=2,fine,tool0;"
        f"MoveL {point(0, 0, 0)},[33,5,5,5],fine,tool0;VelSet 50,800;"
        f"MoveL {point(0, 0, 0)},v7000,fine,tool0;MoveL {point(0, 0, 0)},v100\\V:=60,z200,tool0;"
        f"MoveL {point(0, 0, 0)},vOther,fine,tool0;",
    )
    assert [m.speed_mm_s for m in program.motions] == [5, 25, 33, 800, 30, None]
    assert "vOther" in str(program.problems[0]) and len(program.problems) == 1


def test_functions_of_targets(tmp_path):
    # Turned about x by 180 degrees: the tool's z is the object's -z, its y the object's -y.
    p = point(10, 20, 30, "0,1,0,0")
    program = main(
        tmp_path,
        "MoveL RelTool(p,1,2,-60\\Rx:=90\\Rz:=90),v100,fine,tool0;"
        "MoveL Offs(p,1,2,-60),v100,fine,tool0;"
        "MoveL RelTool(CRobT(\\Tool:=tool0\\WObj:=wobj0),0,0,5),v100,fine,tool0;"
        "a:=PoseMult(PoseInv(a),PoseMult(a,a));q.trans:=a.trans;q.rot:=OrientZYX(90,0,0);"
        "MoveL q,v100,fine,tool0;"
        "q.trans.z:=-q.trans.x+Sqrt(4)*(3 DIV 2)+7 MOD 4;MoveL q,v100,fine,tool0;",
        f"CONST robtarget p:={p};VAR robtarget q:={p};VAR pose a:=[[1,2,3],[1,0,0,0]];",
    )
    assert not program.problems
    assert positions(program) == [[11, 18, 90], [11, 22, -30], [11, 22, -35], [1, 2, 3], [1, 2, 4]]
    turned = program.motions[0].pose[:3, :3]
    about_x, about_z = (frames.from_abc([0] * 3, abc)[:3, :3] for abc in ([0, 0, 90], [90, 0, 0]))
    expected = np.diag([1.0, -1.0, -1.0]) @ about_x @ about_z
    np.testing.assert_allclose(turned, expected, atol=1e-12)
    np.testing.assert_allclose(
        program.motions[3].pose, frames.from_abc([1, 2, 3], [90, 0, 0]), atol=1e-12
    )


def test_position_in_another_tool(tmp_path):
    program = main(
        tmp_path,
        f"MoveL {point(1, 2, 3)},v100,fine,t1\\WObj:=w1;MoveL CRobT(\\Tool:=tool0\\WObj:=wobj0),"
        "v100,fine,tool0;",
        "PERS tooldata t1:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
        'PERS wobjdata w1:=[FALSE,TRUE,"",[[1000,0,0],[1,0,0,0]],[[0,500,0],[1,0,0,0]]];',
    )
    assert not program.problems
    assert positions(program) == [[1, 2, 3], [1001, 502, -97]]
    assert program.motions[0].base == "w1 X 1000 Y 500 Z 0 A 0 B 0 C 0"


def test_the_part_in_the_hand(tmp_path):
    data = (
        "PERS tooldata belt:=[FALSE,[[900,0,800],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
        'PERS wobjdata part:=[TRUE,TRUE,"",[[0,0,50],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];'
    )
    program = main(tmp_path, f"MoveL {point(1, 2, 3)},v100,fine,belt\\WObj:=part;", data)
    assert not program.problems
    assert program.motions[0].tool.endswith("fixed in the room")
    assert program.motions[0].base.endswith("held by the robot")
    program = main(tmp_path, f"MoveL {point(1, 2, 3)},v100,fine,belt;", data)
    assert "robhold" in str(program.problems[0]) and program.problems[0].line == 5


def test_loops_arrays_and_branches(tmp_path):
    program = main(
        tmp_path,
        "FOR i FROM 1 TO Dim(p,1) DO\nMoveL Offs(p{i},0,0,g{2,i}),v100,fine,tool0;\nENDFOR\n"
        "FOR i FROM 3 TO 1 STEP -2 DO IF i=3 AND NOT b MoveL p{1},v100,fine,tool0; ENDFOR\n"
        "WHILE n<2 DO n:=n+1; Incr n2; MoveL Offs(p{2},n2,0,0),v100,fine,tool0; ENDWHILE\n"
        "TEST n\nCASE 1: Stop;\nCASE 2,3: MoveL p{1},v100,fine,tool0;\nDEFAULT: Stop;\nENDTEST\n"
        "IF n=1 THEN Stop; ELSEIF n=2 THEN GOTO over; ELSE Stop; ENDIF\n"
        "MoveL p{2},v100,fine,tool0;\nover:\nlast\\flag;\nMoveL p{2},v100,fine,tool0;",
        f"CONST robtarget p{{2}}:=[{point(1, 0, 0)},{point(2, 0, 0)}];\nVAR bool b;VAR num n;\n"
        "VAR num n2:=5;CONST num g{2,2}:=[[1,2],[3,4]];\n"
        "LOCAL PROC last(\\switch flag)\nVAR robtarget q;\nq:=p{1};q.trans:=[7,8,9]*2;\n"
        "MoveL q,v100,fine,tool0;\nEXIT;\nENDPROC",
    )
    assert not program.problems
    assert positions(program) == [
        [1, 0, 3],
        [2, 0, 4],
        [1, 0, 0],
        [8, 0, 0],
        [9, 0, 0],
        [1, 0, 0],
        [14, 16, 18],
    ]


def test_calls_with_arguments_and_own_records(tmp_path):
    program = main(
        tmp_path,
        "step 5, 2, back;\nstep back, 1, back;",
        f"CONST robtarget p:={point(0, 0, 0)};VAR num back;\nRECORD shift\nnum dx;\npos d;\n"
        "ENDRECORD\nVAR shift s:=[1,[0,0,9]];\nPROC step(num a, num b, INOUT num r)\n"
        "MoveL Offs(p,a,b*s.dx,s.d.z),v100,fine,tool0;\nr:=a+1;\nENDPROC",
    )
    assert not program.problems
    assert positions(program) == [[5, 2, 9], [6, 1, 9]]


def test_displacement_and_joint_targets(tmp_path):
    program = main(
        tmp_path,
        "MoveAbsJ [[0,0,0,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v500,fine,tool0;\n"
        f"PDispSet [[10,0,0],[1,0,0,0]];MoveL {point(1, 2, 3)},v100,fine,tool0;\n"
        f"PDispOff;MoveL {point(1, 2, 3)},v100,fine,tool0;\n"
        f"PDispOn CRobT(),tool0;MoveL {point(1, 2, 3)},v100,fine,tool0;",
    )
    assert program.motions[0].pose is None and program.motions[0].speed_mm_s is None
    assert positions(program) == [[11, 2, 3], [1, 2, 3]]
    assert [p.line for p in program.problems] == [7]


@pytest.mark.parametrize(
    "body, culprit",
    [
        ("MoveL pElsewhere,v100,fine,tool0;", "pElsewhere"),
        ("IF DI1=1 THEN\nGOOD\nENDIF", "run time"),
        ("IF DI1=1 GOOD", "run time"),
        ("WHILE DI1=0 DO GOOD ENDWHILE", "run time"),
        ("FOR i FROM 1 TO nParts DO GOOD ENDFOR", "nParts"),
        ("TEST GInput(gi1) CASE 1: GOOD ENDTEST", "GInput"),
        ("Elsewhere 1,2;", "Elsewhere"),
        ("MoveL CRobT(),v100,fine,tool0;", "not known"),
        ("MoveL [[0,0,0],[2,0,0,0],[0,0,0,0],[0,0,0,0,0,0]],v100,fine,tool0;", "quaternion"),
        ("MoveL [[9E9,0,0],[1,0,0,0],[0,0,0,0],[0,0,0,0,0,0]],v100,fine,tool0;", "mm"),
        ("MoveL pOk,v100,fine;", "too few"),
        ("MoveL pOk,,v100,fine,tool0;", "missing"),
        ("MoveL Offs(pOk,1,2),v100,fine,tool0;", "Offs"),
        ("MoveL pOk v100,fine,tool0,tool0;", "v100"),
        ("MoveL pList{3},v100,fine,tool0;", "no element 3"),
        ("GOTO nowhere;", "label"),
        ("again: GOTO again;", "endless GOTO"),
        ("main;", "too deeply"),
    ],
)
def test_what_is_not_known_is_said_with_its_line(tmp_path, body, culprit):
    good = f"MoveL {point(8, 8, 8)},v100,fine,tool0;"
    data = f"CONST robtarget pOk:={point(5, 5, 5)};CONST robtarget pList{{1}}:=[{point(5, 5, 5)}];"
    program = main(tmp_path, body.replace("GOOD", good), data)
    assert culprit in str(program.problems[0])
    assert program.problems[0].line == 4
    assert not positions(program)
    # The gap is not ground over, and what does not depend on it stays.
    around = f"{good}\n{body.replace('GOOD', good)}\n{good}"
    if not body.startswith(("main", "again", "GOTO")):
        arrays = main(tmp_path, around, data).path_arrays(10.0)
        assert arrays["rapid"].tolist()[-1] or "CRobT" in body
        assert len(arrays["frames"]) == 2 + ("CRobT" in body)


def test_what_may_have_been_assigned_is_unknown(tmp_path):
    program = main(
        tmp_path,
        'TPReadNum a,"how many";\nIF DI1=1 THEN b:=5; ENDIF\nMoveL Offs(p,a,0,0),v5,fine,tool0;\n'
        "MoveL Offs(p,b,0,0),v5,fine,tool0;\nb:=7;MoveL Offs(p,b,0,0),v5,fine,tool0;",
        f"CONST robtarget p:={point(0, 0, 0)};VAR num a;VAR num b;",
    )
    assert [p.line for p in program.problems] == [6, 7]
    assert positions(program) == [[7, 0, 0]]


def test_what_a_skipped_procedure_assigns_is_unknown(tmp_path):
    program = main(
        tmp_path,
        "IF DI1=1 change;\nMoveL Offs(p,b,0,0),v5,fine,tool0;\nMoveL p,v5,fine,tool0;",
        f"CONST robtarget p:={point(0, 0, 0)};VAR num b;\nPROC change()\nb:=3;\nENDPROC",
    )
    assert [p.line for p in program.problems] == [7, 8]
    assert positions(program) == [[0, 0, 0]]


def test_without_main_every_uncalled_procedure_is_followed(tmp_path):
    move = "MoveL [[{},0,0],[1,0,0,0],[0,0,0,0],[0,0,0,0,0,0]],v5,fine,tool0;"
    program = read(
        tmp_path,
        f"MODULE m\nPROC a()\n{move.format(1)}\nc;\nENDPROC\nPROC b()\n{move.format(2)}\nENDPROC\n"
        f"PROC c()\n{move.format(3)}\nENDPROC\nENDMODULE",
    )
    assert [p[0] for p in positions(program)] == [1, 3, 2]
    assert "main" in str(program.problems[0])


def test_truncated_numbers_are_never_silent(tmp_path):
    for text in ("1.2.3", "12abc", "1e", "--3", "nan", "1e999", "0x", "1,2", "Infinity"):
        program = main(tmp_path, f"MoveL {point(text, 2, 3)},v100,fine,tool0;")
        assert program.problems and not positions(program), text


@pytest.mark.parametrize(
    "source, culprit",
    [
        ("MODULE m\nPROC main()\nMoveL p1,v100,fi", "p.mod:3: .*cut off"),
        ("MODULE m\nPROC main()\nStop;\n", "p.mod:3: the PROC of line 2 has no ENDPROC"),
        ("MODULE m\nPROC main()\nFOR i FROM 1 TO 3 DO\nENDPROC\nENDMODULE", "p.mod:4: the FOR"),
        ("MODULE m\nPROC main()\nStop\nENDPROC\nENDMODULE", "p.mod:3: .*';'"),
        ("MODULE m\nENDMODULE\nENDIF\n", "p.mod:3: ENDIF closes nothing"),
        ("MODULE m\nPROC main(\nENDMODULE", "p.mod:2: the head"),
        ("%%%\nVERSION:1\nMODULE m\nENDMODULE", "p.mod:1: the header"),
        ("MODULE m\0", "zero bytes"),
        (
            "PROC main()\nFOR i FROM 1 TO 1E9 DO\nENDFOR\nENDPROC",
            "p.mod:2: the program is too long",
        ),
        (
            "PROC main()\nVAR num n;\nFOR i FROM 1 TO 9 DO\nFOR k FROM 1 TO 1E5 DO\nn:=k;\n"
            "ENDFOR\nENDFOR\nENDPROC",
            "the program is too long",
        ),
        (70 * "IF a THEN\n", "p.mod:61: .*nested"),
    ],
)
def test_programs_that_cannot_be_read(tmp_path, source, culprit):
    with pytest.raises(ProgramError, match=culprit):
        read(tmp_path, source)


def test_absent_file(tmp_path):
    with pytest.raises(ProgramError, match="absent.mod"):
        rapid.read(tmp_path / "absent.mod")


def test_the_time_of_reading_goes_with_the_number_of_motions(tmp_path):
    def work(n):
        rows = "".join(f"MoveL {point(i / 100, i % 7, 3)},v100,z1,tool0;\n" for i in range(n))
        program = main(tmp_path, rows)
        assert len(positions(program)) == n and not program.problems

    assert growth(work, 5000) < 3


OWN = (
    "%%%\nVERSION:1\n%%%\nMODULE m\nRECORD r\nnum a;\nENDRECORD\n"
    "PERS tooldata t:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
    f"CONST robtarget p{{2}}:=[{point(1, 0, 0)},{point(20, 30, 0)}];\nVAR num n:=0;\n"
    "PROC main()\nFOR i FROM 1 TO 2 DO\nMoveL Offs(p{i},1,2*i,-3),v100\\V:=7,z5,t;\nENDFOR\n"
    "WHILE n<3 DO\nn:=n+1;\nIF n=2 THEN\nside n;\nELSE\nIncr n;\nENDIF\nENDWHILE\n"
    "TEST n\nCASE 1,2: Stop;\nDEFAULT: n:=0x1F;\nENDTEST\n"
    f"MoveC RelTool(p{{1}},0,5,0\\Rx:=30),{point(7, 8, 9)},v5,fine,t\\WObj:=wobj0;\nENDPROC\n"
    "PROC side(num k)\nVAR robtarget q;\nq:=CRobT(\\Tool:=t);\nq.trans.z:=k;\nMoveJ q,v5,z1,t;\n"
    "IF k>1 RETURN;\nERROR\nRETRY;\nENDPROC\nENDMODULE\n"
)


def mutated(source, rng, tmp_path, count):
    for _ in range(count):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            at = int(rng.integers(len(bad)))
            choice = rng.integers(3)
            if choice == 0:
                bad[at] = rng.integers(256)
            elif choice == 1:
                bad[at] = rng.choice(list(b'0123456789.;,:[](){}\\!"%+-eE \n'))
            else:
                other = int(rng.integers(len(bad)))
                bad[at:at] = bad[other : other + int(rng.integers(1, 40))]
        end = len(bad) if rng.integers(4) else int(rng.integers(10, len(bad)))
        (tmp_path / "m.mod").write_bytes(bytes(bad[:end]))
        try:
            program = rapid.read(tmp_path / "m.mod")
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()
        except ProgramError as error:
            assert "m.mod" in str(error)


def test_mutated_programs_never_crash(tmp_path):
    (tmp_path / "own.mod").write_text(OWN)
    assert not rapid.read(tmp_path / "own.mod").problems
    mutated(OWN.encode(), np.random.default_rng(1), tmp_path, 300)


@needs_shared
def test_mutated_real_program_never_crashes(tmp_path):
    source = (PROGRAMS / "same_path_crs_part5" / "CrsPart5.mod").read_bytes()
    mutated(source, np.random.default_rng(2), tmp_path, 300)
