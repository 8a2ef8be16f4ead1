"""Fanuc TP programs: statements by small programs, real files where shared data is there."""

import math
import os
import re
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.languages.fanuc import reader as fanuc
from support.cost import growth

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")


def position(n, x, y, z=0.0, w=0.0, p=0.0, r=0.0, uf=1, ut=1, more=""):
    return (
        f"P[{n}]{{\n   GP1:\n\tUF : {uf}, UT : {ut},\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        f"\tX = {x} mm,\tY = {y} mm,\tZ = {z} mm,\n\tW = {w} deg,\tP = {p} deg,\tR = {r} deg{more}\n}};\n"
    )


POSITIONS = "".join(position(n, 10 * n, n * n) for n in range(1, 7))
FIRST = 3  # line of the first statement


def tp(tmp_path, statements, positions=POSITIONS, end="/END"):
    lines = [s if ":" in s[:8] and s[:4].strip() == "" else f"   1:{s}" for s in statements]
    body = "".join(f"{line} ;\n" for line in lines)
    file = tmp_path / "p.ls"
    file.write_bytes(f"/PROG P\n/MN\n{body}/POS\n{positions}{end}".encode("latin-1"))
    return fanuc.read(file)


def xs(program):
    return [m.pose[0, 3] if m.pose is not None else None for m in program.motions]


def angle_deg(a, b):
    relative = a[:3, :3].T @ b[:3, :3]
    sine = 0.5 * np.linalg.norm(
        [
            relative[2, 1] - relative[1, 2],
            relative[0, 2] - relative[2, 0],
            relative[1, 0] - relative[0, 1],
        ]
    )
    return math.degrees(math.atan2(sine, (np.trace(relative) - 1) / 2))


@needs_shared
def test_the_same_path_against_its_truth():
    folder = PROGRAMS / "same_path_crs_part5"
    program = fanuc.read(folder / "CRS_PART5.ls")
    lines = (folder / "truth.csv").read_text().splitlines()
    truth = [line.split(",") for line in lines if not line.startswith(("#", "i,"))]
    assert len(program.motions) == len(truth) == 423
    assert not program.problems
    for motion, row in zip(program.motions, truth):
        expected = frames.from_quaternion(row[4:7], row[7:11])
        assert np.abs(motion.pose[:3, 3] - expected[:3, 3]).max() <= 1e-3, row
        # W, P, R are rounded to 0.001 deg: up to half of it, thrice, and 0.001 deg of our own.
        assert angle_deg(motion.pose, expected) <= 1.5e-3, row
        assert {"J": "PTP", "L": "LIN", "S": "LIN"}.get(row[1], "CIRC") == motion.kind
        assert motion.aux == (row[1] == "Ca")
        assert (motion.base, motion.tool) == ("UFRAME 3", "UTOOL 2")


@needs_shared
def test_real_files():
    program = fanuc.read(PROGRAMS / "real" / "fanuc_crs_surface_cartesian.ls")
    assert len(program.motions) == 21 and not program.problems
    assert [m.kind for m in program.motions[:2]] == ["PTP", "LIN"]
    assert program.motions[1].speed_mm_s == 200.0
    expected = frames.from_abc(
        (653.350855, 600.959864, 660.701574), (12.082948, 13.559316, 4.261677)
    )
    np.testing.assert_allclose(program.motions[0].pose, expected)
    program = fanuc.read(PROGRAMS / "real" / "fanuc_movl_to_pr.ls")
    assert program.problems[0].line == 22 and "PR[1]" in program.problems[0].message


