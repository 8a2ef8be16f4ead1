"""Statements as a tree of blocks."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Optional

from ...program import ProgramError

MAX_NESTING = 60


class Node:
    """A statement: its line, its first word in lower case, its text, what a block encloses (None: it is none)."""

    __slots__ = ("line", "word", "text", "body", "parts", "closed")

    def __init__(self, line: int, word: str, text: str, body: Optional[list[Node]] = None) -> None:
        self.line, self.word, self.text, self.body = line, word, text, body
        self.parts: Optional[
            list[tuple[Node, list[Node]]]
        ] = None  # what a reader finds in the body, once
        self.closed = True

    def divided(self, words: Collection[str]) -> list[tuple[Node, list[Node]]]:
        """List of (node, statements) of the body: what follows each node whose word is among
        ``words``; what stands before the first has the node itself.
        """
        if self.parts is None:
            self.parts = [(self, [])]
            for inner in self.body or ():
                if inner.word in words:
                    self.parts.append((inner, []))
                else:
                    self.parts[-1][1].append(inner)
        return self.parts


def every(nodes: Iterable[Node]) -> Iterator[Node]:
    """All Nodes of a tree."""
    stack = list(nodes)
    while stack:
        node = stack.pop()
        stack += node.body or []
        yield node


def grown(
    rows: Iterable[tuple[int, str, str]],
    closed_by: Mapping[str, Sequence[str]],
    file: str,
    stray: Callable[[int, str, str, Optional[Node]], None],
    unclosed: Callable[[Node, int], None],
) -> list[Node]:
    """The outermost Nodes of rows (line, word, text). ``closed_by``: {word that opens a block: those that close
    it}; the statement that closes a block is the text of one that is closed by a condition, "until".

    ``stray(line, word, text, node)`` is called for a word that closes nothing, or (``node``) not the block that
    is open; ``unclosed(node, line)`` for a block without an end. Where they raise nothing the tree goes on.
    """
    ends = {end for every_end in closed_by.values() for end in every_end}
    root: list[Node] = []
    opened: list[Node] = []
    line = 1
    for line, word, text in rows:
        if word in ends:
            if not opened or word not in closed_by[opened[-1].word]:
                stray(line, word, text, opened[-1] if opened else None)
                continue
            node = opened.pop()
            if word == "until":
                node.text = text[len(word) :].strip()
            continue
        node = Node(line, word, text, [] if word in closed_by else None)
        holder = opened[-1].body if opened else root
        assert holder is not None  # what is opened has a body
        holder.append(node)
        if node.body is not None:
            opened.append(node)
            if len(opened) > MAX_NESTING:
                raise ProgramError.at(
                    file, line, "programs.nested_blocks", "blocks are nested too deeply"
                )
    for node in reversed(opened):
        node.closed = False
        unclosed(node, line)
    return root
