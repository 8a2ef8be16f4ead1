"""Reads Fanuc TP programs as text (.ls): /MN statements and /POS positions.

Poses are those of the tool frame UT in the user frame UF; W, P, R turn about the fixed X, Y, Z
(Rz(R) Ry(P) Rx(W)). What only the controller can know is a Problem.
"""

import re

import numpy as np

from ....base.frames import to_abc
from ....base.stopping import check
from ...program import LOOPED, MAX_UNROLLED, SKIPPED, Fact, Motion, ProgramError, Unknown, work_of
from ..taught import DIGITS, lines_in, pose_of
from . import localized
from .positions import positions_of
from .registers import INDEX, Registers

MAX_CONTINUED = 200  # lines of one statement
KINDS = {"J": "PTP", "L": "LIN", "C": "CIRC", "A": "A", "S": "SPL"}
MOTION = re.compile(rf"([JLCAS])\s+(PR|P)\s*{INDEX}\s*(.*)$")
TARGET = re.compile(rf"\s*(PR|P)\s*{INDEX}\s*(.*)$")
SPEED = re.compile(
    rf"({DIGITS}|R{INDEX})\s*(mm/sec|cm/min|inch/min|deg/sec|msec|sec|%)(?=\s|$)\s*(.*)$"
)
MM_PER_S = {"mm/sec": 1.0, "cm/min": 10.0 / 60.0, "inch/min": 25.4 / 60.0}
SECONDS = {"sec": 1.0, "msec": 1e-3}
# Options that move the target, or end the motion before it.
SHIFTS = re.compile(r"\b(Tool_Offset|Offset|VOFFSET|Search|TrackPR|Skip|VR\[)", re.IGNORECASE)
OFFSET = re.compile(
    r"\b(Tool_Offset|Offset)\s*,\s*PR\s*\[([^\[\]]*(?:\[[^\[\]]*\])?[^\[\]]*)\]", re.IGNORECASE
)
HARMLESS = re.compile(
    r"(DO|DI|RO|RI|GO|GI|AO|AI|SO|UO|UI|WO|WI|F|M|SR|AR|TIMER|PAYLOAD|OVERRIDE|WAIT|PAUSE|MESSAGE|"
    r"UALM|LOCK|UNLOCK|COL|RSR|MONITOR|JOINT_MAX_SPEED|LINEAR_MAX_SPEED|TC_ONLINE|STOP_TRACKING|"
    r"PULSE|ERROR_PROG|RESUME_PROG|MAINT_PROG|CLEAR_RESUME_PROG|STRLEN|\$\w+|WELD|ARC|PREG)\b",
    re.IGNORECASE,
)
JUMP = re.compile(rf"JMP\s+LBL\s*{INDEX}$")
FOR = re.compile(r"FOR\s+R\[([^\[\]]*)\]\s*=\s*(\S.*?)\s(TO|DOWNTO)\s+(.+)$")
THEN = re.compile(r"IF(.*)\bTHEN$")
COMMA = re.compile(r"IF((?:[^,\[(]|\[[^\]]*\]|\((?:[^()]|\([^()]*\))*\))*),(.*)$")


def zeither(rest):
    """mm by the termination type in a motion's additions: FINE stops; CD is the distance from the
    corner, CR its radius (the same where the path turns by 90 degrees); CNT is a share of the speed
    and no length, so its zone is not known, of CNT0 neither: nearly a stop without being one.
    """
    match = re.search(r"\b(?:(FINE)|C[DR]\s*(\d{1,4}))(?=\s|$)", rest)
    if not match:
        return None
    return 0.0 if match.group(1) else float(match.group(2))


def read(path, values=None):
    """The Program of a .ls file; ``values``: as Registers takes them. Raises ProgramError when it cannot be read."""
    reader = _Reader(path, values)
    reader.load(lines_in(path, "TP"))
    reader.follow()
    reader.close_arc()
    return reader.program


