"""Reads Yaskawa (Motoman) INFORM jobs (.jbi): //POS positions and //INST instructions.

Poses are those of the tool TOOL n in the frame of their ///POSTYPE; Rx, Ry, Rz turn about the fixed
X, Y, Z (Rz(Rz) Ry(Ry) Rx(Rx)). What only the controller can know is a Problem.

V= has the unit that the controller's parameter for the speed of linear motions selects; the job file
does not tell it. Post-processors in use write mm/s with one decimal (V=100.0) and warn that the
controller may be set to cm/min instead. By INFORM's manuals mm/s goes in steps of 0.1, cm/min in
whole numbers: V= with a decimal point is read as mm/s, without one as unknown.
"""

import re

import numpy as np

from ....base.stopping import check
from ...program import MAX_UNROLLED, Fact, Motion, ProgramError, Reason, Unknown, work_of
from ..taught import NUMBER, TaughtPath, lines_in, pose_of
from .positions import positions_of

MOVE = re.compile(r"(MOV[JLCS]|IMOV)(?=\s|$)\s*(.*)$")
MOVING = re.compile(r"[+S]?MOV[JLCS]\b|IMOV\b|CALL\b")
KINDS = {"MOVJ": "PTP", "MOVL": "LIN", "MOVS": "SPL"}
POSITION = re.compile(r"(C|P)(\d{1,6})(?=\s|$)\s*(.*)$", re.ASCII)
OTHER = re.compile(r"(?:BC|EC|BP|EX)\d{1,6}(?=\s|$)", re.ASCII)
SPEED = re.compile(r"(?:^|\s)(V|VR|VE)=(\S*)")
SHIFTED = re.compile(r"\b(SRCH|UNTIL)\b")
# What changes a position variable: the instruction's first operand.
CHANGES = re.compile(
    r"(?:SET|SETE|GETS|GETPOS|GETE|ADD|SUB|MUL|DIV|INC|DEC|CNVRT|MULMAT|INVMAT|MFRAME)\s+"
    r"(?:L?P|PX)(\d+)"
)
HARMLESS = re.compile(
    r"(NOP|DOUT|DIN|AOUT|ARATION|ARATIOF|WAIT|TIMER|PAUSE|SET|SETE|ADD|SUB|MUL|DIV|INC|DEC|GETE|GETS|"
    r"GETPOS|CNVRT|MULMAT|INVMAT|AND|OR|NOT|XOR|MSG|CLS|PULSE|SKILLSND|TSYNC|CLEAR|ARCON|ARCOF|"
    r"ARCSET|SVSPOT|GUNCHG|WVON|WVOF|ADVINIT|ADVSTOP|REFP|PSTART|PWAIT|ABORT|ACC|HSEN|CNVSET|"
    r"SETREG|GETREG|LATCH|VSTART|DIALOG|STRING)\b"
)
BLOCKS = {
    "IFTHEN": "ENDIF",
    "IFTHENEXP": "ENDIF",
    "WHILE": "ENDWHILE",
    "WHILEEXP": "ENDWHILE",
    "FOR": "NEXT",
    "SWITCH": "ENDSWITCH",
    "SFTON": "SFTOF",
}


def zeither(rest):
    """mm by a motion's tags: PL=0 stops; CR is a corner radius in mm (exact where the path turns by
    90 degrees); the other position levels are parameters of the controller, so not known.
    """
    match = re.search(r"(?:^|\s)(?:(PL=0(?:\.0*)?)|CR=(\d{1,5}(?:\.\d{0,6})?))(?=\s|$)", rest)
    if not match:
        return None
    return 0.0 if match.group(1) else float(match.group(2))


def read(path):
    """The Program of a .jbi file. Raises ProgramError when it cannot be read."""
    reader = _Reader(path)
    reader.load(lines_in(path, "INFORM"))
    reader.follow()
    reader.close_arc()
    return reader.program