def test_motions_layout_frames_and_positions(tmp_path):
    file = tmp_path / "p.LS"
    file.write_bytes(
        b'/PROG  P\r\n/ATTR\r\nCOMMENT = "x;y";\r\n/MN\r\n'
        b"\t1: UFRAME_NUM=3 ;\r\n   2:UTOOL_NUM = 2;\r\n   3:\t;\r\n   4:  !a comment ; with ;\r\n"
        b"   5:  --eg:another ;\r\n   6:  //L P[9] 5mm/sec FINE ;\r\n"
        b"   7:J P[1:home] 50% CNT20    ;\r\n   8:L P[2] 12.5mm/sec FINE ACC80;\r\n"
        b"   9:C P[3]    \r\n    :  P[2] 30cm/min CR5 ;\r\n  10:  DO[1:x]=ON ;\r\n"
        b"  11:  WAIT   .50(sec) ;\r\n  12:S P[3] 60inch/min CD10 ;\r\n/POS\r\n"
        b'P[1:"home"]{\r\n GP1:\r\n UF : 3, UT : 2,\r\n J1= 0.000 deg, J2= -9.5 deg, J3= 1 deg,'
        b" J4= 0 deg, J5= 0 deg, J6= 0 deg\r\n};\r\n"
        + position(2, 1, ".5", -2, 10, 20, 30, 3, 2).encode()
        + position(3, 4, -0.25, 6, uf="F", ut="F", more=",\n\tE1 = 5.0 mm").encode()
        + b"/END\r\n"
    )
    program = fanuc.read(file)
    assert not program.problems
    assert [(m.kind, m.line, m.aux) for m in program.motions] == [
        ("PTP", 11, False),
        ("LIN", 12, False),
        ("CIRC", 13, True),
        ("CIRC", 13, False),
        ("SPL", 17, False),
    ]
    assert program.motions[0].pose is None
    np.testing.assert_allclose(
        program.motions[1].pose, frames.from_abc((1, 0.5, -2), (30, 20, 10)), atol=1e-12
    )
    speeds = [m.speed_mm_s for m in program.motions]
    assert speeds == [None, 12.5, pytest.approx(5.0), pytest.approx(5.0), pytest.approx(25.4)]
    assert {(m.base, m.tool) for m in program.motions} == {("UFRAME 3", "UTOOL 2")}
    assert len(program.path_arrays(50.0)["frames"]) > 3


@pytest.mark.parametrize(
    "statement, culprit",
    [
        ("L PR[1] 10mm/sec FINE", "PR\\[1\\]"),
        ("L P[99] 10mm/sec FINE", "P\\[99\\] is not in /POS"),
        ("L P[R[5]] 10mm/sec FINE", "R\\[5\\] has no value"),
        ("L P[2] 10mm/sec FINE Offset", "Offset"),
        ("L P[2] 10mm/sec FINE Tool_Offset,PR[3]", r"PR\[3\]"),
        ("L P[2] 10mm/sec FINE Skip,LBL[2]", "Skip"),
        ("C P[2] 10mm/sec FINE", "end point"),
        ("L P[7] 10mm/sec FINE", "joint"),
        ("L P[8] 10mm/sec FINE", "not taught"),
        ("L P[9] 10mm/sec FINE", "taught in UFRAME 2, selected is UFRAME 1"),
        ("K P[2] 10mm/sec FINE", "not understood"),
        ("L P[12", "not understood"),
        ("IF DI[1]=ON,L P[2] 10mm/sec FINE", "run time"),
        ("FOR R[1]=1 TO 3", "no ENDFOR"),
    ],
)
def test_what_is_not_known_is_said_and_leaves_a_gap(tmp_path, statement, culprit):
    joints = "P[7]{\n GP1:\n UF : 1, UT : 1,\n J1 = 5 deg\n};\n"
    untaught = position(8, "********", "*******")
    program = tp(
        tmp_path,
        ["UFRAME_NUM=1", "L P[1] 10mm/sec FINE", statement, "L P[3] 10mm/sec FINE"],
        POSITIONS + joints + untaught + position(9, 0, 0, uf=2),
    )
    (problem,) = program.problems
    assert problem.line == FIRST + 2
    assert re.search(culprit, problem.message), problem
    assert xs(program) == [10, None, 30]
    assert program.path_arrays(5.0)["rapid"].tolist() == [True, True]


