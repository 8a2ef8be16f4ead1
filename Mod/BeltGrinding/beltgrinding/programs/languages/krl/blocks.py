"""The blocks of a KRL routine: where each ends, its labels, what it declares, found once."""

from __future__ import annotations

import re
from typing import Any

from ....base.kinds import known
from ...program import ProgramError, work_of
from .data_lists import Rows
from .modules import Home
from ..core.tree import MAX_NESTING, Node
from .types import declaration

MOTIONS = (
    "PTP_REL LIN_REL CIRC_REL SPTP_REL SLIN_REL SCIRC_REL SPL_REL SPTP SLIN SCIRC SPL PTP LIN CIRC"
).split()
MOTION = re.compile(rf"^({'|'.join(MOTIONS)})\b\s*(.*)$", re.IGNORECASE)
# A target: a name, components, indices with those of another variable in them.
PATH = r"\$?[A-Za-z_][\w$]*(?:\s*\.\s*\w+|\s*\[(?:[^\[\]]|\[[^\[\]]*\])*\])*"
ASSIGN = re.compile(
    rf"^(?:(?:GLOBAL|DECL|CONST)\s+)*(?:\w+\s+)?(?P<path>{PATH})\s*=(?!=)(?P<value>.*)$",
    re.IGNORECASE,
)
CALL = re.compile(r"^([A-Za-z_]\w*)\s*\((.*)\)$")
LABEL = re.compile(r"^([A-Za-z_]\w*)\s*:(?!=)\s*$")
GOTO = re.compile(r"^GOTO\s+([A-Za-z_]\w*)$", re.IGNORECASE)
HEAD = re.compile(
    r"(?:GLOBAL\s+)?DEF(?:FCT\s+(?P<kind>\w+)(?:\s*\[,*\])?)?\s+\w+\s*\((?P<parameters>.*)\)",
    re.IGNORECASE,
)
PARAMETER = re.compile(r"([A-Za-z_]\w*)\s*(?:\[[,\s]*\]\s*)?(?::\s*(IN|OUT))?", re.IGNORECASE)
OPENING = {
    "for": "endfor",
    "if": "endif",
    "while": "endwhile",
    "loop": "endloop",
    "repeat": "until",
    "switch": "endswitch",
}
CLOSED = {end: word for word, end in OPENING.items()}
LOOPS = ("for", "while", "loop", "repeat")
PARTS = {"else": "if", "case": "switch", "default": "switch"}
LEAVING = ("exit", "return", "goto")
WORD = re.compile(r"\$?\w+")
# What is called without a file here, moves nothing and changes no variable of the program.
HARMLESS = set(
    "bas msgquit ir_stopm varstate msgnotify msgstate msgdialog msgctrl msgloop msgbreak cwrite cclose swrite "
    "pulse ackmsg set_kruser clear_kruser exists_msg exists_dialog".split()
)
# Functions and procedures of the system that move nothing; what they are passed may be changed.
SYSTEM = set(
    "cread sread copen cioctl strcopy stradd strclear strdeclen strlen strfind strcomp strtoint inv_pos inverse "
    "forward frand krl_fopen krl_fclose krl_fputs krl_fscanf krl_fgets cast_to cast_from eof toframe get_sig_inf "
    "getcycdef getvar setvar timer_limit delete_backward_buffer err_raise err_clear sync "
    "eb ek lk eo svel_cp svel_joint sacc_cp sacc_joint sgear_jerk sjerk sapo sapo_ptp sori_typ stool2 sbase "
    "sipo_mode sload use_cm_pro_values".split()
)


WORDS = {*OPENING, *CLOSED, *PARTS, *LEAVING, "wait", "halt"}
NOT_MOVING = HARMLESS | SYSTEM | WORDS


def word_of(text: str) -> str:
    """The first word of a statement in lower case."""
    match = WORD.match(text)
    return match.group(0).lower() if match else ""


class Block(Node):
    """A statement, or a block with what it encloses, at ``at`` to before ``end`` in its Routine."""

    __slots__ = ("routine", "at", "end")
    routine: Routine
    at: int
    end: int


