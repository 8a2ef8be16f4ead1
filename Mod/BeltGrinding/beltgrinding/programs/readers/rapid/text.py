"""The text of an ABB RAPID module as a tree of statements.

Statements end in ';' or a keyword, not at a line's end. A module the controller would refuse
(a block or a statement that is not closed) is a ProgramError: what it would do is anyone's guess.
"""

import re
from pathlib import Path

from ...program import Fact, ProgramError, bytes_of, lines_of, name_of

MAX_NESTING = 60
CLOSED_BY = {
    "module": "endmodule",
    "proc": "endproc",
    "func": "endfunc",
    "trap": "endtrap",
    "record": "endrecord",
    "if": "endif",
    "for": "endfor",
    "while": "endwhile",
    "test": "endtest",
}
ENDS = set(CLOSED_BY.values())
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
# A line that begins like this cannot be the continuation of a statement.
NO_CONTINUATION = re.compile(
    r"\n[^\S\n]*(?:(?:LOCAL|TASK)\s+)*(?:END(?:PROC|MODULE|FUNC|TRAP|IF|FOR|WHILE|TEST)|PROC|FUNC|TRAP"
    r"|CONST|PERS|VAR|MODULE|IF|FOR|WHILE|Move[LJC]|MoveAbsJ)\b",
    re.IGNORECASE,
)


class Node:
    """A statement: its line, its first word in lower case, its text, what a block encloses."""

    __slots__ = ("line", "word", "text", "body", "parts")

    def __init__(self, line, word, text, body=None):
        self.line, self.word, self.text, self.body = line, word, text, body
        self.parts = None  # what a reader finds in the body, once

    def divided(self, words):
        """List of (node, statements) of the body: what follows each node whose word is among
        ``words``; what stands before the first has the node itself.
        """
        if self.parts is None:
            self.parts = [(self, [])]
            for inner in self.body:
                if inner.word in words:
                    self.parts.append((inner, []))
                else:
                    self.parts[-1][1].append(inner)
        return self.parts


def tree(path):
    """List of the outermost Nodes of a file. Raises ProgramError naming file and line."""
    path = Path(path)
    name = name_of(path)
    text = _without_comments(_text(path), name)
    root, open_nodes, last = [], [], 1
    for node in _statements(text, name):
        last = node.line
        if node.word in ENDS:
            _close(open_nodes, node, name)
            continue
        (open_nodes[-1].body if open_nodes else root).append(node)
        if node.body is not None:
            open_nodes.append(node)
            if len(open_nodes) > MAX_NESTING:
                raise ProgramError.at(
                    name, node.line, "programs.nested_blocks", "blocks are nested too deeply"
                )
    if open_nodes:
        raise ProgramError.at(
            name,
            last,
            "programs.rapid.cut",
            "{reason}; is the file cut off?",
            reason=_unclosed(open_nodes[-1]),
        )
    return root


def _close(open_nodes, node, name):
    if not open_nodes:
        raise ProgramError.at(
            name,
            node.line,
            "programs.closes_nothing",
            "{word} closes nothing",
            word=node.word.upper(),
        )
    if CLOSED_BY[open_nodes[-1].word] != node.word:
        raise ProgramError.at(
            name, node.line, "programs.rapid.unclosed", "{reason}", reason=_unclosed(open_nodes[-1])
        )
    open_nodes.pop()


def _unclosed(node):
    word = node.word
    return Fact(
        "programs.rapid.no_block_end",
        "the {word} of line {begun} has no {end}",
        word=word.upper(),
        begun=node.line,
        end=CLOSED_BY[word].upper(),
    )


def _text(path):
    raw = bytes_of(path, "RAPID")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return "\n".join(lines_of(text, name_of(path)))


def _without_comments(text, name):
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


def _statements(text, name):
    # Strings may hold ';' and keywords: those are searched for where strings are blanked.
    masked = STRING.sub(lambda m: '"' + " " * (len(m.group()) - 2) + '"', text)
    at, counted, line = 0, 0, 1
    while True:
        at = GAP.match(masked, at).end()
        line, counted = line + masked.count("\n", counted, at), at
        if at >= len(masked):
            return
        first = FIRST.match(masked, at)
        word = first.group(1).lower() if first else ""
        body, end = None, None
        if word in ALONE:
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
            body = [] if word in CLOSED_BY else None
        elif word not in TAILS and first and LABEL.match(masked, at):
            end = LABEL.match(masked, at).end()
            yield Node(line, "label", word)
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
            body = [] if word in CLOSED_BY else None
        yield Node(line, word, text[at:end].strip(), body)
        at = after