@pytest.mark.parametrize(
    "speed", ["R[1]mm/sec", "90deg/sec", "R[2]%", "0mm/sec", "1O0mm/sec", "100mm/se", "1.2.3mm/sec"]
)
def test_unknown_speeds_are_noted_and_the_motion_stays(tmp_path, speed):
    program = tp(tmp_path, ["J P[1] 100% FINE", f"L P[2] {speed} FINE"])
    assert [p.line for p in program.problems] == [FIRST + 1]
    assert "speed" in program.problems[0].message
    assert xs(program) == [10, 20] and program.motions[1].speed_mm_s is None


def test_speeds_by_registers_and_by_time(tmp_path):
    program = tp(
        tmp_path,
        ["R[1:v]=20", "R[2]=R[1:v]*2", "J P[1] R[9]% FINE", "L P[2] R[2]mm/sec CNT R[3]"]
        + ["L P[1] 2sec FINE", "L P[2] 500msec FINE"],
    )
    assert not program.problems
    length = math.hypot(10, 3)
    assert [m.speed_mm_s for m in program.motions] == [
        None,
        40.0,
        pytest.approx(length / 2),
        pytest.approx(length * 2),
    ]


def test_loops_jumps_and_conditions(tmp_path):
    move = "L P[R[1]] 10mm/sec FINE"
    program = tp(tmp_path, ["FOR R[1:i]=1 TO 3", "FOR R[2]=2 DOWNTO 1", move, "ENDFOR", "ENDFOR"])
    assert xs(program) == [10, 10, 20, 20, 30, 30] and not program.problems
    program = tp(tmp_path, ["FOR R[1]=3 TO 1", move, "ENDFOR", "L P[4] 10mm/sec FINE"])
    assert xs(program) == [40]
    program = tp(
        tmp_path,
        ["R[1]=1", "LBL[1:again]", move, "R[1]=R[1]+1", "IF R[1]<=3,JMP LBL[1]", "JMP LBL[9]", move]
        + ["LBL[9]", "IF (R[1]=4) THEN", "L P[5] 9mm/sec FINE", "ELSE", move, "ENDIF", "END", move],
    )
    assert xs(program) == [10, 20, 30, 50] and not program.problems
    program = tp(tmp_path, ["LBL[1]", "L P[1] 10mm/sec FINE", "JMP LBL[1]"])
    assert xs(program) == [10] and "endless" in program.problems[0].message
    program = tp(tmp_path, ["FOR R[1]=1 TO R[7]", move, "ENDFOR", "L P[2] 10mm/sec FINE"])
    assert xs(program) == [None, 20] and "static bounds" in program.problems[0].message
    program = tp(
        tmp_path,
        ["IF DI[1]=ON,JMP LBL[2]", "L P[1] 10mm/sec FINE", "LBL[2]", "L P[2] 10mm/sec FINE"],
    )
    assert xs(program) == [None, 20] and program.problems[0].line == FIRST
    program = tp(
        tmp_path,
        ["IF (DI[1]=ON AND R[1]>2) THEN", "L P[1] 9mm/sec FINE", "ENDIF", "L P[2] 9mm/sec FINE"],
    )
    assert xs(program) == [None, 20] and program.problems[0].line == FIRST
    program = tp(
        tmp_path,
        ["SELECT R[1]=1,JMP LBL[1]", "       =2,CALL X", "       ELSE,JMP LBL[2]", "LBL[1]"]
        + ["L P[1] 10mm/sec FINE", "LBL[2]", "L P[2] 10mm/sec FINE"],
    )
    assert xs(program) == [None, 20] and [p.line for p in program.problems] == [FIRST, FIRST]
    program = tp(tmp_path, ["R[1]=1", "IF R[1]=1," * 5000, "L P[2] 10mm/sec FINE"])
    assert xs(program) == [None, 20] and program.problems[0].line == FIRST + 1
    program = tp(tmp_path, ["JMP LBL[5]", "L P[1] 10mm/sec FINE"])
    assert xs(program) == [] and "nowhere" in program.problems[0].message


