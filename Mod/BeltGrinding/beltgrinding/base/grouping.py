"""Warnings that say the same of many places, as one with a count."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

LEAST = 3  # of a kind that become one


def grouped(told: Iterable[Any], least: int = LEAST) -> list[Any]:
    """Facts, errors, facts of JSON (dicts) or sentences; of ``least`` or more with one code, in one file and
    for reasons of one code, and of two for the very same reason, the first remains, with the count of the others and
    the last line."""
    found: list[list[Any]] = []
    groups: dict[tuple[str | None, ...], list[Any]] = {}
    for one in told:
        key = _key(one)
        if key is None:
            found.append([one])
        elif key in groups:
            groups[key].append(one)
        else:
            groups[key] = [one]
            found.append(groups[key])
    result: list[Any] = []
    for members in found:
        together = len(members) >= least or len(members) > 1 and len(set(map(_cause, members))) == 1
        result += [_one(members)] if together else members
    return result


def _one(members: Sequence[Any]) -> Any:
    from ..engine import Fact  # not above: that the core is missing must be said, too

    first, last = members[0], _place(members[-1]).get("line")
    arguments: dict[str, Any] = {"first": first, "more": len(members) - 1}
    if last is None or last == _place(first).get("line"):
        found = Fact("base.more_alike", "{first} (and {more} more like it)", **arguments)
    else:
        found = Fact(
            "base.more_alike_to_line",
            "{first} (and {more} more like it, up to line {line})",
            **arguments,
            line=last,
        )
    if not isinstance(first, dict):
        return found
    return {
        "code": found.code,
        "text": found.text,
        "arguments": {**found.arguments, "first": first},
    }


def _parts(told: Any) -> tuple[str, dict[str, Any], list[dict[str, Any]]]:
    """(code, arguments, [arguments of the context])"""
    if isinstance(told, dict):
        return told["code"], told["arguments"], [c["arguments"] for c in told.get("context", ())]
    if not hasattr(told, "code"):
        return "", {}, []
    return told.code, told.arguments, [part[2] for part in getattr(told, "context", ())]


def _cause(told: Any) -> str:
    """The innermost reason that a fact gives; the fact itself without one."""
    code, arguments, _ = _parts(told)
    reason = arguments.get("reason")
    return _cause(reason) if _parts(reason)[0] else str((code, arguments) if code else told)


def _place(told: Any) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for arguments in _parts(told)[2]:
        found.update({k: v for k, v in arguments.items() if k in ("file", "line")})
    return found


def _key(told: Any) -> tuple[str | None, ...] | None:
    code, arguments, _ = _parts(told)
    if not code:
        return None
    nested = [_parts(value)[0] for value in arguments.values()]
    return (code, _place(told).get("file"), *filter(None, nested))
