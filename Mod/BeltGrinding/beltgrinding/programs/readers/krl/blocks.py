"""The blocks of a KRL routine: where each ends, found once."""

import re

from ...program import work_of

MOTION = re.compile(
    r"^(PTP_REL|LIN_REL|CIRC_REL|SPTP_REL|SLIN_REL|SPTP|SLIN|SCIRC|SPL|PTP|LIN|CIRC)\b\s*(.*)$",
    re.IGNORECASE,
)
OPENING = {
    "for": "endfor",
    "if": "endif",
    "while": "endwhile",
    "loop": "endloop",
    "repeat": "until",
    "switch": "endswitch",
}
CLOSED = {end: word for word, end in OPENING.items()}
WORD = re.compile(r"\w+")


def word_of(text):
    """The first word of a statement in lower case."""
    match = WORD.match(text)
    return match.group(0).lower() if match else ""


class Routine:
    """``statements``: (line, text). ``closing``: the place of a block's end by that of its beginning,
    ``elses``: the place of its ELSE by that of an IF. A word is closed by its own end, whatever blocks
    of other words lie across.
    """

    def __init__(self, statements):
        self.statements, self.closing, self.elses = statements, {}, {}
        self._moves = [0]  # statements that move the robot, before each place
        self._work = [0]  # units of work, likewise
        open_at = {word: [] for word in OPENING}
        for at, (_, text) in enumerate(statements):
            word = word_of(text)
            if word in OPENING:
                open_at[word].append(at)
            elif word in CLOSED and open_at[CLOSED[word]]:
                self.closing[open_at[CLOSED[word]].pop()] = at
            elif word == "else" and open_at["if"]:
                self.elses[open_at["if"][-1]] = at
            self._moves.append(self._moves[-1] + bool(MOTION.match(text)))
            self._work.append(self._work[-1] + work_of(text))

    def moves(self, begin, end):
        """Whether a statement from ``begin`` to before ``end`` moves the robot."""
        return self._moves[end] > self._moves[begin]

    def work(self, begin, end):
        """Units of work from ``begin`` to before ``end``."""
        return self._work[end] - self._work[begin]