def test_increments_calls_and_frame_changes(tmp_path):
    program = tp(tmp_path, ["L P[1] 9mm/sec FINE", "L P[2] 9mm/sec FINE INC", "CALL SUB(1)"])
    assert xs(program) == [10, 30, None]
    assert [(p.line, "SUB" in p.message) for p in program.problems] == [(FIRST + 2, True)]
    program = tp(tmp_path, ["CALL SUB", "L P[2] 9mm/sec FINE INC"])
    assert xs(program) == [None] and len(program.problems) == 2
    program = tp(
        tmp_path,
        ["UFRAME_NUM=1", "L P[1] 9mm/sec FINE", "UFRAME_NUM=2", "L P[7] 9mm/sec FINE"],
        POSITIONS + position(7, 70, 0, uf=2),
    )
    assert xs(program) == [10, 70] and not program.problems
    assert [frame[0, 3] for frame in program.path_arrays(9.0)["frames"]] == [10]
    assert "UFRAME 2" in program.problems[0].message and program.problems[0].line == FIRST + 3
    program = tp(
        tmp_path,
        ["L P[1] 9mm/sec FINE"],
        position(1, 1, 2, more="\n   GP2:\n\tUF : 1, UT : 1,\n\tJ1 = 3.0 mm"),
    )
    assert xs(program) == [1] and "GP1" in program.problems[0].message


def test_arc_motions_lie_on_their_circle(tmp_path):
    angles = [0, 60, 150, 200]
    points = [(100 * math.cos(math.radians(a)), 100 * math.sin(math.radians(a))) for a in angles]
    positions = "".join(
        position(k + 1, f"{x:.6f}", f"{y:.6f}", r=10 * k) for k, (x, y) in enumerate(points)
    )
    program = tp(tmp_path, [f"A P[{k}] 50mm/sec CNT100" for k in (1, 2, 3, 4)], positions)
    assert not program.problems
    assert [m.kind for m in program.motions] == ["LIN"] + ["CIRC"] * 6
    path = program.path_arrays(9.0)["frames"]
    np.testing.assert_allclose(np.linalg.norm(path[:, :2, 3], axis=1), 100.0, atol=1e-5)
    turned = np.unwrap(np.arctan2(path[:, 1, 3], path[:, 0, 3]))
    assert (np.diff(turned) > 0).all() and turned[-1] == pytest.approx(math.radians(200))
    assert angle_deg(path[0], path[-1]) == pytest.approx(30.0)
    program = tp(tmp_path, [f"A P[{k}] 50mm/sec CNT100" for k in (1, 2)], positions)
    assert [m.kind for m in program.motions] == ["LIN", "LIN"]


@pytest.mark.parametrize(
    "text, culprit",
    [
        ("", "neither /MN nor /POS"),
        ("/PROG P\n/MN\n   1:L P[1] 10\n", ":3: the statement does not end"),
        ("/PROG P\n/MN\n   1:L P[1] 10\n   2:  ;\n/END", ":3: the statement does not end"),
        ("/PROG P\n/MN\n/POS\n" + position(1, "1x0", 2), ":4: X of P\\[1\\] is '1x0'"),
        ("/PROG P\n/MN\n/POS\n" + position(1, "1.2.3", 2), ":4: X of P"),
        ("/PROG P\n/MN\n/POS\n" + position(1, "1e9999", 2), ":4: X of P"),
        ("/PROG P\n/MN\n/POS\n" + position(1, 1, 2) * 2, ":10: P\\[1\\] occurs twice"),
        ("/PROG P\n/MN\n/POS\n" + position(1, 1, 2)[:-9], ":4: a position"),
        ("/PROG P\n/MN\n/POS\nP[1]{\n GP1:\n X = 1 mm\n};", ":4: P\\[1\\] has no Y"),
        ("/PROG P\n/MN\n/POS\nP[1]{\n GP1:\n X = 1 deg\n};", "X of P\\[1\\] is not in mm"),
        ("/PROG P\n/MN\n\0", "zero bytes"),
    ],
)
def test_damaged_files_name_the_line(tmp_path, text, culprit):
    (tmp_path / "p.ls").write_text(text)
    with pytest.raises(ProgramError, match=culprit):
        fanuc.read(tmp_path / "p.ls")
    with pytest.raises(ProgramError, match="cannot be read"):
        fanuc.read(tmp_path / "absent.ls")