class _Reader(TaughtPath):
    """Follows a job from top to bottom."""

    def __init__(self, path):
        super().__init__("Yaskawa INFORM", path)
        self.statements = []  # (line, text)
        self.positions = self.variables = {}
        self.speed_set = None  # by SPEED, mm/s
        self.here = None  # (components, base) of the current pose, None: unknown
        self.noted = set()

    def note_once(self, line, code, text, /, **arguments):
        fact = Fact(code, text, **arguments)
        if fact not in self.noted:
            self.noted.add(fact)
            self.problem(line, fact)

    def load(self, lines):
        """Splits the file into positions and instructions."""
        first = next((k for k, text in enumerate(lines) if text.strip()), 0)
        if not lines[first].strip().upper().startswith("/JOB"):
            raise ProgramError.at(
                self.file,
                first + 1,
                "programs.inform.no_job",
                "is no INFORM job (it begins without /JOB)",
            )
        section, positions, ended = "", [], False
        for number, text in enumerate(lines, 1):
            text = text.strip()
            head = re.match(r"//(\w+)", text)
            if head:
                section = head.group(1)
            elif section == "POS" and text:
                positions.append((number, text))
            elif section == "INST" and text and not text.startswith("/"):
                self.statements.append((number, text))
                ended = text == "END"
                if ended:
                    break
        if not ended:
            # A line cut off in a number looks like a whole one.
            raise ProgramError.at(
                self.file,
                len(lines),
                "programs.inform.cut",
                "the job is cut, its END is missing; transfer it again",
            )
        self.positions = positions_of(positions, self.file, self.problem)
        self.variables = {n: p for (letter, n), p in self.positions.items() if letter == "P"}

    def follow(self):
        labels = {}
        for k, (_, text) in enumerate(self.statements):
            if text.startswith("*"):
                labels.setdefault(text.split()[0][1:], k)
        at, jumped = 0, set()
        rounds = -sum(work_of(text) for _, text in self.statements)
        while at is not None and at < len(self.statements):
            line, text = self.statements[at]
            check()
            rounds += work_of(text)
            if rounds > MAX_UNROLLED:
                raise ProgramError.at(
                    self.file,
                    line,
                    "programs.too_long",
                    "the program is too long or does not end; split it, or shorten its loops",
                )
            word = re.match(r"\w*", text).group(0)
            if word == "JUMP":
                if at in jumped:  # nothing is known that could have changed meanwhile
                    self.problem(
                        line, "programs.endless", "an endless {word} is followed once", word="loop"
                    )
                    return
                jumped.add(at)
                at = self.jump(at, line, text, labels)
                continue
            if word in BLOCKS:
                at = self.block(at, line, word)
                continue
            if word in ("END", "RET") and " IF" not in text:
                return
            try:
                self.statement(line, text, word)
            except Unknown as unknown:
                self.problem(
                    line,
                    "programs.left_out",
                    "{what} is left out: {reason}",
                    what=text[:30],
                    reason=unknown.fact,
                )
                self.here = None
                self.gap(line)
            at += 1

    def jump(self, at, line, text, labels):
        match = re.match(r"JUMP\s+\*(\S+)\s*(IF\b.*)?$", text)
        target = labels.get(match.group(1)) if match else None
        if target is None:
            self.problem(
                line,
                "programs.leads_nowhere",
                "'{text}' leads nowhere known; what follows is left out",
                text=text,
            )
            return None
        if not match.group(2):
            if target > at:
                return target
            self.problem(
                line, "programs.endless", "an endless {word} is followed once", word="loop"
            )
            return None
        if target <= at:
            self.problem(
                line,
                "programs.jump_back",
                "a jump back is decided at run time; it is followed once",
            )
            return at + 1
        return self.leave_out(
            line, at + 1, target, Fact("programs.jump_at_run_time", "a jump is decided at run time")
        )

    def block(self, at, line, word):
        """Passes over a block that only the controller knows how often to run."""
        depth = 0
        same = {w for w, end in BLOCKS.items() if end == BLOCKS[word]}
        for k in range(at, len(self.statements)):
            other = re.match(r"\w*", self.statements[k][1]).group(0)
            depth += (other in same) - (other == BLOCKS[word])
            if depth == 0:
                break
        else:
            self.problem(
                line,
                "programs.inform.no_block_end",
                "{word} has no {end}; what follows is left out",
                word=word,
                end=BLOCKS[word],
            )
            self.gap(line)
            return None
        return self.leave_out(
            line,
            at + 1,
            k + 1,
            Fact(
                "programs.known_at_run_time",
                "what {word} does is known at run time only",
                word=word,
            ),
        )

    def leave_out(self, line, begin, end, message):
        body = self.statements[begin:end]
        for _, text in body:
            self.change(text)
        if any(MOVING.match(text) for _, text in body):
            self.problem(
                line,
                "programs.inform.motions_left_out",
                "{what}; motions up to line {last} are left out",
                what=message,
                last=body[-1][0],
            )
            self.here = None
            self.gap(line)
        return end

    def change(self, text):
        """A position variable set at run time is unknown from here on."""
        match = CHANGES.match(text)
        if match:
            self.variables.pop(int(match.group(1)[:6]), None)
        elif text.startswith("CALL"):
            self.variables.clear()
        elif text.startswith("SPEED"):
            self.speed_set = None

    def statement(self, line, text, word):
        match = MOVE.match(text)
        if match:
            self.move(line, *match.groups())
            return
        if text.startswith(("'", "*")) or word in ("END", "RET", "LABEL"):
            return
        self.change(text)
        if word == "CALL":
            name = re.sub(r"^CALL\s*(JOB:)?", "", text).split(" ")[0]
            self.note_once(
                line,
                "programs.inform.job_elsewhere",
                "job {name} is not in this file; motions in it are left out",
                name=name,
            )
            self.here = None
            self.gap(line)
        elif word == "SPEED":
            self.speed_set = self.speed(line, text[5:])
        elif text.startswith("+"):
            self.note_once(
                line,
                "programs.inform.second_robot",
                "motions of a second robot or station (+MOV) are ignored",
            )
        elif re.match(r"\w*MOV", text) or word in ("SMOVL", "SMOVC", "SMOVJ"):
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        elif word == "MSHIFT" or not HARMLESS.match(text):
            self.problem(
                line,
                "programs.ignored",
                "'{text}' is not understood; it is ignored",
                text=text[:40],
            )

    def move(self, line, kind, rest):
        match = POSITION.match(rest)
        if not match:
            raise Unknown("programs.inform.position_elsewhere", "its position is not in this file")
        letter, n, rest = match.group(1), int(match.group(2)), match.group(3)
        position = self.positions.get((letter, n)) if letter == "C" else self.variables.get(n)
        if position is None:
            raise Unknown(
                "programs.inform.no_value",
                "{letter}{number} has no value that this file gives",
                letter=letter,
                number=match.group(2),
            )
        components, base, tool = position
        if isinstance(components, Reason):
            raise Unknown(
                "programs.inform.position_unknown",
                "{letter}{number} {reason}",
                letter=letter,
                number=match.group(2),
                reason=components.fact,
            )
        shifted = SHIFTED.search(rest)
        if shifted:
            raise Unknown(
                "programs.known_at_run_time",
                "what {word} does is known at run time only",
                word=shifted.group(1),
            )
        simple = KINDS.get(kind, "LIN")
        if kind == "IMOV":
            components, base = self.step(components, rest)
        motion = Motion(simple, pose_of(components), line, self.file, tool=tool, base=base)
        motion.zone_mm = zeither(rest)
        if kind != "MOVJ":
            motion.speed_mm_s = self.speed(line, OTHER.sub("", rest))
        self.here = (components, base)
        if kind != "MOVC":
            self.add(motion)
            return
        self.add_arc_point(motion)
        if re.search(r"\bFPT\b", rest):  # the point at which one arc ends and the next begins
            self.close_arc()
            self.continue_arc(motion)

    def step(self, components, rest):
        """(components, base) after an IMOV from the current pose. Raises Unknown."""
        frame = re.search(r"(?:^|\s)(BF|RF|TF|UF#\((\d+)\))(?:\s|$)", rest)
        if self.here is None or not frame or any(components[3:]):
            raise Unknown(
                "programs.inform.imov", "IMOV adds to a pose or frame that is not known, or turns"
            )
        here, base = self.here
        if frame.group(1) == "TF":
            moved = pose_of(here)[:3] @ [*components[:3], 1.0]
        elif base == {"BF": "BASE", "RF": "ROBOT"}.get(frame.group(1), f"USER {frame.group(2)}"):
            moved = np.add(here[:3], components[:3])
        else:
            raise Unknown(
                "programs.inform.imov_frame",
                "IMOV is along {frame}, the pose is in {base}",
                frame=frame.group(1),
                base=base or Fact("programs.inform.no_frame", "no frame"),
            )
        return [*moved, *here[3:]], base

    def speed(self, line, rest):
        """mm/s of a path motion, None (and a Problem) when it is not known."""
        match = SPEED.search(rest)
        if not match:
            if re.search(r"VJ=", rest):
                return None
            if self.speed_set is None:
                self.problem(
                    line,
                    "programs.inform.no_speed",
                    "the path speed is not known: neither V= nor SPEED gives it",
                )
            return self.speed_set
        name, text = match.groups()
        if name != "V":
            self.problem(
                line,
                "programs.inform.no_path_speed",
                "the path speed is not known: {name}= is no path speed",
                name=name,
            )
        elif not re.fullmatch(NUMBER, text, re.ASCII):
            self.problem(
                line,
                "programs.inform.speed_no_number",
                "the path speed is not known: V={text} is no number",
                text=text[:20],
            )
        elif "." not in text:
            self.note_once(
                line,
                "programs.inform.speed_unit",
                "V= without a decimal point may be mm/s or cm/min; such speeds are not known",
            )
        elif not 0.0 < float(text) < 1e5:
            self.problem(
                line,
                "programs.inform.speed_out_of_range",
                "the path speed V={text} is out of range",
                text=text[:20],
            )
        else:
            return float(text)
        return None
