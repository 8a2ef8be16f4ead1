"""Programs of any size, in each language many kinds: what reading them costs must grow in proportion."""

import gzip

POINT = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
# What a statement is made long with, over and over.
REPEATED = {
    "blanks": " ",
    "tabs": "\t ",
    "digits": "7",
    "letters": "a",
    "decimals": "1.5 ",
    "signs": "-",
    "points": ".",
    "quotes": '"',
    "opening": "(",
    "brackets": "[",
    "braces": "{",
    "nested": "([{",
    "closed": "()",
    "lists": "[1]",
    "sum": "+1",
    "commas": "1,",
    "equals": "a=",
    "words": "a ",
    "indices": "a[1]",
    "calls": "a(1,",
    "paths": "a.b",
    "coordinates": "X1Y2",
    "exponents": "1e5",
    "stars": "/*",
    "colons": ":",
    "hashes": "#",
    "backslashes": "\\x",
    "to": " TO ",
    "then": " THEN ",
    "with": " WITH ",
    "not": "NOT ",
}


class Language:
    """How the statements of a language stand in its file."""

    def __init__(self, suffix, head, tail, prefixes, beside=None):
        self.suffix, self.head, self.tail, self.prefixes = suffix, head, tail, prefixes
        self.beside = beside or {}

    def program(self, statements):
        """The files of a program with these lines, by suffix."""
        return {**self.beside, self.suffix: self.head + "\n".join(statements) + self.tail}


def _xml(text):
    return text.replace("&", "&amp;").replace("<", "&lt;")


