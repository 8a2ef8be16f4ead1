"""What the languages of milling programs say of their statements: each word does what its group says."""

import re

import numpy as np
import pytest

from beltgrinding.programs.languages.apt.reader import STATEMENTS as APT
from beltgrinding.programs.languages.gcode.reader import STATEMENTS as GCODE
from beltgrinding.programs.languages.klartext.reader import STATEMENTS as KLARTEXT
from beltgrinding.programs.registry import read_program

# (suffix, what begins a program, a motion before, one behind, the end) of a language
FRAMES = {
    "siemens": (".mpf", "G71 G90 G17 G54\nDEF REAL WEIGHT\n", "G1 X1 Y1 Z1 F60\n", "G1 X2 Y2 Z2\n", "M30\n"),
    "fanuc": (".nc", "G21 G90 G17 G54\n#1=1\n", "G1 X1 Y1 Z1 F60\n", "G1 X2 Y2 Z2\n", "M30\n"),
    "linuxcnc": (".ngc", "G21 G90 G17 G54\n", "G1 X1 Y1 Z1 F60\n", "G1 X2 Y2 Z2\n", "M30\n"),
    "klartext": (".h", "BEGIN PGM P MM\nTOOL CALL 1 Z S9\n", "L X+1 Y+1 Z+1 R0 F60\n", "L X+2 Y+2 Z+2\n", "END PGM P MM\n"),
    "apt": (".apt", "UNITS/MM\nFEDRAT/60,MMPM\n", "GOTO/1,1,1\n", "GOTO/2,2,2\n", "FINI\n"),
}  # fmt: skip
STATEMENTS = {**GCODE, "klartext": KLARTEXT, "apt": APT}
# What belongs to a word, where it is not written alone.
WRITTEN = {
    "G4": "G4 F1", "G22": "G22 X1", "G25": "G25 X1", "G28": "G28 X0", "G30": "G30 X0", "G53": "G53 X1",
    "G92": "G92 X0", "G93": "G93 F1", "G95": "G95 F1", "MSG": 'MSG("X1")', "SETAL": "SETAL(61000)",
    "SCALE": "SCALE X2", "ASCALE": "ASCALE X2", "MIRROR": "MIRROR X0", "AMIRROR": "AMIRROR X0",
    "ROTS": "ROTS X10 Y10", "AROTS": "AROTS X10 Y10", "CYCLE800": "CYCLE800()",
    "BLK FORM": "BLK FORM 0.1 Z X+0 Y+0 Z-40", "TOOL DEF": "TOOL DEF 5",
    "CYCL DEF 8": "CYCL DEF 8.1 X", "CYCL DEF 11": "CYCL DEF 11.1 SCL 0.5", "CYCL DEF 19": "CYCL DEF 19.1 B+45",
    "CYCL DEF 26": "CYCL DEF 26.1 X0.5", "M91": "L X+1 M91", "M92": "L X+1 M92", "M130": "L X+1 M130",
    "M89": "L X+1 M89", "APPR": "APPR LT X+1 Y+1 LEN5", "DEP": "DEP LT LEN5", "M140": "M140 MB MAX",
    "INSERT": "INSERT M8", "CYCLE": "CYCLE/DRILL", "MACRO": "M1=MACRO\nGOTO/9,9,9\nTERMAC", "LOOPST": "LOOPST\nLOOPND",
}  # fmt: skip
WRITTEN.update({f"FN {n}": f"FN {n}: X" for n in (14, 15, 16, 19, 20, 26, 27, 28, 29, 37, 38)})


def read(folder, language, text):
    suffix, begin, before, behind, end = FRAMES[language]
    path = folder / f"p{suffix}"
    path.write_text(begin + before + text + behind + end)
    return read_program(path), len((begin + before).splitlines()) + 1


def told(program):
    return [(m.kind, m.speed_mm_s, m.zone_mm, m.base, m.pose.tobytes()) for m in program.motions]


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """What each language's two motions are alone."""
    folder = tmp_path_factory.mktemp("plain")
    return {name: told(read(folder, name, "")[0]) for name in FRAMES}


@pytest.mark.parametrize("language", FRAMES)
def test_ignored_words_change_nothing(tmp_path, plain, language):
    for word in STATEMENTS[language].ignored:
        program, _ = read(tmp_path, language, WRITTEN.get(word, word) + "\n")
        assert told(program) == plain[language], word
        assert not program.problems and not program.lost, word


@pytest.mark.parametrize("language", FRAMES)
def test_words_that_are_left_out_are_told(tmp_path, plain, language):
    for word in STATEMENTS[language].left_out:
        program, line = read(tmp_path, language, WRITTEN.get(word, word) + "\n")
        assert program.problems and line <= program.problems[0].line <= line + 1, word


