"""The text of an ABB RAPID module as a tree of statements.

Statements end in ';' or a keyword, not at a line's end. A module the controller would refuse
(a block or a statement that is not closed) is a ProgramError: what it would do is anyone's guess.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

from ....base.kinds import known
from ...program import Fact, ProgramError, bytes_of, lines_of, name_of
from ..core.tree import Node, grown

CLOSED_BY = {
    word: (f"end{word}",)
    for word in ("module", "proc", "func", "trap", "record", "if", "for", "while", "test")
}
ENDS = {end for (end,) in CLOSED_BY.values()}
ALONE = ENDS | {"else", "undo"}
GAP = re.compile(r"[\s;]*")
STRING_OR_COMMENT = re.compile(r'"(?:[^"\n]|"")*"|![^\n]*')
STRING = re.compile(r'"(?:[^"\n]|"")*"')
FIRST = re.compile(r"(?:(?:LOCAL|TASK)\s+)*(\w+)", re.IGNORECASE)
LABEL = re.compile(r"\w+\s*:(?!=)")
HEADS = {
    "module": re.compile(r"MODULE\s+\w+(?:\s*\([^)]*\))?", re.IGNORECASE),
    "proc": re.compile(r"(?:LOCAL\s+)?PROC\s+\w+\s*\([^()]*\)", re.IGNORECASE),
    "func": re.compile(r"(?:LOCAL\s+)?FUNC\s+\w+\s+\w+\s*\([^()]*\)", re.IGNORECASE),
    "trap": re.compile(r"(?:LOCAL\s+)?TRAP\s+\w+", re.IGNORECASE),
    "record": re.compile(r"(?:LOCAL\s+)?RECORD\s+\w+", re.IGNORECASE),
    "error": re.compile(r"ERROR(?:\s*\([^)]*\))?", re.IGNORECASE),
    "backward": re.compile(r"BACKWARD", re.IGNORECASE),
}
TAILS = {
    "if": re.compile(r"\bTHEN\b|;", re.IGNORECASE),
    "elseif": re.compile(r"\bTHEN\b|;", re.IGNORECASE),
    "for": re.compile(r"\bDO\b|;", re.IGNORECASE),
    "while": re.compile(r"\bDO\b|;", re.IGNORECASE),
    "test": re.compile(r"(?=\b(?:CASE|DEFAULT|ENDTEST)\b)|;", re.IGNORECASE),
    "case": re.compile(r":(?!=)|;"),
    "default": re.compile(r":(?!=)|;"),
}
SEMICOLON = re.compile(";")
PLACEHOLDER = re.compile(r"<\w+>")  # where RobotStudio is still to be told a statement
# A line that begins like this cannot be the continuation of a statement.
NO_CONTINUATION = re.compile(
    r"\n[^\S\n]*(?:(?:LOCAL|TASK)\s+)*(?:END(?:PROC|MODULE|FUNC|TRAP|IF|FOR|WHILE|TEST)|PROC|FUNC|TRAP"
    r"|CONST|PERS|VAR|MODULE|IF|FOR|WHILE|Move[LJC]|MoveAbsJ)\b",
    re.IGNORECASE,
)


def tree(path: Path | str) -> list[Node]:
    """List of the outermost Nodes of a file. Raises ProgramError naming file and line."""
    path = Path(path)
    name = name_of(path)
    text = _without_comments(_text(path), name)

    def stray(line: int, word: str, text: str, node: Node | None) -> NoReturn:
        if node is None:
            raise ProgramError.at(
                name, line, "programs.closes_nothing", "{word} closes nothing", word=word.upper()
            )
        raise ProgramError.at(
            name, line, "programs.rapid.unclosed", "{reason}", reason=_unclosed(node)
        )

    def unclosed(node: Node, line: int) -> NoReturn:
        raise ProgramError.at(
            name,
            line,
            "programs.rapid.cut",
            "{reason}; is the file cut off?",
            reason=_unclosed(node),
        )

    return grown(_statements(text, name), CLOSED_BY, name, stray, unclosed)


def _unclosed(node: Node) -> Fact:
    word = node.word
    return Fact(
        "programs.rapid.no_block_end",
        "the {word} of line {begun} has no {end}",
        word=word.upper(),
        begun=node.line,
        end=CLOSED_BY[word][0].upper(),
    )


def _text(path: Path) -> str:
    raw = bytes_of(path, "RAPID")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return "\n".join(lines_of(text, name_of(path)))


def _without_comments(text: str, name: str) -> str:
    """Comments and the %%% header become blanks; line ends stay, for the line numbers."""
    head = re.match(r"\s*%%%", text)
    if head:
        end = text.find("%%%", head.end())
        if end < 0:
            raise ProgramError.at(
                name, 1, "programs.rapid.header", "the header begun by %%% has no second %%%"
            )
        text = "\n" * text.count("\n", 0, end) + text[end + 3 :]
    return STRING_OR_COMMENT.sub(lambda m: m.group() if m.group()[0] == '"' else "", text)


def _statements(text: str, name: str) -> Iterator[tuple[int, str, str]]:
    # Strings may hold ';' and keywords: those are searched for where strings are blanked.
    masked = STRING.sub(lambda m: '"' + " " * (len(m.group()) - 2) + '"', text)
    at, counted, line = 0, 0, 1
    while True:
        at = known(GAP.match(masked, at)).end()
        line, counted = line + masked.count("\n", counted, at), at
        if at >= len(masked):
            return
        first = FIRST.match(masked, at)
        word = first.group(1).lower() if first else ""
        placeholder = PLACEHOLDER.match(masked, at)
        if placeholder:
            yield line, "placeholder", placeholder.group()
            at = placeholder.end()
            continue
        label = LABEL.match(masked, at) if first and word not in TAILS else None
        if first and word in ALONE:
            end = after = first.end()
        elif word in HEADS:
            head = HEADS[word].match(masked, at)
            if not head:
                raise ProgramError.at(
                    name,
                    line,
                    "programs.rapid.head",
                    "the head of this {word} is not sound",
                    word=word.upper(),
                )
            end = after = head.end()
        elif label:
            end = label.end()
            yield line, "label", word
            at = end
            continue
        else:
            tail = TAILS.get(word, SEMICOLON).search(masked, at)
            open_end = NO_CONTINUATION.search(masked, at, tail.start() if tail else len(masked))
            if open_end:
                raise ProgramError.at(
                    name,
                    line + masked.count("\n", at, open_end.start()),
                    "programs.rapid.no_semicolon",
                    "the statement has no ';' at its end",
                )
            if not tail:
                raise ProgramError.at(
                    name,
                    line,
                    "programs.rapid.endless_statement",
                    "the statement has no end; is the file cut off?",
                )
            end, after = tail.start(), tail.end()
            if tail.group() == ";" and word in TAILS and word != "if":
                raise ProgramError.at(
                    name,
                    line,
                    "programs.rapid.not_complete",
                    "this {word} is not complete",
                    word=word.upper(),
                )
            if word == "if" and tail.group() == ";":
                word = "if;"  # the short form: one statement and no ENDIF
        yield line, word, text[at:end].strip()
        at = after