VAL3_DATA = (
    "<Database><Datas>"
    '<Data name="t" type="tool" size="1"><Value key="0" fatherId="flange[0]"/></Data>'
    '<Data name="m" type="mdesc" size="1"><Value key="0" tmax="100"/></Data>'
    '<Data name="p" type="pointRx" size="1"><Value key="0" x="1" fatherId="world[0]"/></Data>'
    "</Datas></Database>"
)
LANGUAGES = {
    "krl": Language(
        ".src",
        "DEF a()\n",
        "\nEND\n",
        "PTP |LIN {X |FOR I=|FOR I=1 TO |IF |$VEL.CP=|a|b[|b(|SPLINE |DECL INT a|CIRC a,|BAS(#|"
        "LIN $NULLFRAME:{X 1} C_DIS |GLOBAL |WHILE |;",
    ),
    "rapid": Language(
        ".mod",
        "MODULE a\nPROC main()\n",
        ";\nENDPROC\nENDMODULE\n",
        f"MoveL |MoveL {POINT},v100,fine,tool0 |x:=|x{{|x.y|IF |IF TRUE |FOR i FROM 1 TO |WHILE |"
        "TEST |VAR num |CONST num a:=|GOTO |lbl:|b |VelSet |PDispSet |!|!%%%",
    ),
    "urscript": Language(
        ".script",
        "def a():\n",
        "\nend\n",
        "movel(|movel(p[|a=|a[|if |while |def b(|global |set_tcp(|#|return |x",
    ),
    "fanuc": Language(
        ".ls",
        "/PROG A\n/MN\n",
        " ;\n/POS\nP[1]{\nGP1:\nUF : 0, UT : 1, CONFIG : 'N',\nX = 1 mm, Y = 2 mm, Z = 3 mm,\n"
        "W = 0 deg, P = 0 deg, R = 0 deg\n};\n/END\n",
        "1: L P[1] |1: L P[|1: R[1]=|1: R[|1: IF |1: IF R[1]=1,|1: FOR R[1]=|1: SELECT R[1]=|"
        "1: JMP LBL[|1: CALL |1: UFRAME_NUM=|1: !|1: |1: C P[1] |",
    ),
    "inform": Language(
        ".jbi",
        "/JOB\n//NAME A\n//POS\n///NPOS 1,0,0,0,0,0\n///USER 1\n///POSTYPE USER\n"
        "C0000=1,2,3,0,0,0\n//INST\n",
        "\nEND\n",
        "MOVL C0000 |MOVL C|JUMP *|JUMP *a IF |SPEED V=|CALL JOB:|SET |IFTHEN |*|'|IMOV C0000 |",
    ),
    "gcode": Language(
        ".nc",
        "G21 G90\n",
        "\nM30\n",
        "G1 X|G1 X1 |G43.4 A3=|(|;|G2 |T=|T |N|#1=|G0 G|M|TRAORI |F ",
    ),
    "siemens": Language(
        ".mpf",
        "G71 G90\n",
        "\nM30\n",
        "G1 X=|R1=|IF |DEF REAL |TRANS X|AA:|L1(|FOR I=|GOTOF ",
    ),
    "klartext": Language(
        ".h",
        "BEGIN PGM A MM\n",
        "\nEND PGM A MM\n",
        "L X|L X+1 |L |Q1 = |CC X|CR X+1 R|CYCL DEF 7.1 X|CYCL DEF 200 Q200=|FN 9: IF |LBL |CALL LBL |TOOL CALL |PLANE SPATIAL SPA|"
        "APPR |LN X|;|* ",
    ),
    "kawasaki": Language(
        ".as",
        ".PROGRAM a()\n",
        "\n.END\n",
        "LMOVE |LMOVE TRANS(|JAPPRO a, |POINT a = |x = |x[|IF |FOR i = |FOR i = 1 TO |WHILE |CASE |CALL b(|SPEED |DRAW |TOOL |;|PRINT ",
    ),
    "apt": Language(
        ".apt",
        "UNITS/MM\n",
        "\nFINI\n",
        "GOTO/|GOTO/1,2,|FEDRAT/|CIRCLE/|MOVARC/|PPRINT |CYCLE/|MULTAX/|LOADTL/|$$|",
    ),
    "csv": Language(
        ".csv",
        "x_mm,y_mm,z_mm,a_deg,b_deg,c_deg\n",
        "\n",
        "1,2,3,4,5,|x|#|1;2|",
    ),
    "val3": Language(
        ".pgx",
        '<Programs><Program name="a"><Code>begin\n',
        "\nend</Code></Program></Programs>",
        "movel(p[0],t[0],|movel(p[|x=|x[|x.y|if(|for i=|for i=1 to |while(|switch |call b(|call |"
        "put(|//|",
        {".dtx": VAL3_DATA},
    ),
    "urp": Language(
        ".urp",
        "<URProgram><children><MainProgram><children><Script><cachedContents>",
        "</cachedContents></Script></children></MainProgram></children></URProgram>",
        "movel(|a=|if |#|global ",
    ),
}


