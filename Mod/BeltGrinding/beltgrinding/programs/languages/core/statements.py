"""What a language does with each of its statements: docs/languages/statements.md is made from it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Statements:
    """The words of a language, as its manual writes them, each in one of four groups, in the order of letters.

    A reader makes it from the tables by which it runs statements, so that both cannot differ.
    """

    followed: Iterable[str]  # what they do is done
    ignored: Iterable[str] = ()  # they change neither the path nor a value that it may depend on
    asked: Iterable[str] = ()  # followed with values that the user gives, else told as missing
    left_out: Iterable[str] = ()  # told at the place as lost, the path not joined over them

    def __post_init__(self) -> None:
        for group in fields(self):
            words = sorted(set(getattr(self, group.name)), key=lambda word: (word.lower(), word))
            object.__setattr__(self, group.name, tuple(words))
