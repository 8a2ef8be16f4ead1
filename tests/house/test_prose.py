"""The manual keeps to short sentences, paragraphs and pages, and to none of our idioms: tests/support/prose.py."""

import pytest

from support import prose

PAGES = [
    "README.md",
    *sorted(
        path.relative_to(prose.ROOT).as_posix() for path in (prose.ROOT / "docs").rglob("*.md")
    ),
]


@pytest.mark.parametrize("page", PAGES)
def test_a_page_reads_well(page):
    wrong = prose.problems((prose.ROOT / page).read_text(encoding="utf-8"))
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("page", prose.guide())
def test_a_page_of_the_guide_is_short(page):
    found = prose.length((prose.ROOT / "docs" / page).read_text(encoding="utf-8"))
    assert found <= prose.MOST_GUIDE, f"{found} words: divide it by what the reader does"


def test_the_manual_is_short():
    pages = (prose.ROOT / "docs").rglob("*.md")
    found = sum(prose.length(path.read_text(encoding="utf-8")) for path in pages)
    assert found <= prose.MOST_MANUAL


def test_what_is_counted():
    page = "# Head\n\nOne two `three four`.\n\n    code\n\n| a | b |\n\n```\ncode\n```\n- five\n"
    assert prose.length(page) == 4  # code between words counts as one
    assert {"workbench-job.md", "languages/krl.md", "planning.md"} <= set(prose.guide())
    assert not {"methods.md", "macro.md", "architecture.md"} & set(prose.guide())


def test_what_it_finds():
    long = "Word " + "word " * 25 + "end."
    page = (
        f"A short one. Another. {long}\n\n    code that is told\n\n| a | is told |\n\nIt is told.\n"
    )
    found = prose.problems(page)
    assert len(found) == 2 and "27 words in the sentence" in found[0] and "'is told'" in found[1]
    assert prose.problems(("word " * 24 + "end. ") * 4)[0].startswith("100 words in the paragraph")
    assert prose.problems("- One item\n- and another\n  that goes on.\n") == []
