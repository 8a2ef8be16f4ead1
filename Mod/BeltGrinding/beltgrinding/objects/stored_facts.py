"""Facts in a document: English sentences that everyone can read, and beside them, hidden, what makes them
sentences in another language.
"""

from __future__ import annotations

import json
from collections.abc import Sequence

from ..base.grouping import grouped
from ..base.messages import fact_data, sentence
from .kinds import DocumentObject
from .properties import Output

MOST = 200  # facts kept beside their sentences


def output(name: str, group: str) -> Output:
    """The hidden property beside the StringList ``name``."""
    return Output(f"{name}Data", "String", group, "the same as JSON, for other languages", True)


def store(obj: DocumentObject, name: str, facts: Sequence[str]) -> None:
    """Sets both properties. ``facts``: Facts, or sentences that are none."""
    setattr(obj, name, [str(fact) for fact in facts])
    data = [fact_data(fact) for fact in facts[:MOST]]
    setattr(obj, f"{name}Data", json.dumps(data, allow_nan=False) if data else "")


def sentences(
    obj: DocumentObject, name: str, language: str, most: int | None = MOST, alike: bool = False
) -> list[str]:
    """The first ``most`` sentences of a property (None: all); ``alike``: many of a kind as one. Those without
    a fact are told as they stand: of a version before 0.2, or set by a macro.
    """
    told = list(getattr(obj, name))[:most]
    data = json.loads(getattr(obj, f"{name}Data", "") or "[]")
    for at, (english, fact) in enumerate(zip(told, data)):
        if sentence(fact, "en") == english:
            told[at] = fact
    return [sentence(one, language) for one in (grouped(told) if alike else told)]
