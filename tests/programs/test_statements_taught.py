"""What Fanuc TP, INFORM and KRL do with each of their statements: every word of their tables is tried."""

import pytest

from beltgrinding.programs.languages.fanuc import reader as fanuc
from beltgrinding.programs.languages.inform import reader as inform
from beltgrinding.programs.languages.krl import reader as krl

POINT = "P[{0}]{{{{\n GP1:\n UF : 1, UT : 1,\n X = {0}0 mm, Y = 0 mm, Z = 5 mm,\n W = 0 deg, P = 0 deg, R = 0 deg\n}}}};\n"
LS = "/PROG P\n/MN\n{}/POS\n" + "".join(POINT.format(n) for n in range(1, 5)) + "/END\n"
JBI = (
    "/JOB\n//NAME P\n//POS\n///USER 1\n///TOOL 0\n///POSTYPE USER\n///RECTAN\n"
    + "".join(f"C0000{n}={n}0,0,5,0,0,0\n" for n in range(1, 5))
    + "P00001=1,2,3,0,0,0\nP00002=4,5,6,0,0,0\n//INST\nNOP\n{}END\n"
)
SRC = "DEF p()\nINT n\n$VEL.CP=0.1\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\nPTP {{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n{}END\n"


class Fanuc:
    STATEMENTS, FIRST = fanuc.STATEMENTS, 3
    MOVES = ("L P[1] 9mm/sec FINE", "L P[2] 9mm/sec FINE")
    SUFFIX = ".ls"

    @staticmethod
    def text(rows):
        return LS.format("".join(f" 1: {row} ;\n" for row in rows))

    @staticmethod
    def ignored(word):
        return [f"{word}[1]=ON"]

    FOLLOWED = {
        "J": ["J P[3] 50% FINE"],
        "L": ["L P[3] 9mm/sec FINE"],
        "C": ["C P[3] P[4] 9mm/sec FINE"],
        "A": ["A P[3] 9mm/sec FINE", "A P[4] 9mm/sec FINE"],
        "S": ["S P[3] 9mm/sec FINE"],
        "IF": ["R[1]=2", "IF R[1]=2 THEN", "L P[3] 9mm/sec FINE", "ENDIF"],
        "ELSE": ["R[1]=2", "IF (R[1]=1) THEN", "L P[9]", "ELSE", "J P[3] 5% FINE", "ENDIF"],
        "ENDIF": ["R[1]=2", "IF R[1]<>2 THEN", "L P[9] 9mm/sec FINE", "ENDIF"],
        "FOR": ["FOR R[1]=3 TO 4", "L P[R[1]] 9mm/sec FINE", "ENDFOR"],
        "ENDFOR": ["FOR R[1]=4 DOWNTO 3", "L P[R[1]] 9mm/sec FINE", "ENDFOR"],
        "SELECT": ["R[1]=3", "SELECT R[1]=1,CALL NONE", "=3,JMP LBL[7]", "ELSE,CALL NONE", "LBL[7]"],
        "LBL": ["LBL[3:name]"],
        "JMP": ["JMP LBL[3]", "L P[9] 9mm/sec FINE", "LBL[3]"],
        "CALL": ["CALL SUB(3)"],
        "END": ["IF 1=2,END"],
        "ABORT": ["IF 1=2,ABORT"],
        "R": ["R[1]=(2+3)*4", "J P[3] R[1]% FINE"],
        "PR": ["PR[1]=P[3]", "PR[1,2]=5", "L PR[1] 9mm/sec FINE"],
        "UFRAME_NUM": ["UFRAME_NUM=1"],
        "UTOOL_NUM": ["UTOOL_NUM=1"],
        "OFFSET CONDITION": ["PR[1]=P[3]", "OFFSET CONDITION PR[1]", "L P[2] 9mm/sec FINE Offset"],
        "TOOL_OFFSET CONDITION": [
            "PR[1]=P[3]", "TOOL_OFFSET CONDITION PR[1]", "L P[2] 9mm/sec FINE Tool_Offset",
        ],
    }  # fmt: skip
    LEFT_OUT = {
        "RUN": "RUN OTHER",
        "UFRAME": "UFRAME[1]=PR[1]",
        "UTOOL": "UTOOL[1]=PR[1]",
        "VOFFSET": "L P[3] 9mm/sec FINE VOFFSET,VR[1]",
        "Search": "L P[3] 9mm/sec FINE Search[X]",
        "TrackPR": "L P[3] 9mm/sec FINE TrackPR[1]",
        "Skip": "L P[3] 9mm/sec FINE Skip,LBL[1]",
    }
    ASKED = {}
    STRANGE = "FROBNICATE[3]"


