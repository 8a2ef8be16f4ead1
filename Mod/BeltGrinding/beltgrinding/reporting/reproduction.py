"""How to repeat a result: versions, hashes of the inputs, and the job file itself."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, TYPE_CHECKING

from ..job import inputs
from .layout import section, table
from .markup import data_uri, element

if TYPE_CHECKING:
    from ..simulation.result import Result
    from .content import Content
    from .language import Language
    from .markup import Markup

_NAMES = {
    "beltgrinding": "Belt Grinding",
    "eigen": "Eigen",
    "embree": "Embree",
    "opencascade": "OpenCASCADE",
    "kdop_k": "k-DOP: k",
}
FORBIDDEN = re.compile(r"[^\w .,()+-]")  # in a file's name, also in a command line
LONG = 400  # characters of a text, or items of a list, beyond which the shown job leaves it out


def repeat(content: Content, words: Language) -> Markup | None:
    result = content.result
    versions = ", ".join(
        f"{_NAMES.get(name, name)} {version}"
        for name, version in result.summary["versions"].items()
    )
    data = json.dumps(result.job, indent=1, ensure_ascii=False, allow_nan=False)
    # A title may hold what a shell runs.
    name = FORBIDDEN.sub("_", content.title).lstrip("-.") + ".job.json"
    link = element(
        "a",
        words("the job file, {name}", name=name),
        href=data_uri(data.encode("utf-8", "replace"), "application/json"),
        download=name,
        rel="attachment",
    )
    return section(
        words("How to repeat it"),
        element("p", words("Save "), link, words(" and run:")),
        element(
            "pre",
            f'beltgrind run "{name}" -o out\nbeltgrind report out',
            class_="command",
        ),
        element(
            "p",
            words(
                "The same program version gives the same heights, to the last bit, on any number "
                "of threads. Files that the job names must be there unchanged:"
            ),
        ),
        _hashes(result, words),
        element("h3", words("Versions")),
        element("p", versions),
        element(
            "details",
            element("summary", words("The job's settings")),
            element(
                "pre",
                json.dumps(
                    _short(result.job, words),
                    indent=1,
                    ensure_ascii=False,
                    allow_nan=False,
                ),
            ),
            class_="job",
        ),
    )


def _hashes(result: Result, words: Language) -> Markup | list[Markup]:
    """The inputs' table; what has changed since the run is said."""
    then = result.summary.get("inputs")
    now = inputs.digests(result.job)
    current = {(one["what"], one["file"]): one["sha256"] for one in now}
    kept = {(one["what"], one["file"]) for one in then or now}
    beside = [one for one in now if one["file"] and (one["what"], one["file"]) not in kept]
    rows = []
    for one in [*(then or now), *beside]:
        state, after = None, current.get((one["what"], one["file"]))
        if one in beside:
            state = element("b", " " + words("not among the run's hashes"), class_="bad")
        elif then and one["file"] is not None and after != one["sha256"]:
            text = words("changed since the run") if after else words("no longer there")
            state = element("b", " " + text, class_="bad")
        name = Path(one["file"]).name if one["file"] else words("in the job file")
        hashed = element("code", one["sha256"] or words("cannot be read"))
        rows.append((one["what"], [name, state], words.whole(one["bytes"]), hashed))
    heads = [
        (words("Input"), ""),
        (words("File"), ""),
        (words("Bytes"), "number"),
        ("SHA-256", "hash"),
    ]
    listed = table(heads, rows, "list hashes")
    if then:
        return listed
    note = words("The run kept no hashes; these were taken when the report was made.")
    return [element("p", note, class_="unknown"), listed]


def _short(value: Any, words: Language) -> Any:
    """A job without its long texts and lists."""
    if isinstance(value, dict):
        return {key: _short(one, words) for key, one in value.items()}
    if isinstance(value, str) and len(value) > LONG:
        return words("… {count} characters, in the job file", count=len(value))
    if isinstance(value, list):
        if len(value) > LONG // 10:
            return words("… {count} items, in the job file", count=len(value))
        return [_short(one, words) for one in value]
    return value
