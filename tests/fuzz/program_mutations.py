"""Damaged copies of robot programs, the same for the same dice."""

import re

LARGEST = 200_000  # bytes of a damaged file
LONG = 80  # lines; of a longer file a few windows are taken, so that many inputs a second are read
NUMBER = re.compile(rb"[-+]?\d+\.?\d*")
WORD = re.compile(rb"[$#]?\w+")
QUOTED = re.compile(rb'"[^"<>\n]*"')
NUMBERS = (
    *(b"1e999", b"-1e999", b"nan", b"inf", b"1e308", b"1e-320", b"99999999999", b"2147483648"),
    *(b"-0", b"", b"1.2.3", b"1,5", b"--1", b"1_000", b"0x10", b"1e", b".", b"9E9", b"360", b"0"),
    *(b"5000000", b"1000000000000", b"\xd9\xa3", b"7" * 400, b"1j", b"1D5", b"-1", b"#1", b"R[1]"),
)
TOKENS = (
    *(b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\x85", b"\x1a", b"\r", b"\n\n", b"\x0c", b"\t" * 50),
    *(b"(" * 300, b"[" * 300, b"{" * 300, b")", b"]", b"}", b'"', b"'", b";", b"$", b"!", b"#"),
    *(b"-" * 500, b"(-" * 200, b"NOT " * 300, b"x." * 300, b"/" * 50, b"(*", b"*)", b"%%%", b":="),
    *(b"<![CDATA[", b"]]>", b"&amp;", b"<a>" * 200, b"x" * 5000, b"a,b," * 500, b"1+" * 400, b"\\"),
)
ENCODINGS = ("utf-16", "utf-8-sig", "utf-16-be", "cp037")


def excerpt(data, dice):
    """``data``, or head, some windows and tail of it where it is long (and no XML)."""
    lines = data.splitlines(keepends=True)
    if len(lines) <= LONG or data.startswith(b"<") or dice.random() < 0.01:
        return data
    head, tail = dice.randint(8, 40), dice.randint(1, 12)
    kept = lines[:head]
    for _ in range(dice.randint(1, 3)):
        at = dice.randrange(head, len(lines) - tail)
        kept += lines[at : at + dice.randint(2, 20)]
    return b"".join(kept + lines[-tail:])


def damaged(data, others, dice):
    """A copy of ``data`` with one to six damages; ``others`` are files to take pieces from."""
    kinds = VALUES if data.startswith(b"<") and dice.random() < 0.8 else DAMAGES  # XML stays sound
    for _ in range(dice.choice((1, 1, 1, 2, 3, 6))):
        data = dice.choice(kinds)(data, others, dice)[:LARGEST]
    return data


def cut(data, others, dice):
    """The file ends too early."""
    return data[: dice.randrange(len(data) + 1)]


def _changed_byte(data, others, dice):
    at = dice.randrange(len(data) + 1)
    return data[:at] + bytes([dice.randrange(256)]) + data[at + 1 :]


def _without(data, others, dice):
    at = dice.randrange(len(data) + 1)
    return data[:at] + data[at + dice.choice((1, 1, 2, 5, 40, 400)) :]


def _doubled(data, others, dice):
    at = dice.randrange(len(data) + 1)
    return data[: at + dice.choice((1, 3, 20, 300))] + data[at:]


def _spliced(data, others, dice):
    other = dice.choice(others)
    at, begin = dice.randrange(len(data) + 1), dice.randrange(len(other) + 1)
    if dice.random() < 0.5:
        return data[:at] + other[begin:]
    return data[:at] + other[begin : begin + dice.choice((10, 100, 1000))] + data[at:]


def _token(data, others, dice):
    at = dice.randrange(len(data) + 1)
    return data[:at] + dice.choice((*TOKENS, *NUMBERS)) + data[at:]


def _number(data, others, dice):
    """Another number in the place of one, or one cut in its middle."""
    numbers = list(NUMBER.finditer(data))
    if not numbers:
        return data
    match = dice.choice(numbers)
    text = dice.choice((*NUMBERS, match.group()[: len(match.group()) // 2]))
    return data[: match.start()] + text + data[match.end() :]


def _word(data, others, dice):
    """A word of the file in another one's place."""
    words = list(WORD.finditer(data))
    if not words:
        return data
    match, other = dice.choice(words), dice.choice(words)
    return data[: match.start()] + other.group() + data[match.end() :]


def _quoted(data, others, dice):
    """A quoted text of the file in another one's place."""
    texts = list(QUOTED.finditer(data))
    if not texts:
        return data
    match, other = dice.choice(texts), dice.choice(texts)
    return data[: match.start()] + other.group() + data[match.end() :]


def _line(data, others, dice):
    """A line removed, doubled, moved, cut, joined with the next or repeated many times."""
    lines = data.splitlines(keepends=True) or [b""]
    at, kind = dice.randrange(len(lines)), dice.randrange(7)
    line = lines[at]
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(dice.randrange(len(lines) + 1), line)
    elif kind == 2:
        lines.insert(dice.randrange(len(lines)), lines.pop(at))
    elif kind == 3:
        lines[at] = line[: dice.randrange(len(line) + 1)] + b"\n"
    elif kind == 4:
        lines[at] = line.rstrip(b"\r\n") + b" "
    elif kind == 5:
        lines[at : at + 1] = [line] * dice.choice((30, 300, 2000))
    else:
        lines[at] = line.rstrip(b"\r\n") * dice.choice((3, 50, 1000)) + b"\n"
    return b"".join(lines)


def _encoded(data, others, dice):
    kind = dice.randrange(6)
    if kind < len(ENCODINGS):
        return data.decode("latin-1").encode(ENCODINGS[kind], errors="replace")
    return data.replace(b"\n", b"\r" if kind == 4 else b"\r\n")


def _cased(data, others, dice):
    at = dice.randrange(len(data) + 1)
    end = at + dice.choice((10, 1000))
    return data[:at] + data[at:end].swapcase() + data[end:]


VALUES = (_number, _number, _quoted, _word)
DAMAGES = (
    *(_changed_byte, _without, _doubled, _spliced, _token, _token, _number, _number, _number),
    *(_word, _word, _line, _line, _line, _encoded, _cased, cut),
)