class Routine:
    """``statements``: (line, text). ``closing``: the place of a block's end by that of its beginning,
    ``around``: the place of the block's beginning around each statement (-1: none), ``labels``: places by name. A
    word is closed by its own end, whatever blocks of other words lie across. ``head``: the DEF line; of it ``parameters``: (name, whether
    a value only is passed); None where it is not understood. ``own``: the names of its own variables.
    """

    def __init__(self, statements: Rows, head: str = "", home: Home | None = None) -> None:
        self.home = home  # where it stands
        self.statements = statements
        self.closing: dict[int, int] = {}
        self.labels: dict[str, int] = {}
        self.around: list[int] = []
        match = HEAD.match(head)
        self.kind = (match["kind"] or "").lower() if match else ""  # of what it returns
        self.parameters = _parameters(match["parameters"]) if match else []
        self.kinds: dict[str, str] = {}  # of what it declares
        self._moves = [0]  # statements that move the robot, or may, before each place
        self._work = [0]  # units of work, likewise
        open_at: dict[str, list[int]] = {word: [] for word in OPENING}
        around: list[int] = []
        for at, (_, text) in enumerate(statements):
            word = word_of(text)
            if word in CLOSED and open_at[CLOSED[word]]:
                begin = open_at[CLOSED[word]].pop()
                self.closing[begin] = at
                while around and around[-1] >= begin:
                    around.pop()
            self.around.append(around[-1] if around else -1)
            if word in OPENING:
                open_at[word].append(at)
                around.append(at)
            label = LABEL.match(text)
            if label:
                self.labels.setdefault(label.group(1).lower(), at)
            found = declaration(text)
            if found:
                self.kinds.update(dict.fromkeys(found[1], found[0]))
            self._moves.append(self._moves[-1] + may_move(text))
            self._work.append(self._work[-1] + work_of(text))
        self._blocks: list[Node] | None = None
        self.own = frozenset(self.kinds) | {name for name, _ in self.parameters or ()}

    @property
    def blocks(self) -> list[Node]:
        """The outermost Blocks."""
        if self._blocks is None:
            self._blocks = self._grown(0, len(self.statements), 0)
        return self._blocks

    def _grown(self, at: int, end: int, depth: int) -> list[Node]:
        found: list[Node] = []
        while at < end:
            line, text = self.statements[at]
            word, label = word_of(text), LABEL.match(text) if text.endswith(":") else None
            node = Block(line, "label" if label else word, label[1].lower() if label else text)
            node.routine, node.at, node.end = self, at, at + 1
            if word in OPENING:
                last = self.closing.get(at, end)
                node.closed = last < end
                node.end = last + 1 if node.closed else end
                if depth >= MAX_NESTING:
                    raise ProgramError.at(
                        known(self.home).file,
                        line,
                        "programs.nested_blocks",
                        "blocks are nested too deeply",
                    )
                if node.closed:
                    node.body = self._grown(at + 1, last, depth + 1)
                if word == "repeat" and node.closed:
                    node.text = self.statements[last][1][5:]
            found.append(node)
            at = node.end
        return found

    def moves(self, begin: int, end: int) -> bool:
        """Whether a statement from ``begin`` to before ``end`` moves the robot, or may."""
        return self._moves[end] > self._moves[begin]

    def work(self, begin: int, end: int) -> int:
        """Units of work from ``begin`` to before ``end``."""
        return self._work[end] - self._work[begin]


def may_move(text: str) -> bool:
    """Whether a statement moves the robot, or calls what may."""
    if MOTION.match(text):
        return True
    call = CALL.match(text)
    return call is not None and call.group(1).lower() not in NOT_MOVING


def _parameters(text: str) -> list[tuple[str, bool]] | None:
    found: list[tuple[str, bool]] = []
    for part in text.split(",") if text.strip() else ():
        one = PARAMETER.fullmatch(part.strip())
        if one is None:
            return None
        found.append((one.group(1).lower(), (one.group(2) or "").lower() == "in"))
    return found
