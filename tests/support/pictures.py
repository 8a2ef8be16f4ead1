"""The pictures of the manual: which there are, who makes them, and whether they still show the truth."""

import re
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
MADE = ROOT / "build" / "pictures"  # where tests put them; tools/pictures takes them from there
IMAGES = ROOT / "docs" / "images"
APART = {
    "contact-reference": "tools/contact_picture.py",  # CalculiX takes minutes
    "validation": "tests/benchmark/validation_bench.py",  # with its page
}
RELEASE = [
    0,
    20,
]  # of FreeCAD, that the kept pictures are of; others draw frames and icons their way
WINDOW = 12  # pixels; a character of a label is as large
SAME = 0.2  # of 255: of pictures taken twice
ALIKE = 3.0  # of 255: another rounding of colours is below, another character above
COLOURFUL = 60  # of 255, from the least to the greatest channel: no text is


def referenced():
    """{name of a picture: the pages that show it}."""
    found = {}
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        for name in re.findall(r"images/([\w-]+)\.png", page.read_text(encoding="utf-8")):
            found.setdefault(name, []).append(page.name)
    return found


def made_by():
    """{name of a picture: the files under tests/, or the one apart, that make it}."""
    found = {}
    for name, file in APART.items():
        if f"{name}.png" in (ROOT / file).read_text(encoding="utf-8"):
            found[name] = [file]
    for path in sorted((ROOT / "tests").rglob("*.py")):
        for name in re.findall(r"\b(?:picture|keep)\(\"([\w-]+)\"", path.read_text("utf-8")):
            found.setdefault(name, []).append(path.name)
    return found


def difference(one, other):
    """How far two pictures (paths) differ where they differ most: the mean difference of the colour
    that differs most, 0 to 255, in a square of ``WINDOW`` pixels; inf if they are not of one size.
    """
    return largest_difference(one, other)[0]


def largest_difference(one, other):
    """(``difference``, (x, y) of that square's upper left corner; None if they are not of one size)."""
    a, b = (np.asarray(Image.open(path).convert("RGB")).astype(float) for path in (one, other))
    if a.shape != b.shape:
        return float("inf"), None
    away = np.maximum(_away(a, b), _away(b, a))
    sums = np.pad(away.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    rows, columns = (min(WINDOW, size) for size in a.shape[:2])
    inside = sums[rows:] - sums[:-rows]
    inside = inside[:, columns:] - inside[:, :-columns]
    y, x = np.unravel_index(inside.argmax(), inside.shape)
    return float(inside.max() / (rows * columns)), (int(x), int(y))


def _away(one, other):
    """(rows, columns) how far each colour of one picture is from the other's there. A colourful one may lie a pixel
    aside: where a slanting line has its steps is the processor's rounding.
    """
    found = np.abs(one - other).max(axis=2)
    colourful = np.maximum(np.ptp(one, axis=2), np.ptp(other, axis=2)) > COLOURFUL
    rows, columns = np.nonzero(colourful & (found > 0))
    for down in (-1, 0, 1):
        for right in (-1, 0, 1):
            at = np.clip(rows + down, 0, one.shape[0] - 1), np.clip(
                columns + right, 0, one.shape[1] - 1
            )
            near = np.abs(one[rows, columns] - other[at]).max(axis=1)
            found[rows, columns] = np.minimum(found[rows, columns], near)
    return found


def keep(name, picture):
    """Takes a picture (bytes of a PNG) to those that tests made."""
    MADE.mkdir(parents=True, exist_ok=True)
    (MADE / f"{name}.png").write_bytes(picture)


def check(release, names):
    """Fails if one of the pictures just made looks other than the manual's; of ``RELEASE`` alone."""
    if release == RELEASE:
        wrong = stale(names)
        assert not wrong, "; ".join(wrong) + "; look at build/pictures, then run tools/pictures"


def stale(names):
    """Sentences on those of the manual's pictures that no longer look like what was just made."""
    wrong = []
    for name in names:
        kept, made = IMAGES / f"{name}.png", MADE / f"{name}.png"
        if not kept.exists():
            wrong.append(f"{name} is not in docs/images")
            continue
        away, at = largest_difference(kept, made)
        if away > ALIKE:
            where = "its size" if at is None else f"at x {at[0]}, y {at[1]}"
            wrong.append(
                f"{name} shows something else now: {where} ({away:.1f} of {ALIKE:.1f} allowed)"
            )
    return wrong