class _Reader(Registers):
    """Follows a TP program from top to bottom with the registers it can know."""

    def __init__(self, path, values=None):
        super().__init__("Fanuc TP", path, values)
        self.set_here = {}  # line in which the program sets a position register, by its number
        self.statements = []  # (line, text, whether it ended)
        self.continued = 0  # lines of the last one after its first
        self.rounds = 0  # units of work; below 0: what the file allows
        self.work = [0]  # of the statements before each
        self.positions = {}
        self.uframe = self.utool = None
        self.here = None  # (components, base) of the current pose, None: unknown
        self.missing = set()

    def error(self, line, code, text, /, **arguments):
        return ProgramError.at(self.file, line, code, text, **arguments)

    # The file

    def load(self, lines):
        """Splits the file into statements and positions."""
        section, begin, ended = "", None, False
        self.words = localized.english if localized.is_german(lines) else str
        for number, text in enumerate(lines, 1):
            head = text.strip()
            mark = re.match(r"/(?:PROG|ATTR|APPL|MN|POS|END)\b", head)
            if mark:
                section = mark.group(0)
                if section == "/END":
                    ended = True
                    break
                begin = number if section == "/POS" else begin
            elif section == "/MN" and head:
                self.line_of_mn(number, head)
        if not self.statements and begin is None:
            raise ProgramError(
                "programs.fanuc.no_tp",
                "{file}: is no TP program (it has neither /MN nor /POS)",
                file=self.file,
            )
        if self.statements and not self.statements[-1][2]:
            self.unended(self.statements[-1])
        if not ended:
            self.problem(
                len(lines), "programs.fanuc.no_end", "the file ends without /END; it may be cut"
            )
        if begin is not None:
            end = number - 1 if ended else len(lines)
            self.positions = positions_of(lines[begin:end], begin + 1, self.file, self.problem)

    def line_of_mn(self, number, head):
        match = re.match(r"(\d*)\s*:(.*)$", head)
        if not match:
            if head.strip("-; "):
                self.problem(
                    number,
                    "programs.fanuc.no_statement",
                    "'{text}' is no statement; it is left out",
                    text=head[:40],
                )
                self.statements.append((number, "?", True))
            return
        text = self.words(match.group(2).strip())
        ended = text.endswith(";")
        text = text[:-1].rstrip() if ended else text
        if not match.group(1) and self.statements and not self.statements[-1][2]:
            line, before, _ = self.statements[-1]
            self.continued += 1
            if self.continued > MAX_CONTINUED:
                raise self.error(
                    line, "programs.fanuc.endless_statement", "the statement does not end"
                )
            self.statements[-1] = (line, f"{before} {text}", ended)
            return
        self.continued = 0
        if self.statements and not self.statements[-1][2]:
            self.unended(self.statements[-1])
        self.statements.append((number, text, ended))

    def unended(self, statement):
        if not statement[1].startswith(("!", "/", "-")):
            raise self.error(
                statement[0], "programs.fanuc.no_semicolon", "the statement does not end with ';'"
            )

    # The statements

    def follow(self):
        """Executes the statements; every label is passed once in each state of the registers."""
        labels, closing, opened, ifs = {}, {}, [], []
        self.ends, self.elses = {}, {}
        for k, (line, text, _) in enumerate(self.statements):
            match = re.match(rf"LBL\s*{INDEX}", text)
            if match and re.match(r"\d+", match.group(1)):
                labels.setdefault(int(re.match(r"\d{1,6}", match.group(1)).group(0)), k)
            if re.match(r"FOR\b", text):
                opened.append(k)
            elif text == "ENDFOR" and opened:
                closing[opened.pop()] = k
            if re.match(r"IF\b.*\bTHEN$", text):
                ifs.append([k])
            elif text == "ELSE" and ifs:
                self.elses[ifs[-1][0]] = k
                ifs[-1].append(k)
            elif text == "ENDIF" and ifs:
                self.ends.update(dict.fromkeys(ifs.pop(), k))
        self.labels, self.closing, self.loops = labels, closing, {}
        self.opening = {end: begin for begin, end in closing.items()}
        jumps = {
            int(n) for s in self.statements for n in re.findall(r"JMP\s+LBL\[(\d{1,6})\b", s[1])
        }
        targets = {k for n, k in labels.items() if n in jumps}
        for _, text, _ in self.statements:
            self.work.append(self.work[-1] + work_of(text))
        self.rounds = -LOOPED * (self.work[-1] + 5 * len(self.positions))
        seen, at = set(), 0
        while at is not None and at < len(self.statements):
            line, text, _ = self.statements[at]
            self.tick(line, work_of(text))
            if at in targets:
                self.tick(line, len(self.registers) // 10)
                state = (at, frozenset(self.registers.items()))
                if state in seen:
                    self.problem(
                        line, "programs.endless", "an endless {word} is followed once", word="loop"
                    )
                    return
                seen.add(state)
            try:
                at = self.statement(at, line, text)
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

    def tick(self, line, work):
        check()
        self.rounds += work
        if self.rounds > MAX_UNROLLED:
            raise self.error(
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )

    def statement(self, at, line, text):
        """Executes one statement; the index of the next, None at the end."""
        match = MOTION.match(text)
        if match:
            self.motion(line, *match.groups())
            return at + 1
        if not text or text.startswith(("!", "//", "--", "LBL", "ENDIF")):
            return at + 1
        word = re.match(r"\w*", text).group(0)
        if word in ("IF", "SELECT", "ELSE", "JMP", "FOR", "ENDFOR"):
            return getattr(self, f"do_{word.lower()}")(at, line, text)
        if word in ("END", "ABORT"):
            return None
        match = re.match(rf"(UFRAME_NUM|UTOOL_NUM|R{INDEX})(?:\[[^\]]*\])?\s*=\s*(.*)$", text)
        if match:
            self.assign(line, match.group(1), match.group(3))
        elif word in ("CALL", "RUN"):
            self.call(line, text)
        elif word in ("UFRAME", "UTOOL"):
            self.problem(
                line,
                "programs.fanuc.frame_at_run_time",
                "a frame is set at run time; poses stay those in it",
            )
        elif re.match(r"P\s*\[|[A-Z]\s+PR?\s*\[", text) or text == "?":
            if text != "?":
                self.problem(
                    line,
                    "programs.fanuc.left_out",
                    "'{text}' is not understood; it is left out",
                    text=text[:40],
                )
            self.here = None
            self.gap(line)
        elif re.match(r"PR\s*\[", text):
            self.sets_position(line, text)
        elif not HARMLESS.match(text):
            self.problem(
                line,
                "programs.ignored",
                "'{text}' is not understood; it is ignored",
                text=text[:40],
            )
        return at + 1

    def assign(self, line, name, text):
        try:
            value = self.number(text)
        except Unknown as unknown:
            value = None
            if name.startswith("U"):
                self.problem(
                    line,
                    "programs.fanuc.frame_unknown",
                    "{name} is not known: {reason}; each position tells its own",
                    name=name,
                    reason=unknown.fact,
                )
        if name == "UFRAME_NUM":
            self.uframe = None if value is None else int(value)
        elif name == "UTOOL_NUM":
            self.utool = None if value is None else int(value)
        else:
            self.forget([(0, f"{name}=", True)])
            if value is not None:
                try:
                    self.registers[self.index(name[2:-1])] = value
                except Unknown:
                    self.registers.clear()

    def call(self, line, text):
        name = re.sub(r"^(CALL|RUN)\s*", "", text).split("(")[0].strip()
        if name not in self.missing:
            self.missing.add(name)
            self.problem(
                line,
                "programs.not_in_file",
                "{name} is not in this file; motions in it are left out",
                name=name,
            )
        # It may move the robot, change registers and select frames.
        self.here = self.uframe = self.utool = None
        self.registers.clear()
        self.gap(line)

    def forget(self, statements):
        """What statements assign that may or may not run is unknown afterwards."""
        for line, text, _ in statements:
            for found in re.findall(rf"\bR{INDEX}\s*=", text):
                try:
                    self.registers.pop(self.index(found), None)
                except Unknown:
                    self.registers.clear()
            if re.search(r"\bPR\s*\[[^\]]*\]\s*=", text):
                self.sets_position(line, text)
            if "CALL" in text or "RUN" in text:
                self.registers.clear()
            if "_NUM" in text:
                self.uframe = self.utool = None

    def leave_out(self, line, begin, end, message):
        """Passes over statements that may or may not run."""
        if begin < end:
            self.tick(line, (self.work[end] - self.work[begin]) // SKIPPED)
        body = self.statements[begin:end]
        self.forget(body)
        if any(MOTION.match(text) for _, text, _ in body):
            self.problem(
                line,
                "programs.fanuc.motions_left_out",
                "{what}; motions up to line {last} left out",
                what=message,
                last=self.statements[end - 1][0],
            )
            self.here = None
            self.gap(line)
        return end

    def do_if(self, at, line, text):
        then, split = THEN.match(text), COMMA.match(text)
        if not then and (not split or split.group(2).lstrip().startswith("IF")):
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        end = self.after_if(at) if then else at + 1
        try:
            known = self.condition((then or split).group(1))
        except Unknown as unknown:
            if then:
                return self.leave_out(
                    line,
                    at + 1,
                    end,
                    Fact(
                        "programs.at_run_time",
                        "{word} is decided at run time ({reason})",
                        reason=unknown.fact,
                        word="IF",
                    ),
                )
            return self.maybe(at, line, [split.group(2).strip()])
        if then:
            return at + 1 if known else self.after_if(at, "ELSE")
        return self.statement(at, line, split.group(2).strip()) if known else at + 1

    def after_if(self, at, stop="ENDIF"):
        """Index after the ENDIF (or ELSE) of the IF or ELSE at ``at``."""
        end = self.ends.get(at, len(self.statements) - 1)
        return (self.elses.get(at, end) if stop == "ELSE" else end) + 1

    def do_else(self, at, line, text):
        return at + 1 if text != "ELSE" else self.after_if(at)

    def do_select(self, at, line, text):
        branches = [text]
        for k in range(at + 1, len(self.statements)):
            other = self.statements[k][1]
            if not re.match(r"=|ELSE,", other):
                break
            self.tick(line, work_of(other))
            branches.append(other)
        actions = [branch.partition(",")[2].strip() for branch in branches]
        return max(self.maybe(at, line, actions), at + len(branches))

    def maybe(self, at, line, actions):
        """Actions of which none or one runs: what a jump passes over is left out."""
        furthest = at + 1
        for action in actions:
            match = JUMP.match(action)
            if match:
                target = self.labels.get(self.index(match.group(1)), -1)
                furthest = max(furthest, target)
                if target <= at:
                    self.problem(
                        line,
                        "programs.jump_back",
                        "a jump back is decided at run time; it is followed once",
                    )
            elif action.startswith(("CALL", "RUN")):
                self.call(line, action)
            else:
                self.forget([(line, action, True)])
                if MOTION.match(action):
                    raise Unknown("programs.fanuc.at_run_time", "it is decided at run time")
        return self.leave_out(
            line,
            at + 1,
            furthest,
            Fact("programs.jump_at_run_time", "a jump is decided at run time"),
        )

    def do_jmp(self, at, line, text):
        match = JUMP.match(text)
        try:
            return self.labels[self.index(match.group(1))]
        except (AttributeError, KeyError, Unknown):
            self.problem(
                line,
                "programs.leads_nowhere",
                "'{text}' leads nowhere known; what follows is left out",
                text=text,
            )
            return None

    def do_for(self, at, line, text):
        match, end = FOR.match(text), self.closing.get(at)
        if end is None:
            raise Unknown("programs.fanuc.no_endfor", "FOR has no ENDFOR")
        try:
            if not match:
                raise Unknown("programs.it_is_not_understood", "it is not understood")
            n, first, last = self.index(match[1]), self.number(match[2]), self.number(match[4])
        except Unknown as unknown:
            return self.leave_out(
                line,
                at + 1,
                end + 1,
                Fact(
                    "programs.fanuc.no_static_bounds",
                    "FOR has no static bounds ({reason})",
                    reason=unknown.fact,
                ),
            )
        step = 1 if match[3] == "TO" else -1
        self.registers[n] = first
        self.loops[at] = [n, last, step]
        return at + 1 if step * (last - first) >= 0 else end + 1

    def do_endfor(self, at, line, text):
        begin = self.opening.get(at)
        if begin not in self.loops:
            return at + 1
        n, last, step = self.loops[begin]
        if n not in self.registers:
            self.problem(
                line,
                "programs.fanuc.counter",
                "the counter R[{n}] is changed in its loop; it is followed once",
                n=n,
            )
        elif step * (last - self.registers[n]) >= 1:
            self.registers[n] += step
            return begin + 1
        del self.loops[begin]
        return at + 1

    # The motions

    def motion(self, line, kind, register, index, rest):
        targets = [(register, index)]
        if kind == "C":
            match = TARGET.match(rest)
            if not match:
                raise Unknown("programs.fanuc.no_end_point", "its end point is missing")
            targets.append(match.groups()[:2])
            rest = match.group(3)
        shift, rest = self.offset(kind, rest)
        if SHIFTS.search(rest):
            raise Unknown(
                "programs.known_at_run_time",
                "what {word} does is known at run time only",
                word=SHIFTS.search(rest).group(1),
            )
        motions = [
            self.target(line, KINDS[kind], *target, re.search(r"\bINC\b", rest))
            for target in targets
        ]
        if shift is not None:
            motions = [(m, self.shifted(m, shift)) for m, _ in motions]
        before = self.here
        for motion, components in motions:
            motion.aux = motion is not motions[-1][0]
            self.here = components and (components, motion.base)
        if motions[-1][0].kind != "PTP":
            speed = self.speed(line, kind, rest, before)
            for motion, _ in motions:
                motion.speed_mm_s = speed
        for motion, _ in motions:
            motion.zone_mm = zeither(rest)
        for motion, _ in motions:
            (self.add_arc_point if kind == "A" else self.add)(motion)

    def target(self, line, kind, register, index, incremental):
        """(Motion, components) of one position. Raises Unknown."""
        n = self.index(index)
        if register == "PR":
            position = (self.position_register(n), None, None)
        else:
            position = self.positions.get(n)
        if position is None:
            raise Unknown("programs.fanuc.not_in_pos", "P[{n}] is not in /POS", n=n)
        if isinstance(position, str):
            raise Unknown(position)
        components, uf, ut = position
        names = []
        for what, own, current in (("UFRAME", uf, self.uframe), ("UTOOL", ut, self.utool)):
            if None not in (own, current) and own != current:
                raise Unknown(
                    "programs.fanuc.other_frame",
                    "P[{n}] is taught in {what} {own}, selected is {what} {current}",
                    n=n,
                    what=what,
                    own=own,
                    current=current,
                )
            own = current if own is None else own
            names.append("" if own is None else f"{what} {own}")
        motion = Motion(kind, None, line, self.file, tool=names[1], base=names[0])
        if components is None:
            if kind != "PTP":
                raise Unknown("programs.fanuc.joint_position", "P[{n}] is a joint position", n=n)
            return motion, None
        if incremental:
            if self.here is None or self.here[1] != motion.base or any(components[3:]):
                raise Unknown(
                    "programs.fanuc.inc", "INC adds to a pose that is not known, or turns"
                )
            components = [*np.add(self.here[0][:3], components[:3]), *self.here[0][3:]]
        motion.pose = pose_of(components)
        return motion, components

    def position_register(self, n):
        """X, Y, Z, W, P, R of PR[n] as a person gives it. Raises Unknown."""
        if n in self.set_here or None in self.set_here:
            raise Unknown(
                "programs.fanuc.register_set",
                "PR[{n}] is set by the program, in line {line}, which is not followed",
                n=n,
                line=self.set_here.get(n, self.set_here.get(None)),
            )
        six = self.ask(f"PR[{n}]", "frame")
        if not isinstance(six, tuple):
            raise Unknown(
                "programs.fanuc.position_register",
                "PR[{index}] is a position register of the controller",
                index=n,
            )
        x, y, z, a, b, c = six
        return [x, y, z, c, b, a]

    def sets_position(self, line, text):
        """What a statement makes of a position register only the controller knows."""
        for found in re.findall(rf"PR\s*\[\s*([^\],]*)[^\]]*\]\s*=", text) or [""]:
            try:
                n = self.index(found.strip())
            except Unknown:
                n = None  # any of them
            self.set_here.setdefault(n, line)

    def offset(self, kind, rest):
        """((which side, 4 x 4) of Offset,PR[n] or Tool_Offset,PR[n], the rest without it), or (None, rest).
        Raises Unknown."""
        found = OFFSET.findall(rest)
        if len(found) != 1:
            return None, rest
        if kind in "CA" or re.search(r"\bINC\b", rest):
            raise Unknown(
                "programs.fanuc.offset_of_arc",
                "what an offset does to an arc, or with INC, is not known here",
            )
        side, index = found[0]
        return (side.lower(), pose_of(self.position_register(self.index(index)))), OFFSET.sub(
            " ", rest
        )

    def shifted(self, motion, shift):
        """Moves a Motion by an offset; its new components."""
        side, frame = shift
        if motion.pose is None:
            raise Unknown("programs.fanuc.offset_of_joints", "an offset moves a joint position")
        motion.pose = motion.pose @ frame if side == "tool_offset" else frame @ motion.pose
        a, b, c = to_abc(motion.pose)
        return [*motion.pose[:3, 3].tolist(), c, b, a]

    def speed(self, line, kind, rest, before):
        """mm/s of a path motion, None (and a Problem) when it is not known."""
        match = SPEED.match(rest)
        try:
            if not match:
                raise Unknown(
                    "programs.fanuc.names_no_speed", "'{text}' names none", text=rest[:30]
                )
            value, unit = self.number(match.group(1)), match.group(3)
            if value <= 0.0:
                raise Unknown("programs.not_positive", "it is not positive")
            if unit in MM_PER_S:
                return value * MM_PER_S[unit]
            length = 0.0
            if unit in SECONDS and kind == "L" and before and self.here[1] == before[1]:
                length = float(np.linalg.norm(np.subtract(self.here[0][:3], before[0][:3])))
            if length == 0.0:
                raise Unknown(
                    "programs.fanuc.no_path_speed",
                    "{text}{unit} tells no path speed",
                    text=match.group(1),
                    unit=unit,
                )
            if value < 1e-6:
                raise Unknown(
                    "programs.fanuc.short_time",
                    "{text}{unit} is too short a time",
                    text=match.group(1),
                    unit=unit,
                )
            return length / (value * SECONDS[unit])
        except Unknown as unknown:
            self.problem(
                line,
                "programs.path_speed_unknown",
                "the path speed is not known: {reason}",
                reason=unknown.fact,
            )
            return None