def test_bases_of_apt_are_asked_for(tmp_path):
    for word in APT.asked:
        program, _ = read(tmp_path, "apt", f"{word}/1,2,3\n")
        program.path_arrays(9.0)
        assert [p.code for p in program.problems] == ["programs.other_frame"], word


def test_an_unknown_word_is_told(tmp_path):
    for language in FRAMES:
        program, line = read(tmp_path, language, "GIBBERISH\n")
        assert [p.line for p in program.problems][:1] == [line], language


# Programs in which all is known, and the values x y of their last motion; with them every word that is followed.
SIEMENS = """G94 G9 G60 G61 G61.1 G62 G63 G64
R1=2 R2=0
DEF REAL WIDE=3
IF R1==2
X=R1
ELSE
X9
ENDIF
IF R1==2 GOTOF ON
X8
ON: WHILE R2<2
R2=R2+1
ENDWHILE
FOR R3=1 TO 2
Y=R3
ENDFOR
LOOP
IF R2>0 GOTOF OUT
ENDLOOP
OUT: REPEAT
R2=R2-1
UNTIL R2<=0
GOTO FIRST
FIRST: GOTOC NOWHERE
R4=0
BACK: R4=R4+1
IF R4<2 GOTOB BACK
IF R4<1 GOTOS
CASE R4 OF 2 GOTOF TWO DEFAULT GOTOF BACK
TWO: X=IC(1)
REPEATB TWO
CALL "UP"
PCALL /_N_SPF_DIR/UP
EXTCALL "UP"
UP P2
X=AC(1) Y=AC(2)
TRANS X1
ATRANS Y1
ROT Z90
AROT Z-90
ROT
TRANS
G2 X2 Y2 CR=5
G3 X3 Y3 I0.5 J0.5
CIP X4 Y3 I1=3.5 J1=4 K1=1
G2 X4 Y3 I1 J0 TURN=0
TRAORI
ORIWKS
G1 X5 Y5 A3=0 B3=0 C3=1 K0
ORIMKS
ORIEULER
A2=0 B2=0 C2=0
ORIRPY
A2=0 B2=0 C2=0
A=DC(0) C=ACP(0)
C=ACN(0) B0
TRAFOOF
T1 D1 S100 M3 H1 E1 P1 Q1 R1
X=SIN(0)+COS(90)+TAN(0)+ASIN(0)+ACOS(1)+SQRT(0)+ABS(0)+LN(1)+EXP(0)+ROUND(0)+TRUNC(0)+POT(0)+ATAN2(0,1)+MINVAL(0,1)
Y=MAXVAL(0,WIDE)
"""
UP = "PROC UP\nX=IC(1)\nIF R1==2 GOTOF THERE\nRET\nTHERE: M17\n"
FANUC = """G94 G9 G60 G61 G61.1 G62 G63 G64
#2=0
WHILE [#2 LT 2] DO 1
#2=#2+1
END 1
IF [#2 EQ 2] THEN #3=4
IF [#3 EQ 4] GOTO 10
X9
N10 X#3 Y[SIN[0]+COS[90]+TAN[0]+ASIN[0]+ACOS[1]+SQRT[0]+ABS[0]+LN[1]+EXP[0]+ROUND[0]+FIX[1.5]+FUP[0.5]]
M98 P100
G65 P200 A7
G2 X8 Y3 R4
M30
O100
X5
M99
O200
X#1
M99
"""
LINUXCNC = """o1 sub
X#1
o1 endsub
o1 call [3]
o2 if [1 EQ 2]
X9
o2 elseif [1 EQ 1]
X4
o2 else
X9
o2 endif
o3 repeat [2]
Y1
o3 endrepeat
#2=0
o4 while [#2 LT 9]
#2=[#2+1]
o5 if [#2 LT 2]
o4 continue
o5 endif
o4 break
o4 endwhile
o6 do
#2=[#2+1]
o6 while [#2 LT 5]
o7 sub
o7 return
o7 endsub
o7 call
X5 Y[SIN[0]+COS[90]+TAN[0]+ASIN[0]+ACOS[1]+SQRT[0]+ABS[0]+LN[1]+EXP[0]+ROUND[0]+FIX[1.5]+FUP[0.5]]
"""
CONVERSATIONAL = """M129
FN 0: Q1 = +5
FN 1: Q2 = +Q1 + +2
FN 2: Q2 = +Q1 - +2
FN 3: Q2 = +Q1 * +2
FN 4: Q2 = +Q1 DIV +2
FN 5: Q2 = SQRT +4
FN 6: Q2 = SIN +0
FN 7: Q2 = COS +0
FN 8: Q2 = +3 LEN +4
FN 9: IF +1 EQU +2 GOTO LBL 9
FN 10: IF +1 NE +1 GOTO LBL 9
FN 11: IF +1 GT +2 GOTO LBL 9
FN 12: IF +2 LT +1 GOTO LBL 9
LBL 9
CALL LBL 5
CYCL DEF 7.1 X+1
CYCL DEF 10.1 ROT+90
CYCL DEF 10.1 ROT+0
TRANS DATUM RESET
CYCL DEF 247 Q339=+1
PRESET SELECT #1
L X+0 Y+0 Z+0
CC X+1 Y+0
C X+2 Y+0 DR+
CR X+4 Y+0 R+1 DR-
L X+6 Y+0
CT X+7 Y+1
CC X+0 Y+0
LP PR+5 PA+0
CP PA+90 DR+
LP PR+5 PA+100
CTP PR+6 PA+120
L X+0 Y+0
L X+20 Y+0
RND R2
L X+20 Y+20
PLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN
PLANE RELATIV SPA+1 TURN
PLANE EULER EULPR+1 EULNU+2 EULROT+3 TURN
PLANE VECTOR BX+1 BY+0 BZ+0 NX+0 NY+0 NZ+1 TURN
PLANE POINTS P1X+0 P1Y+0 P1Z+0 P2X+1 P2Y+0 P2Z+0 P3X+0 P3Y+1 P3Z+0 TURN
PLANE RESET TURN
FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS
LN X+1 Y+1 Z+1 TX+0 TY+0 TZ+1
FUNCTION RESET TCPM
M128
L X+3 Y+4 Z+5 A+0 B+0 C+0
M129
M136
M137
L F60
M2
LBL 5
L X+1
LBL 0
M30
"""
CLDATA = """MULTAX/ON
TRNTYP/LOCAL
CSYS/1,0,0,0,0,1,0,0,0,0,1,0
MSYS/0,0,0,1,0,0,0,1,0
LOADTL/1
LOAD/TOOL,1
FROM/0,0,0
RAPID
GODLTA/1,0,0
TLAXIS/0,0,1
AUTOPS
PSIS/(PLANE/0,0,1,0)
INDIRV/0,-1,0
TLON,GOFWD/(CIRCLE/2,0,0,1),ON,(LINE/2,0,0,3,0,0)
INDIRP/3,1,0
TLON,GOFWD/(CIRCLE/4,0,0,1),ON,(LINE/4,0,0,5,0,0)
CIRCLE/6,0,0,0,0,1,1
GOTO/7,0,0
MOVARC/8,0,0,0,0,1,1,ANGLE,180
GOTO/9,0,0
UNIT/MM
END-OF-PATH
"""