def long_statement(language, prefix, piece, n):
    """A program with one statement of about ``n`` characters."""
    text = prefix + piece * (n // len(piece)) + "x"
    if language.suffix in (".pgx", ".urp"):
        text = _xml(text)
    return language.program([text])


def _numbered(text, k):
    return text.replace("{k}", str(k)).replace("{before}", str(k - 1))


def _repeat(language, lines):
    return lambda n: LANGUAGES[language].program(
        _numbered(line, k) for k in range(n) for line in lines
    )


def _around(language, begin, end, *inner):
    """Many blocks, one in the other as far as that is allowed, groups of them one after the other."""

    def program(n):
        group = [begin] * 15 + list(inner) + [end] * 15
        return LANGUAGES[language].program(group * (n // 30 + 1))

    return program


def _within(language, begin, end, *lines, rounds=50):
    """A loop of a fixed number of rounds around many lines."""

    def program(n):
        body = [_numbered(line, k) for k in range(n) for line in lines]
        return LANGUAGES[language].program([begin.replace("{rounds}", str(rounds)), *body, end])

    return program


LIN = "LIN {X 1,Y 2,Z 3,A 4,B 5,C 6}"
MOVE = f"MoveL {POINT},v100,fine,tool0;"
PLACE = "p[0,0,0,0,0,0]"


def _waypoints(inner, count=1):
    """A PolyScope program with many nodes."""

    def program(n):
        nodes = "".join(_numbered(inner, k) for k in range(n))
        return {
            ".urp": "<URProgram><children><MainProgram><children>" + nodes * count
            + "</children></MainProgram></children></URProgram>"
        }  # fmt: skip

    return program


WAYPOINT = '<Waypoint type="Fixed" name="w{k}"><position pose="0.1,0.2,0.3,0,0,0"/></Waypoint>'
MOVE_UR = '<Move motionType="MoveL" speed="0.1"><children>{}</children></Move>'
DATA = "<Database><Datas>{}</Datas></Database>"
PROGRAM = '<Programs><Program name="a"><Code>begin\nmovej(p[0],t[0],m[0])\nend</Code></Program></Programs>'


def _data(text, between=""):
    return lambda n: {
        ".pgx": PROGRAM,
        ".dtx": DATA.format(between.join(_numbered(text, k) for k in range(n))),
    }


def _sizes(n):
    """Arrays of many dimensions."""
    size = "9999999," * n + "1"
    return {".pgx": PROGRAM, ".dtx": DATA.format(f'<Data name="p" type="pointRx" size="{size}"/>')}


def _nested_scripts(n):
    return {
        ".script": "def a():\n"
        + "".join(f"  def b{k}():\n    c()\n  end\n" for k in range(n))
        + "end\n"
    }


def _jumping(n):
    body = "".join(f"GOTO l{k};\nl{k}:\n" for k in range(n))
    return LANGUAGES["rapid"].program([body + MOVE[:-1]])


def _choosing(n):
    text = ["1: SELECT R[1]=1,JMP LBL[1] ;"] * n
    return LANGUAGES["fanuc"].program([*text, "2: LBL[1]"])


def _continued(n):
    return LANGUAGES["fanuc"].program(["1: L P[1]", *[": x"] * n])


def _doubled_constants(n):
    """Each constant holds the one before twice."""
    lines = "".join(f"CONST c c{k}:=[c{k - 1},c{k - 1}];\n" for k in range(1, n))
    return {
        ".mod": f"MODULE a\nCONST c c0:=[1,2];\n{lines}PROC main()\n{MOVE}\nENDPROC\nENDMODULE\n"
    }


def _doubled_records(n):
    lines = "".join(f"RECORD r{k}\nr{k - 1} a;\nr{k - 1} b;\nENDRECORD\n" for k in range(1, n))
    return {
        ".mod": f"MODULE a\nRECORD r0\nnum a;\nENDRECORD\n{lines}VAR r{n - 1} x;\n"
        f"PROC main()\n{MOVE}\nENDPROC\nENDMODULE\n"
    }


def _unfinished_literals(n):
    """Brackets in each other, and what is no number after many numbers."""
    text = "[" * (n // 4) + "1," * n + "x" + "]" * (n // 4)
    return LANGUAGES["rapid"].program([f"x:={text};", MOVE[:-1]])


def _huge_attribute(n):
    """A tag that does not end for long, packed."""
    text = '<URProgram a="' + "x" * n + '"/>'
    return {".urp": gzip.compress(text.encode(), 1)}


def _huge_comment(n):
    return {".urp": "<URProgram><!--" + "x" * n + "--></URProgram>"}


# {name: function of a size that gives a program's files by suffix}
MANY = {
    "krl motions": _repeat("krl", [LIN]),
    "krl variables": _repeat("krl", ["V{k}={k}", "P{k}={X V{k},Y 0,Z 0,A 0,B 0,C 0}", "LIN P{k}"]),
    "krl elements": _repeat("krl", ["V[{k}]={k}"]),
    "krl comments": _repeat("krl", ['; FOLD {k} "x']),
    "krl not understood": _repeat("krl", ["LIM {k}"]),
    "krl routines": _repeat("krl", ["b{k}()", "END", "DEF b{k}()", LIN]),
    "krl blocks": _around("krl", "IF TRUE THEN", "ENDIF", LIN),
    "krl blocks at run time": _around("krl", "IF $IN[1] THEN", "ENDIF", LIN, "V=1"),
    "krl loops": _around("krl", "LOOP", "ENDLOOP", LIN),
    "krl open blocks": _repeat("krl", ["IF TRUE THEN", "ENDIF", "IF $IN[1] THEN"]),
    "krl in a loop": _within("krl", "FOR I=1 TO {rounds}", "ENDFOR", "IF TRUE THEN", "ENDIF"),
    "krl forgotten": _within(
        "krl", "FOR I=1 TO 3", "ENDFOR", "IF $IN[{k}] THEN", "V[{k}]=1", "ENDIF"
    ),
    "krl unclosed": lambda n: LANGUAGES["krl"].program(
        [f"FOR I=1 TO {n}", *["IF TRUE THEN"] * n, "ENDFOR"]
    ),
    "krl components": _repeat("krl", ["$TOOL.C{k}={k}", LIN]),
    "rapid motions": _repeat("rapid", [MOVE]),
    "rapid variables": _repeat("rapid", ["VAR num v{k}:={k};", "v{k}:=v{k}+1;"]),
    "rapid labels": _jumping,
    "rapid constants": _doubled_constants,
    "rapid records": _doubled_records,
    "rapid literals": _unfinished_literals,
    "rapid comments": _repeat("rapid", ['! "{k}']),
    "rapid blocks": _around("rapid", "IF TRUE THEN", "ENDIF", MOVE),
    "rapid branches": _within(
        "rapid", "FOR i FROM 1 TO 20 DO IF FALSE THEN", "ENDIF ENDFOR", "ELSEIF FALSE THEN"
    ),
    "rapid left out": _around("rapid", "IF di=1 THEN", "ENDIF", MOVE, "x:=1;"),
    "urscript motions": _repeat("urscript", [f"movel({PLACE})"]),
    "urscript variables": _repeat("urscript", ["v{k}={k}", "w{k}=v{k}+1"]),
    "urscript routines": _nested_scripts,
    "urscript elements": _within("urscript", "a=[" + "0," * 500 + "0]", "", "a[{k} % 500]={k}"),
    "urscript branches": _within("urscript", "if False:", "end", "elif False:"),
    "urscript left out": _around("urscript", "if b(1):", "end", f"movel({PLACE})", "x=1"),
    "fanuc motions": _repeat("fanuc", ["{k}: L P[1] 100mm/sec FINE ;"]),
    "fanuc labels": _repeat(
        "fanuc", ["{k}: LBL[{k}] ;", "{k}: R[{k}]=1 ;", "{k}: JMP LBL[{k}9] ;"]
    ),
    "fanuc selections": _choosing,
    "fanuc continued": _continued,
    "fanuc decided at run time": _repeat(
        "fanuc", ["1: IF DI[1]=ON THEN ;", "2: R[1]=1 ;", "3: ENDIF ;"]
    ),
    "fanuc calls": _repeat("fanuc", ["{k}: CALL B{k} ;"]),
    "inform motions": _repeat("inform", ["MOVL C0000 V=100.0"]),
    "inform labels": _repeat("inform", ["*L{k}", "JUMP *L{k}9"]),
    "inform blocks": _around("inform", "IFTHEN IN#(1)=ON", "ENDIF", "MOVL C0000 V=100.0"),
    "inform open blocks": _repeat("inform", ["JUMP *M{k}", "IFTHEN IN#(1)=ON", "*M{k}"]),
    "gcode motions": _repeat("gcode", ["G1 X{k} Y2 Z3 F100"]),
    "gcode comments": _repeat("gcode", ["((((((({k}) x"]),
    "gcode unknown": _repeat("gcode", ["G777 X{k}"]),
    "gcode undecided": _repeat("gcode", ["IF [#1 EQ 1] GOTO {k}", "N{k} X1"]),
    "siemens motions": _repeat("siemens", ["G1 X={k} Y=AC({k}) Z3"]),
    "siemens values": _repeat("siemens", ["R1={k}", "X=R1+{k}"]),
    "siemens branches": _around("siemens", "IF R1==1", "ENDIF", "X1"),
    "siemens jumps": _repeat("siemens", ["IF R9>1 GOTOF NO", "A{k}A: X{k}"]),
    "siemens calls": _repeat("siemens", ["L{k}"]),
    "klartext motions": _repeat("klartext", ["L X+{k} Y+2 F100"]),
    "klartext values": _repeat("klartext", ["Q1 = Q1 + {k}", "L X+Q1"]),
    "klartext corners": _repeat("klartext", ["L X+{k} Y+2 F100", "RND R1"]),
    "klartext labels": _repeat("klartext", ["LBL {k}", "CALL LBL {k}0000000"]),
    "klartext joined": _repeat("klartext", ["CYCL DEF 200 ~"]),
    "klartext unknown": _repeat("klartext", ["FOO X{k}"]),
    "kawasaki motions": _repeat("kawasaki", ["LMOVE TRANS({k}, 2, 3, 0, 0, 0)"]),
    "kawasaki variables": _repeat("kawasaki", ["v{k} = {k}", "w{k} = v{k} + 1"]),
    "kawasaki blocks": _around("kawasaki", "IF 1 > 0 THEN", "END", "DRAW 1, 0, 0"),
    "kawasaki left out": _around("kawasaki", "IF SIG(1) THEN", "END", "DRAW 1, 0, 0", "x = 1"),
    "kawasaki jumps": _repeat("kawasaki", ["IF SIG(1) GOTO {k}", "{k} DRAW 1, 0, 0"]),
    "kawasaki unknown": _repeat("kawasaki", ["FOO{k}"]),
    "apt motions": _repeat("apt", ["GOTO/{k},2,3"]),
    "apt comments": _repeat("apt", ["$$ {k}"]),
    "apt continued": _repeat("apt", ["GOTO/1,$", "2,3"]),
    "csv rows": _repeat("csv", ["{k},2,3,4,5,6"]),
    "csv comments": _repeat("csv", ['# "{k}']),
    "val3 motions": _repeat("val3", ["movel(p[0],t[0],m[0])"]),
    "val3 variables": _repeat("val3", ["v{k}={k}", "w{k}=v{k}+1"]),
    "val3 calls": _repeat("val3", ["call b{k}()"]),
    "val3 blocks": _around("val3", "if(true)", "endIf", "movel(p[0],t[0],m[0])"),
    "val3 branches": _within("val3", "if(false)", "endIf", "elseIf(false)"),
    "val3 left out": _around("val3", "if(diIn)", "endIf", "movel(p[0],t[0],m[0])", "x=1"),
    "val3 points": _data('<Data name="p{k}" type="pointRx" size="1"><Value key="0" x="1"/></Data>'),
    "val3 frames": _data(
        '<Data name="f{k}" type="frame" size="1"><Value key="0" x="1" fatherId="f{before}[0]"/></Data>'
    ),
    "val3 sizes": _sizes,
    "urp waypoints": _waypoints(MOVE_UR.format(WAYPOINT)),
    "urp one move": lambda n: _waypoints(
        MOVE_UR.format("".join(_numbered(WAYPOINT, k) for k in range(n)))
    )(1),
    "urp scripts": _waypoints(
        "<Script><cachedContents>movel(p[0,0,0,0,0,0])</cachedContents></Script>"
    ),
    "urp left out": _waypoints(
        '<If type="If"><expression/><children>' + WAYPOINT + "</children></If>"
    ),
    "urp looped": lambda n: _waypoints(
        '<Loop type="Counting" count="20"><children>'
        + ("<Script><cachedContents>a=1\nb=2\n</cachedContents></Script><Comment/>") * n
        + "</children></Loop>"
    )(1),
    "urp attribute": lambda n: _huge_attribute(10 * n),
    "urp comment": lambda n: _huge_comment(10 * n),
}
