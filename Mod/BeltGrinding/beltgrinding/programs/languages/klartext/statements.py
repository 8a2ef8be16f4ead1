"""What statements of Klartext other than motions set: tools, frames, cycles, M functions."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ....base.kinds import Floats, known
from ...program import Fact, Unknown
from .expression import NOT_KNOWN
from .moves import VALUE, Moves
from .placement import TILTED

# Statements that change neither the path nor a value, by how they begin.
IGNORED = (
    "BLK FORM",
    "TOOL DEF",
    "STOP",
    *(f"FN {n}" for n in (14, 15, 16, 19, 20, 26, 27, 28, 29, 37, 38)),
    *(f"SEL {what}" for what in ("TABLE", "PATTERN", "CONTOUR", "PGM")),
    "PATTERN DEF",
    "CONTOUR DEF",
    "DECLARE",
    *(
        f"FUNCTION {what}"
        for what in ("DWELL", "MODE MILL", "FEED", "S-PULSE", "PARAXCOMP", "COUNT", "LIFTOFF")
    ),
    "*",
)
NO_MOTION = re.compile(
    "|".join(
        rf"{re.escape(word)}\b".replace(r"FN\ ", r"FN\s*").replace(r"\*\b", r"\*")
        for word in IGNORED
    )
)
SET = re.compile(rf"(?<![A-Z])(I?)([XYZABCUVW])\s*({VALUE})")
CYCLE = re.compile(r"CYCL DEF\s*(\d+)(?:\.(\d+))?\s*(.*)")
FOLLOWED_CYCLES = (7, 10, 247)
# Cycles that set something harmless, or what CYCL CALL does.
OF_FRAMES = {7: "datum", 8: "cycle 8", 10: "rotation", 11: "cycle 11", 19: "plane", 26: "cycle 26"}
DEFINED = {
    *range(1, 7),
    9,
    12,
    13,
    14,
    17,
    18,
    *range(20, 26),
    32,
    *range(200, 220),
    225,
    230,
    231,
    232,
    233,
}
DEFINED |= {*range(240, 247), *range(251, 280), 291, 292, 332}
# M functions without a motion, which change nothing of the path that is read here.
PLAIN = {
    0,
    1,
    3,
    4,
    5,
    6,
    7,
    8,
    9,
    *range(10, 30),
    *range(40, 80),
    90,
    93,
    94,
    97,
    98,
    101,
    102,
    103,
}
PLAIN |= {
    107,
    108,
    109,
    110,
    111,
    112,
    113,
    116,
    117,
    118,
    119,
    120,
    124,
    126,
    127,
    131,
    132,
    133,
    134,
    135,
}
PLAIN |= {138, 141, 142, 143, 148, 149, 150}
MACHINE = {91, 92, 130, 140}  # go to the machine's coordinates
OF_STATE = (2, 30, 128, 129, 136, 137)
CALLING = (89, 99)  # a cycle


class Statements(Moves):
    """Follows statements that do not move."""

    def lose(self, line: int, text: str) -> None:
        """Nothing is known any more after a statement that is not understood."""
        self.parameters.all.clear()
        self.at = [None] * 3
        self.rotary = dict.fromkeys(self.rotary)
        self.vector, self.stance, self.feed = None, "", None
        self.tcpm = self.tcpm and "unknown"
        self.pole = self.polar = self.tangent = self.before = None
        self.base = f"{self.base.split(' after')[0]} after line {line}".strip()

    def functions(self, line: int, numbers: Iterable[int], given: Mapping[str, Any]) -> bool:
        """The M functions of a block; False at the program's end. Raises Unknown."""
        for number in numbers:
            if number == 128:
                self.tcpm = "angles"
            elif number == 129:
                self.tcpm = None
            elif number in (136, 137):
                self.per_turn, self.feed = number == 136, None
            elif number == 89:
                self.cycle_everywhere = True
            elif number == 99:
                self.cycle_everywhere = False
            elif number in (114, 115):
                self.tcpm = "unknown" if number == 114 else None
            elif number not in PLAIN and number not in (2, 30, *MACHINE):
                self.once(
                    ("M", number),
                    line,
                    "programs.klartext.m_function",
                    "M{number} is not known here; it is taken to move nothing",
                    number=number,
                )
        if given.get("COMP") in ("RL", "RR"):
            self.once(
                given["COMP"],
                line,
                "programs.klartext.compensation",
                "{word}: the control shifts the path by the tool's radius; taken unshifted",
                word=given["COMP"],
            )
        return not {2, 30} & {*numbers}

    def tool_call(self, line: int, text: str) -> None:
        """TOOL CALL: the tool, its axis, its feed. Raises Unknown."""
        match = re.match(
            rf"\s*(\"[^\"]*\"|{VALUE}|'[^']*')?\s*([XYZ](?![\w+-]))?", text[len("TOOL CALL") :]
        )
        assert match is not None  # each part may be missing
        rest = text[len("TOOL CALL") + match.end() :]
        if match[1]:
            name = match[1].strip("\"'")
            self.tool = f"T{name}" if name[:1] != "Q" else f"T of line {line}"
            self.of_tool = None
        if match[2]:
            self.shifted.pop("axis", None)
            if match[2] != "Z":
                self.shifted["axis"] = Fact(
                    "programs.klartext.tool_axis", "the tool's axis is {axis}, not Z", axis=match[2]
                )
        words = dict(re.findall(rf"\s*(S|F|DL|DR2|DR)\s*({VALUE})", rest))
        if re.sub(rf"\s*(?:S|F|DL|DR2|DR)\s*{VALUE}", "", rest).strip():
            self.tool = f"T of line {line}"
            raise Unknown(
                "programs.cannot_be_parsed", "cannot read '{text}'", text=rest.strip()[:30]
            )
        if "F" in words:
            self.of_tool = self.feed = None
            self.of_tool = self.feed = self.feed_of(line, self.parameters.value(words["F"]))
        for word in ("DL", "DR"):
            if word in words and self.parameters.value(words[word]):
                self.once(
                    word,
                    line,
                    "programs.klartext.oversize",
                    "{word}: the control shifts the path by it; taken unshifted",
                    word=word,
                )

    # Frames

    def axes(self, text: str) -> dict[int, tuple[float, bool]] | None:
        """{axis: (mm, whether an increment)} of a datum shift; None: it is not known."""
        found, rest = {}, SET.sub("", text)
        for more, letter, value in SET.findall(text):
            number = self.parameters.value(value)
            if letter not in "XYZ":
                if number:
                    return None
                continue
            found["XYZ".index(letter)] = (self.scale * number, bool(more))
        return None if re.search(r"[\w#]", rest) else found

    def cycle(self, line: int, text: str) -> None:
        """A CYCL DEF. Raises Unknown."""
        match = CYCLE.match(text)
        if not match:
            raise Unknown("programs.klartext.cycle", "the cycle is not known here")
        number, part, rest = int(match[1]), match[2], match[3]
        for name, value in re.findall(r"(Q\d+)\s*=\s*([^;~]*)", rest):
            self.parameters.assign(f"{name} = {value}")
        if number in OF_FRAMES:
            if part != "0":
                self.frame_cycle(line, number, text, rest.strip())
        elif number == 247:
            found = re.search(r"Q339\s*=\s*([-+]?\d+)(?![\d.,])", rest)
            self.preset(found[1] if found else None, line)
        elif number not in DEFINED:
            self.at = [None] * 3
            raise Unknown("programs.klartext.cycle", "the cycle is not known here")

    def frame_cycle(self, line: int, number: int, text: str, rest: str) -> None:
        """A line with values of cycle 7, 8, 10, 11, 19 or 26."""
        change: Callable[[], None] | None = None
        try:
            if number == 7:
                values = None if "#" in rest else self.axes(rest)
                change = (lambda: self.placement.shifted(known(values))) if values else None
            elif number == 10 and (found := re.match(rf"(I?)ROT\s*({VALUE})$", rest)):
                angle, more = self.parameters.value(found[2]), bool(found[1])
                change = lambda: self.placement.turned(angle, more)  # noqa: E731
            elif number == 11 and (found := re.match(rf"SCL\s*({VALUE})$", rest)):
                change = (lambda: None) if self.parameters.value(found[1]) == 1.0 else None
            elif number in (8, 26) and not rest:
                change = lambda: None  # noqa: E731
            elif number == 19 and re.fullmatch(rf"(?:[ABC]\s*{VALUE}\s*)*", rest):
                words = re.findall(rf"[ABC]\s*({VALUE})", rest)
                if not any(map(self.parameters.value, words)):
                    change = lambda: self.tilt(None, "STAY")  # noqa: E731
        except Unknown:
            change = None
        self.frame_set(line, OF_FRAMES[number], text, change)

    def frame_set(self, line: int, what: str, text: str, change: Callable[[], None] | None) -> None:
        """Changes the placement by ``change()``; None: how is not known, and motions are left out."""
        if change is not None:
            change()
        if change is not None and what != "datum":  # of which each axis counts
            self.placement.why.pop(what, None)
        elif change is None:
            why = Fact(
                "programs.klartext.frame",
                "'{text}' in line {begun} sets a frame that is not known here",
                text=text[:30],
                begun=line,
            )
            if what == "datum":
                self.placement.lose(what, why)
            self.placement.why.setdefault(what, why)
        self.placed()

    def datum(self, line: int, text: str) -> None:
        """TRANS DATUM AXIS with words, TRANS DATUM RESET. Raises Unknown for others."""
        kind, _, rest = text[len("TRANS DATUM") :].strip().partition(" ")
        if kind not in ("RESET", "AXIS"):
            raise Unknown("programs.cannot_be_parsed", "cannot read '{text}'", text=text[:30])
        rest = rest.strip() if kind == "AXIS" else "X0 Y0 Z0"
        self.frame_cycle(line, 7, rest, rest)

    def preset(self, name: str | None, line: int) -> None:
        self.base = f"preset {int(name)}" if name else f"preset of line {line}"
        self.placement.shift, self.placement.angle = [0.0] * 3, 0.0
        for what in ("datum", "order", "rotation", "cycle 8", "cycle 11", "cycle 26"):
            self.placement.why.pop(what, None)
        self.placement.open = set()
        if self.placement.plane is not None:
            self.placement.lose(
                "order",
                Fact(
                    "programs.klartext.preset_in_plane",
                    "a preset in a tilted plane is not followed",
                ),
            )
        self.placed()
        self.at = [None] * 3

    def tilt(self, rotation: Floats | None, how: str) -> None:
        self.placement.tilted(rotation)
        self.vector = None
        if how == "STAY":
            turned = any(v is None or v for v in self.rotary.values()) or self.stance
            self.stance = "unknown" if rotation is not None or turned else ""
        else:
            self.stance = "" if rotation is None else "plane"
            self.rotary = {} if rotation is None else dict.fromkeys("ABC")
        self.at = [None] * 3

    def plane(self, line: int, text: str) -> None:
        """PLANE with the words of ``placement.TILTED``, and RESET; another is a Problem."""
        how = re.search(r"\b(STAY|MOVE|TURN)\b", text)
        if text.startswith("PLANE RESET"):
            self.frame_set(line, "plane", text, lambda: self.tilt(None, how[1] if how else "STAY"))
            return
        kind = text.split()[1:2]
        names, rotation_of = TILTED.get(kind[0] if kind else "", ((), None))
        written = (
            dict(re.findall(rf"(?<!\w)({'|'.join(names)})\s*({VALUE})", text)) if names else {}
        )
        relative = bool(kind) and kind[0] == "RELATIV"
        rotation: Floats | None = None
        if how and rotation_of and (len(written) == (1 if relative else len(names))):
            try:
                values = {name: self.parameters.value(value) for name, value in written.items()}
                rotation = rotation_of(*(values.get(name, 0.0) for name in names))
                if relative:
                    rotation = self.placement.within(rotation)
            except Unknown:
                rotation = None
        if rotation is None:
            self.frame_set(line, "plane", text, None)
            self.stance = "unknown"
            return
        self.frame_set(line, "plane", text, lambda: self.tilt(rotation, known(how)[1]))

    def function(self, line: int, text: str) -> None:
        """FUNCTION TCPM and its end. Raises Unknown for others."""
        if re.match(r"FUNCTION RESET TCPM", text):
            self.tcpm = None
            return
        match = re.match(r"FUNCTION TCPM\b(.*)", text)
        if not match:
            raise Unknown("programs.klartext.function", "the function is not known here")
        rest = match[1]
        self.tcpm = "unknown"
        axes = re.search(r"AXIS\s+(POS|SPAT)", rest)
        point = re.search(r"REFPNT\s+(\S+)", rest)
        if axes and re.search(r"\bF\s+TCP\b", rest) and (not point or point[1] == "TIP-TIP"):
            self.tcpm = "angles" if axes[1] == "POS" else "spatial"

    def assignment(self, line: int, text: str) -> None:
        """Q parameters; whoever uses one that is not known says so."""
        if not self.parameters.assign(text) and not re.match(r"FN\s*18\s*:", text):
            name = re.search(r"Q\w*", text)
            raise Unknown(*NOT_KNOWN, name=name[0] if name else text[:30])
