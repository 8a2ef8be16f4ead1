"""The pages of the languages: each at most 500 words of text, and its example gives the motions that it says."""

import re
from pathlib import Path

import pytest

from beltgrinding.programs.registry import read_program

PAGES = sorted(
    page
    for page in (Path(__file__).resolve().parents[2] / "docs" / "languages").glob("*.md")
    if page.stem != "statements"  # made from the code: test_statements.py
)
BLOCK = re.compile(r"^```(\w+)(?: title=\"(.+?)\")?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
MOST = 500


def said(motion):
    """A motion as the pages write it."""
    place = " ".join(f"{round(float(v), 3) + 0:g}" for v in motion.pose[:3, 3])
    speed = f", {motion.speed_mm_s:g} mm/s" if motion.speed_mm_s else ""
    force = f", {motion.force_N:g} N" if motion.force_N else ""
    return (
        f"line {motion.line}: {motion.kind}{' through' if motion.aux else ''} {place}{speed}{force}"
    )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_example_gives_the_motions_that_the_page_says(tmp_path, page):
    blocks = BLOCK.findall(page.read_text(encoding="utf-8"))
    files = [(name, text) for _, name, text in blocks if name]
    for name, text in files:
        (tmp_path / name).write_text(text, encoding="utf-8")
    (expected,) = [text for kind, _, text in blocks if kind == "motions"]
    program = read_program(tmp_path / files[0][0])
    assert [said(motion) for motion in program.motions] == expected.strip().splitlines()
    assert program.lost == 0 and not program.problems


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_page_is_short(page):
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    assert len(re.findall(r"[^\W\d_]{2,}", text)) <= MOST