@pytest.mark.parametrize(
    "language, text, end",
    [
        ("siemens", SIEMENS, (1, 3)),
        ("fanuc", FANUC, (8, 3)),
        ("linuxcnc", LINUXCNC, (5, 3)),
        ("klartext", CONVERSATIONAL, (3, 4)),
        ("apt", CLDATA, (9, 0)),
    ],
    ids=["siemens", "fanuc", "linuxcnc", "klartext", "apt"],
)
def test_followed_words_are_followed(tmp_path, language, text, end):
    (tmp_path / "up.spf").write_text(UP)
    suffix, begin, before, behind, last = FRAMES[language]
    path = tmp_path / f"p{suffix}"
    path.write_text(begin + before + text + (last if language != "fanuc" else ""))
    program = read_program(path)
    assert [str(p) for p in program.problems if p.code != "programs.klartext.chamfer"] == []
    found = next(m for m in reversed(program.motions) if m.pose is not None)
    np.testing.assert_allclose(found.pose[:2, 3], end, atol=1e-6)
    written = re.sub(r"\bo(\d+) ", "O ", begin + before + text + last + UP).upper()
    for word in STATEMENTS[language].followed:
        if re.fullmatch(r"G[\d.]+", word) or word in ("CHF", "M2"):
            continue
        assert re.search(rf"(?<![A-Z]){re.escape(word)}(?![A-Z])", written), word


@pytest.mark.parametrize("language", ["siemens", "fanuc", "linuxcnc"])
def test_followed_codes_give_no_problem(tmp_path, language):
    for word in STATEMENTS[language].followed:
        if not re.fullmatch(r"G[\d.]+", word) or word in ("G2", "G3", "G91", "G65"):
            continue
        after = {"G43.5": "G49\n", "G43.4": "G49\n"}.get(
            word, "G71\n" if word in ("G20", "G70", "G700") else ""
        )
        program, _ = read(tmp_path, language, f"{word}\n{after}")
        assert not program.problems and not program.lost, word