class Inform:
    STATEMENTS, FIRST = inform.STATEMENTS, 16
    MOVES = ("MOVL C00001 V=9.0", "MOVL C00002 V=9.0")
    SUFFIX = ".jbi"

    @staticmethod
    def text(rows):
        return JBI.format("".join(f"{row}\n" for row in rows))

    @staticmethod
    def ignored(word):
        return [f"{word} OT#(1) ON"]

    FOLLOWED = {
        **{word: [f"{word} C00003 V=9.0"] for word in ("MOVL", "MOVS", "SMOVL", "SMOVS")},
        **{word: [f"{word} C00003 VJ=9.0"] for word in ("MOVJ", "SMOVJ")},
        **{word: [f"{word} C0000{k} V=9.0" for k in (2, 3, 4)] for word in ("MOVC", "SMOVC")},
        "IMOV": ["IMOV P001 V=9.0 UF#(1)"],
        "IFTHEN": ["SET B000 2", "IFTHEN B000=2", "MOVL C00003 V=9.0", "ENDIF"],
        "IF": ["SET B000 2", "PAUSE IF B000=2", "RET IF B000=3"],
        "ELSEIF": ["SET B000 2", "IFTHEN B000=1", "ELSEIF B000=2", "MOVL P002 V=9.0", "ENDIF"],
        "ELSE": ["SET B000 2", "IFTHENEXP B000=1", "ELSE", "MOVL P002 V=9.0", "ENDIF"],
        "ENDIF": ["SET B000 2", "IFTHEN B000<>2", "MOVL C00099 V=9.0", "ENDIF"],
        "WHILE": ["SET I000 0", "WHILE I000<2", "MOVL C00003 V=9.0", "INC I000", "ENDWHILE"],
        "ENDWHILE": ["SET I000 9", "WHILEEXP I000<2", "MOVL C00099 V=9.0", "ENDWHILE"],
        "FOR": ["FOR I000 = 3 TO 1 BY -1", "MOVL C00003 V=9.0", "NEXT I000"],
        "NEXT": ["FOR I000 = 1 TO 2", "MOVL C00003 V=9.0", "NEXT I000"],
        "SWITCH": ["SET B000 3", "SWITCH B000", "CASE 1", "MOVL C00099 V=9.0", "CASE 3",
                   "MOVL C00003 V=9.0", "DEFAULT", "MOVL C00099 V=9.0", "ENDSWITCH"],
        "CASE": ["SWITCH 2", "CASE 2", "MOVL C00003 V=9.0", "ENDSWITCH"],
        "DEFAULT": ["SWITCH 2", "CASE 1", "DEFAULT", "MOVL C00003 V=9.0", "ENDSWITCH"],
        "ENDSWITCH": ["SWITCH 2", "CASE 1", "ENDSWITCH"],
        "SET": ["SET I003 2", "SET P003 P[I003]", "SET P004 P002", "MOVL P004 V=9.0"],
        "ADD": ["SET B000 1", "ADD B000 1", "MOVL P[B000] V=9.0"],
        "SUB": ["SET B000 3", "SUB B000 1", "MOVL P[B000] V=9.0"],
        "MUL": ["SET B000 1", "MUL B000 2", "MOVL P[B000] V=9.0"],
        "DIV": ["SET B000 4", "DIV B000 2", "MOVL P[B000] V=9.0"],
        "INC": ["SET B000 1", "INC B000", "MOVL P[B000] V=9.0"],
        "DEC": ["SET B000 3", "DEC B000", "MOVL P[B000] V=9.0"],
        "GETARG": ["CALL JOB:SUB ARGF2"],
        "CALL": ["SET B000 2", "CALL JOB:SUB ARG B000"],
        "JUMP": ["JUMP *A", "MOVL C00099 V=9.0", "*A"],
        "RET": ["RET IF 1=2"],
        "END": ["END IF 1=2"],
        "ABORT": ["ABORT IF 1=2"],
        "BREAK": ["FOR I000 = 1 TO 5", "BREAK IF I000=2", "MOVL C00003 V=9.0", "NEXT I000"],
        "CONTINUE": ["FOR I000 = 1 TO 2", "CONTINUE IF I000=2", "MOVL C00003 V=9.0", "NEXT I000"],
        "SPEED": ["SPEED V=20.0", "MOVL C00003"],
    }  # fmt: skip
    LEFT_OUT = {
        "MACRO1": "MACRO1 MJ#(1)",
        "SFTON": "SFTON P001 UF#(1)\nMOVL C00003 V=9.0\nSFTOF",
        "SFTOF": "SFTON P001\nMOVL C00003 V=9.0\nSFTOF",
        "MSHIFT": "MSHIFT P001 BF P002 P001",
        "+MOV": "+MOVJ EC00001 VJ=5.0",
    }
    ASKED = {
        word: ([f"{word} P002 B001 $PX000", "MOVL P[B001] V=9.0"], "B001")
        for word in inform.STATEMENTS.asked
    }
    STRANGE = "FROBNICATE 3"