def test_a_missing_end_is_said(tmp_path):
    program = tp(tmp_path, ["L P[1] 10mm/sec FINE"], end="")
    assert "cut" in program.problems[0].message


def test_the_time_of_reading_goes_with_the_number_of_motions(tmp_path):
    def work(n):
        positions = "".join(position(k, k, 0) for k in range(n))
        program = tp(tmp_path, [f"L P[{k}] 100mm/sec CNT100" for k in range(n)], positions)
        assert len(program.motions) == n

    assert growth(work, 2000) < 3


def test_mutated_programs_never_crash(tmp_path):
    rng = np.random.default_rng(7)
    file = tmp_path / "m.ls"
    tp(
        tmp_path,
        ["UFRAME_NUM=1", "R[2]=5", "FOR R[1]=1 TO 3", "L P[R[1]] R[2]mm/sec FINE", "ENDFOR"]
        + ["A P[1] 9mm/sec FINE", "A P[2] 9mm/sec FINE", "A P[3] 9mm/sec FINE", "LBL[1]"]
        + [
            "C P[2]  P[3] 2sec CNT5 INC",
            "IF R[1]<>4,JMP LBL[1]",
            "IF (R[1]=2) THEN",
            "ELSE",
            "ENDIF",
        ]
        + ["SELECT R[2]=5,JMP LBL[1]", "=3,CALL X", "J P[6] 5%", "CALL Y"],
    )
    source = (tmp_path / "p.ls").read_bytes()
    letters = b"0123456789:;[]{}=,.-+/ \nRPLJCAXYZ"
    for k in range(300):
        bad = bytearray(source)
        for _ in range(rng.integers(1, 6)):
            at = rng.integers(len(bad) // (1 + k % 2))
            bad[at] = letters[rng.integers(len(letters))] if k % 3 else rng.integers(256)
        file.write_bytes(bytes(bad[: rng.integers(10, len(bad))]) if k % 4 == 0 else bytes(bad))
        try:
            program = fanuc.read(file)
        except ProgramError:
            continue
        if len(program.motions) < 1000:
            assert np.isfinite(program.path_arrays(10.0)["frames"]).all()


GERMAN = """/PROG  P
/ATTR
EIGN.\t\t= MNEDITOR;
PROG_GR\xd6\xdfE\t= 100;
/MN
   1:  BENUTZER_NUM=1 ;
   2:  WKZ_NUM=2 ;
   3:  TRAGLST[1] ;
   4:  i[5]=2    ;
   5:J P[1] 10% CNT0 ACC100 ZEIT VOR   0.00sek,P-SPS    ;
      1:  A[14]=AN ;
      2:  FB-PSPS (M[1] [&] !E[30]) ;
       ------ ;
   6:  WENN i[5]=2,SPRUNG LABEL[3] ;
   7:L P[2] 50mm/sek CNT0    ;
   8:  LABEL[3] ;
   9:L P[3] 250mm/sek CNT50 ACC100    ;
  10:L P[4] 2sek CNT50    ;
  11:  WENN (E[4]=AUS),AUFRUF MAKRO7 ;
  12:L P[5] 100mm/sek CNT0 WKZ_Offset ,PR[3]    ;
  13:L P[6] max_Geschw. CNT0    ;
  14:  //AUFRUF NICHTS ;
  15:  WARTE    .50(sek) ;
  16:  ENDE ;
  17:L P[1] 50mm/sek CNT0    ;
/POS
"""


def test_a_german_listing_reads_like_the_english_one(tmp_path):
    words = [
        ("BENUTZER_NUM", "UFRAME_NUM"), ("WKZ_NUM", "UTOOL_NUM"), ("TRAGLST", "PAYLOAD"),
        ("EIGN.", "OWNER"), ("i[5]", "R[5]"), ("ZEIT VOR", "TB"), ("sek", "sec"), ("=AN", "=ON"),
        ("A[14]", "DO[14]"), ("FB-PSPS", "TC_ONLINE"), ("[&]", "AND"), ("E[", "DI["),
        ("WENN", "IF"), ("SPRUNG", "JMP"), ("LABEL", "LBL"), ("=AUS", "=OFF"), ("AUFRUF", "CALL"),
        ("WKZ_Offset ,", "Tool_Offset,"), ("max_Geschw.", "max_speed"), ("WARTE", "WAIT"),
        ("ENDE", "END"), ("KONFIG", "CONFIG"),
    ]  # fmt: skip
    positions = "".join(position(n, 10 * n, n * n, ut=2) for n in range(1, 7))
    german = GERMAN + positions.replace("CONFIG", "KONFIG") + "/END\n"
    text = german
    for own, word in words:
        assert own in text, own
        text = text.replace(own, word)
    found = []
    for name, one in (("de.ls", german), ("en.ls", text)):
        (tmp_path / name).write_bytes(one.encode("latin-1"))
        found.append(fanuc.read(tmp_path / name))
    for a, b in zip(*(f.motions for f in found)):
        assert (a.kind, a.line, a.speed_mm_s, a.zone_mm) == (
            b.kind,
            b.line,
            b.speed_mm_s,
            b.zone_mm,
        )
        assert (a.base, a.tool) == (b.base, b.tool)
        np.testing.assert_array_equal(a.pose, b.pose)
    german, plain = found
    assert len(german.motions) == len(plain.motions)
    assert [(p.line, p.message) for p in german.problems] == [
        (p.line, p.message) for p in plain.problems
    ]
    known = [m for m in german.motions if m.pose is not None]
    assert [m.pose[0, 3] for m in known] == [10, 30, 40, 60] and known[0].base == "UFRAME 1"
    assert known[1].speed_mm_s == 250.0 and len(german.problems) == 3


def test_german_words_count_in_a_german_listing_only(tmp_path):
    program = tp(tmp_path, ["AUFUHR ;", "WENNGLEICH"])
    assert [p.code for p in program.problems] == ["programs.ignored"] * 2


def test_words_that_are_not_known_are_reported_by_line(tmp_path):
    head, positions = GERMAN.split("   3:")[0], POSITIONS.replace("CONFIG", "KONFIG")
    text = f"{head}   3:  DREHUNG[1]=5 ;\n   4:L P[1] 5mm/sek CNT0 ;\n/POS\n{positions}/END\n"
    (tmp_path / "p.ls").write_bytes(text.encode("latin-1"))
    (problem,) = [p for p in fanuc.read(tmp_path / "p.ls").problems if "DREHUNG" in p]
    assert problem.line == 8


def test_changes_go_back_into_a_german_listing(tmp_path):
    from beltgrinding.programs.patch.patch import patch

    positions = "".join(position(n, 10 * n, n * n, ut=2) for n in range(1, 7))
    text = GERMAN + positions.replace("CONFIG", "KONFIG") + "/END\n"
    (tmp_path / "p.ls").write_bytes(text.encode("latin-1"))
    patch(tmp_path / "p.ls", [{"line": 17, "speed_mm_s": 120.0}], tmp_path / "q.ls")
    new = (tmp_path / "q.ls").read_bytes().decode("latin-1")
    assert new == text.replace("250mm/sek", "120mm/sek")
    patch(tmp_path / "p.ls", [{"line": 18, "speed_mm_s": 40.0}], tmp_path / "r.ls")
    new = (tmp_path / "r.ls").read_bytes().decode("latin-1")
    assert new == text.replace("P[4] 2sek", "P[4] 40mm/sek")


def test_positions_of_other_groups_or_of_a_remote_tcp_leave_only_their_motions_out(tmp_path):
    other = "P[1]{\n   GP2:\n\tUF : 0, UT : 1,\n\tJ1= 5.0 mm\n};\n"
    remote = re.sub(r"\b([XYZWPR]) =", r"R\1 =", position(2, 1, 2))
    program = tp(
        tmp_path,
        ["L P[1] 9mm/sec CNT0", "L P[2] 9mm/sec CNT0", "L P[3] 9mm/sec CNT0"],
        other + remote + position(3, 30, 0),
    )
    assert [m.pose is not None for m in program.motions if m.pose is not None] == [True]
    assert [p.line for p in program.problems] == [3, 4]
