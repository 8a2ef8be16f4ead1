"""Changes of robot programs that keep their structure: lines, words, numbers and blocks."""

import re
import sys

NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
WORD = re.compile(rb"[$#]?[A-Za-z_]\w*")
EXTREMES = (
    *(b"0", b"-0", b"-0.0", b"1", b"-1", b"2", b"1e308", b"-1e308", b"1e-320", b"nan", b"inf"),
    *(
        b"1" + b"0" * 400,
        b"9223372036854775808",
        b"4294967296",
        b"2147483647",
        b"1e999",
        b"7" * 5000,
    ),
    *(b"9E9", b"1e16", b"0.1", b"90", b"180", b"360", b"1e-9", b"1000000", b"9007199254740993"),
)
TABLES = re.compile(r"[A-Za-z_$]\w{1,24}")


def words_of(reader, parents):
    """Words that a language's reader knows, from its tables and patterns, and those of its programs."""
    found = set()
    for files in parents:
        for data in files.values():
            found.update(WORD.findall(data[:20_000]))
    stem = reader.name
    for name, module in list(sys.modules.items()):
        if f".languages.{stem}" not in name:
            continue
        for value in vars(module).values():
            found.update(word.encode() for word in _words(value))
    return sorted(found)


def _words(value):
    if isinstance(value, str):
        return TABLES.findall(value)
    if isinstance(value, re.Pattern):
        return TABLES.findall(value.pattern if isinstance(value.pattern, str) else "")
    if isinstance(value, (set, frozenset, tuple, list)):
        return [word for one in value for word in _words(one)]
    if isinstance(value, dict):
        return [word for key in value for word in _words(key)]
    return []


def restructured(data, words, dice):
    """A copy of ``data`` with one change."""
    return dice.choice(CHANGES)(data, words, dice)


def _replaced(data, match, text):
    return data[: match.start()] + text + data[match.end() :]


def _number(data, words, dice):
    found = list(NUMBER.finditer(data))
    return _replaced(data, dice.choice(found), dice.choice(EXTREMES)) if found else data


def _keyword(data, words, dice):
    found = list(WORD.finditer(data))
    return _replaced(data, dice.choice(found), dice.choice(words)) if found and words else data


def _inserted(data, words, dice):
    """A known word between two of the program's."""
    found = list(WORD.finditer(data))
    if not found or not words:
        return data
    at = dice.choice(found).start()
    return (
        data[:at]
        + dice.choice(words)
        + dice.choice((b" ", b"(", b"=", b",", b"\n", b""))
        + data[at:]
    )


def _swapped(data, words, dice):
    lines = data.splitlines(keepends=True)
    if len(lines) < 2:
        return data
    a, b = dice.randrange(len(lines)), dice.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return b"".join(lines)


def _nested(data, words, dice):
    """Some lines within each other: a piece of the program repeated inside of itself."""
    lines = data.splitlines(keepends=True)
    if len(lines) < 3:
        return data
    a = dice.randrange(len(lines) - 1)
    b = min(len(lines), a + dice.randint(1, 8))
    at = dice.randint(a, b)
    return b"".join(lines[:at] + lines[a:b] * dice.choice((1, 1, 2, 30)) + lines[at:])


def _removed(data, words, dice):
    lines = data.splitlines(keepends=True)
    if not lines:
        return data
    a = dice.randrange(len(lines))
    del lines[a : a + dice.choice((1, 1, 2, 5))]
    return b"".join(lines)


def _repeated(data, words, dice):
    """A word or a number many times over."""
    found = list(WORD.finditer(data)) + list(NUMBER.finditer(data))
    if not found:
        return data
    match = dice.choice(found)
    joint = dice.choice((b"", b" ", b",", b"+", b"(", b".", b"="))
    return _replaced(data, match, joint.join([match.group()] * dice.choice((2, 10, 200))))


CHANGES = (
    *(_number, _number, _keyword, _keyword, _inserted, _inserted),
    *(_swapped, _nested, _nested, _removed, _repeated),
)