class Krl:
    STATEMENTS, FIRST = krl.STATEMENTS, 7
    MOVES = ("LIN {X 10,Y 0,Z 0}", "LIN {X 20,Y 0,Z 0}")
    SUFFIX = ".src"

    @staticmethod
    def text(rows):
        return SRC.format("".join(f"{row}\n" for row in rows))

    @staticmethod
    def ignored(word):
        called = word.lower() in krl.HARMLESS
        return [f"{word}()"] if called else [f"{word} zz" if word not in ("ENDDAT",) else word]

    FOLLOWED = {
        **{word: [f"{word} {{Y 3}}"] for word in krl.MOTIONS if "CIRC" not in word},
        **{word: [f"{word} {{X 3,Y 3,Z 0}},{{X 6,Y 0,Z 0}}"] for word in ("CIRC", "SCIRC")},
        **{word: [f"{word} {{X 3,Y 3}},{{X 6}}"] for word in ("CIRC_REL", "SCIRC_REL")},
        **{word: [f"FOR n=1 TO 3{chr(10)}LIN {{X n}}{chr(10)}ENDFOR"] for word in ("FOR", "ENDFOR")},
        **{word: ["n=1", "IF n==2 THEN", "LIN unknown", "ELSE", "LIN {X n}", "ENDIF"] for word in ("IF", "ELSE", "ENDIF")},
        **{word: ["n=1", "WHILE n<3", "LIN {X n}", "n=n+1", "ENDWHILE"] for word in ("WHILE", "ENDWHILE")},
        **{word: ["n=1", "LOOP", "LIN {X n}", "n=n+1", "IF n>3 THEN", "EXIT", "ENDIF", "ENDLOOP"]
           for word in ("LOOP", "ENDLOOP", "EXIT")},
        **{word: ["n=1", "REPEAT", "LIN {X n}", "n=n+1", "UNTIL n>3"] for word in ("REPEAT", "UNTIL")},
        **{word: ["n=2", "SWITCH n", "CASE 1", "LIN unknown", "CASE 2,3", "LIN {X n}", "DEFAULT", "LIN unknown",
                  "ENDSWITCH"] for word in ("SWITCH", "CASE", "DEFAULT", "ENDSWITCH")},
        "RETURN": ["n=1", "IF n==2 THEN", "RETURN", "ENDIF"],
        "GOTO": ["GOTO there", "LIN unknown", "there:"],
        "TRIGGER": ["TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE", "LIN {X 3}"],
        "INTERRUPT": ["INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO n=3"],
        "ANIN": ["ANIN ON n=1*$ANIN[1]+0"],
        "ANOUT": ["ANOUT ON n=1*$VEL_ACT+0"],
        "SIGNAL": ["SIGNAL valve $OUT[1]"],
        "SPLINE": ["SPLINE", "SPL {X 3}", "SPL {X 6}", "ENDSPLINE"],
        "ENDSPLINE": ["SPLINE", "SLIN {X 3}", "ENDSPLINE"],
        "BAS": ["BAS(#VEL_CP, 0.2)", "LIN {X 3}"],
    }  # fmt: skip
    LEFT_OUT = {}
    ASKED = {word: (["n=1", f"{word}(n)", "LIN {X n}"], None) for word in krl.STATEMENTS.asked}
    STRANGE = "FROBNICATE n"


