"""Warnings that say the same of many places, as one with a count."""

LEAST = 3  # of a kind that become one


def grouped(told, least=LEAST):
    """Facts, errors, facts of JSON (dicts) or sentences; of ``least`` or more with one code, in one file and
    for reasons of one code the first remains, with the count of the others and the last line."""
    found, groups = [], {}
    for one in told:
        key = _key(one)
        if key is None:
            found.append([one])
        elif key in groups:
            groups[key].append(one)
        else:
            groups[key] = [one]
            found.append(groups[key])
    result = []
    for members in found:
        result += members if len(members) < least else [_one(members)]
    return result


def _one(members):
    from ..engine import Fact  # not above: that the core is missing must be said, too

    first, last = members[0], _place(members[-1]).get("line")
    arguments = {"first": first, "more": len(members) - 1}
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


def _parts(told):
    """(code, arguments, [arguments of the context])"""
    if isinstance(told, dict):
        return told["code"], told["arguments"], [c["arguments"] for c in told.get("context", ())]
    if not hasattr(told, "code"):
        return "", {}, []
    return told.code, told.arguments, [part[2] for part in getattr(told, "context", ())]


def _place(told):
    found = {}
    for arguments in _parts(told)[2]:
        found.update({k: v for k, v in arguments.items() if k in ("file", "line")})
    return found


def _key(told):
    code, arguments, _ = _parts(told)
    if not code:
        return None
    nested = [_parts(value)[0] for value in arguments.values()]
    return (code, _place(told).get("file"), *filter(None, nested))
