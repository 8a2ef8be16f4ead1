"""Writes changes back into a CSV of poses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.kinds import known
from .text import Source, decimal, decimals, moved

if TYPE_CHECKING:
    from .text import Work

ROUNDING_MM = 6e-5


def source(data: bytes) -> Source:
    """The reader counts lines as Python does, in UTF-8."""
    text = data.decode("utf-8-sig")
    ends, at = [], len(data) - len(text.encode())
    for line in text.splitlines(keepends=True):
        bare = line.splitlines()[0]
        begin = at + len(bare.encode())
        at += len(line.encode())
        if at > begin:
            ends.append((begin, at))
    return Source(data, ends)


def derived(source: Source, line: int) -> bool:
    return False


def rounding_mm_s(source: Source, line: int) -> float:
    return 1e-6


def edit(source: Source, work: Work) -> None:
    line = next(k for k in range(1, len(source) + 1) if _counts(source.line(k)))
    head = source.line(line).removeprefix("\xef\xbb\xbf")
    delimiter = max(",;\t", key=head.count)
    columns = {name.strip(): k for k, name in enumerate(head.split(delimiter))}
    for wanted, column in ((work.speeds, "feed_mm_s"), (work.forces, "force_N")):
        for line, value in wanted.items():
            if column not in columns:
                raise work.refuse(
                    line,
                    "programs.patch.no_column",
                    "the table has no column {column}; add one, empty or not",
                    column=column,
                )
            begin, end = _cell(source, work, line, delimiter, columns[column])
            had = decimals(source.text[begin:end])
            source.replace(begin, end, decimal(value, max(had, 6), had))
    for line, _, shift in work.targets():
        for column, step in zip(("x_mm", "y_mm", "z_mm"), known(work.in_base(shift))):
            if step:
                begin, end = _cell(source, work, line, delimiter, columns[column])
                source.replace(begin, end, moved(source.text[begin:end], step))


def _counts(text: str) -> bool:
    text = text.removeprefix("\xef\xbb\xbf").strip()
    return bool(text) and not text.startswith("#")


def _cell(source: Source, work: Work, line: int, delimiter: str, number: int) -> tuple[int, int]:
    """The span of a value, without blanks and quotes."""
    begin, end = source.span(line)
    quoted, count, first = False, 0, begin
    for at in range(begin, end + 1):
        letter = source.text[at] if at < end else delimiter
        quoted = quoted != (letter == '"')
        if letter == delimiter and (not quoted or at == end):
            if count == number:
                last = at
                while first < last and source.text[first] in ' "':
                    first += 1
                while last > first and source.text[last - 1] in ' "':
                    last -= 1
                return first, last
            count, first = count + 1, at + 1
    raise work.refuse(line, "programs.patch.value_missing", "a value is missing; change it by hand")