LANGUAGES = (Fanuc, Inform, Krl)


def words(group):
    return [(one, word) for one in LANGUAGES for word in getattr(one.STATEMENTS, group)]


def named(value):
    return value if isinstance(value, str) else value.__name__


@pytest.fixture
def read(tmp_path):
    def function(language, rows):
        sub = {
            ".ls": Fanuc.text(["IF AR[1]<>3,JMP LBL[1]", "L P[3] 9mm/sec FINE", "LBL[1]"]),
            ".jbi": Inform.text(["GETARG LB000 IARG#(1)", "MOVL P[LB000] V=9.0"]),
        }.get(language.SUFFIX)
        if sub:
            (tmp_path / f"SUB{language.SUFFIX.upper()}").write_text(sub)
        path = tmp_path / f"p{language.SUFFIX}"
        path.write_text(language.text(rows))
        module = {Fanuc: fanuc, Inform: inform, Krl: krl}[language]
        return module.read(path)

    return function


def said(program):
    return [
        (m.kind, None if m.pose is None else m.pose.tolist(), m.zone_mm) for m in program.motions
    ]


def test_every_word_has_its_example():
    for language in LANGUAGES:
        groups = language.STATEMENTS
        assert set(groups.followed) == set(language.FOLLOWED), language
        assert set(groups.left_out) == set(language.LEFT_OUT)
        every = [*groups.followed, *groups.ignored, *groups.asked, *groups.left_out]
        assert len(every) == len(set(every)), sorted(one for one in every if every.count(one) > 1)


@pytest.mark.parametrize("language, word", words("ignored"), ids=named)
def test_what_is_ignored_changes_nothing(read, language, word):
    first, second = language.MOVES
    plain = read(language, [first, second])
    program = read(language, [first, *language.ignored(word), second])
    assert said(program) == said(plain) and not program.problems and not program.asked


@pytest.mark.parametrize("language, word", words("followed"), ids=named)
def test_what_is_followed_is_no_problem(read, language, word):
    first, second = language.MOVES
    program = read(language, [first, *language.FOLLOWED[word], second])
    assert not program.problems and not program.lost, program.problems
    assert not any(m.kind == "GAP" for m in program.motions)
    assert said(program)[-1] == said(read(language, [first, second]))[-1]


@pytest.mark.parametrize("language, word", words("asked"), ids=named)
def test_what_is_asked_for_is_told_where_it_matters(read, language, word):
    first, second = language.MOVES
    rows, name = language.ASKED[word]
    program = read(language, [first, *rows, second])
    assert program.problems and any(m.kind == "GAP" for m in program.motions)
    assert name is None or name in program.asked


@pytest.mark.parametrize("language, word", words("left_out"), ids=named)
def test_what_is_left_out_is_told_at_its_line(read, language, word):
    first, second = language.MOVES
    rows = language.LEFT_OUT[word].split("\n")
    program = read(language, [first, *rows, second])
    lines = range(language.FIRST + 1, language.FIRST + 1 + len(rows))
    assert any(problem.line in lines for problem in program.problems), program.problems


@pytest.mark.parametrize("language", LANGUAGES, ids=named)
def test_a_word_of_no_group_is_told(read, language):
    first, second = language.MOVES
    program = read(language, [first, language.STRANGE, second])
    problem = program.problems[0]
    assert problem.line == language.FIRST + 1 and language.STRANGE in str(problem)
