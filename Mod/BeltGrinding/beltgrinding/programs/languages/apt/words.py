"""The words of APT that the reader knows: units, statements without motion, statements that move unseen."""

import re

INCH = 25.4  # mm
NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eEdD][-+]?\d+)?")
MINUTE, SECOND = 60.0, 1.0
# Word of a FEDRAT: (mm of its length, None: the file's unit; seconds, None: per revolution)
FEED_UNITS = {
    "MMPM": (1.0, MINUTE),
    "MMPS": (1.0, SECOND),
    "MMPR": (1.0, None),
    "MPM": (1000.0, MINUTE),
    "IPM": (INCH, MINUTE),
    "IPS": (INCH, SECOND),
    "IPR": (INCH, None),
    "FPM": (12.0 * INCH, MINUTE),
    "FPR": (12.0 * INCH, None),
    "PERMIN": (None, MINUTE),
    "PERREV": (None, None),
}
LENGTHS = {  # words of UNITS: mm
    **dict.fromkeys(
        ("MM", "MILLIMETER", "MILLIMETERS", "MILLIMETRE", "MILLIMETRES", "METRIC"), 1.0
    ),
    **dict.fromkeys(("IN", "INCH", "INCHES", "ENGLISH", "IMPERIAL"), INCH),
    **dict.fromkeys(("CM", "CENTIMETER", "CENTIMETERS", "CENTIMETRE", "CENTIMETRES"), 10.0),
    **dict.fromkeys(("M", "METER", "METERS", "METRE", "METRES"), 1000.0),
    **dict.fromkeys(("FT", "FOOT", "FEET"), 12.0 * INCH),
}
# Statements whose rest is text.
TEXT = tuple("PARTNO PPRINT TPRINT LPRINT REMARK INSERT LETTER DISPLAY DISPLY TITLES".split())
TEXT += ("TOOL PATH", "END-OF-PATH", "OPFEATSTART", "OPFEATEND")
# Statements without motion.
HARMLESS = set(
    "CUTTER SPINDL COOLNT TLCOMP CUTCOM LOADTL LOAD SELECT TLDATA MSYS PAINT DELAY DWELL SEQNO WPLANE "
    "FINI END MACHIN TOOLNO INTOL OUTTOL TOLER OPSKIP OPSTOP STOP PIVOT HEAD MODE PREFUN AUXFUN "
    "ROTHED CLEARP CLRSRF RETURN THICK MULTAX UNITS UNIT RAPID FEDRAT LINTOL GOUGCK PLUNGE MODULE "
    "CUTANG ENDSUB CATEGORY SAFETY INSIST RESET CLAMP AIR ARCSLP BREAK CHECK CONTRL DEBUG GEAR "
    "LEADER MAXDPM MAXVEL MCHTOL NOPOST OFSTNO OVPLOT PBS PITCH PLABEL PLOT POSTN PPFUN PRINT PUNCH "
    "REWIND SELCTL SLOWDN TMARK TRNTYP TURRET VERIFY SWITCH SETUP MOVE_ATTRIB TCP "
    "CSI_SET_FLUTE_LENGTH CSI_SET_EXTENSION_LENGTH TLAXIS AUTOPS PSIS INDIRV INDIRP TLON GOFWD".split()
)
# Of a block that INSERT passes on; not the X of "12MM X 60DEG".
AXIS_WORD = re.compile(rf"(?<![A-Z])[XYZABCUVW]\s*=?\s*{NUMBER.pattern}(?![\d.]|[A-Z]{{2}})")
REMARK = re.compile(r"\[|[A-Za-z][a-z]")  # what INSERT hands on is then a text, no block
MOVING = set("GOHOME HOME CALLSUB CALL COPY INDEX".split())
SHIFTING = set("TRACUT ROTATE ROTABL ORIGIN TRANS CSYS".split())
# Statements that are run elsewhere or several times, by the word they begin with: up to another.
BLOCKS = {"MACRO": "TERMAC", "LOOPST": "LOOPND"}
