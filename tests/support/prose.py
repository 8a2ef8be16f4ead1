"""Reads pages of the manual as sentences: how long they are, and which idioms of ours stand in them; counts words.

    /usr/bin/python3 tests/support/prose.py [PAGE...]     # what is wrong, and the figures
"""

import re
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
MOST_WORDS = 25  # in a sentence
MOST_MEAN = 16  # words in a sentence, of a page
MOST_PARAGRAPH = 90  # words
MOST_GUIDE = (
    700  # words of a page of the guide, all but theory, reference and how the house is built
)
MOST_MANUAL = 35_000  # words of all pages of docs/
NO_GUIDE = ("Macros and programs", "Methods and accuracy", "How it is built", "The project")
IDIOMS = re.compile(
    r"\b(is told|are told|stands? in|that are none|that is none|which one|what .{1,40} is, is|comes? to lie|"
    r"does so well|of which nothing|is none|are none)\b"
)


def paragraphs(page):
    """The prose of a page, a text for each paragraph, item of a list and picture's caption: no code, tables, headings."""
    found, now, fenced = [], [], False
    for line in [*page.splitlines(), ""]:
        if line.startswith("```"):
            fenced = not fenced
            line = ""
        item = re.match(r"\s*(?:[-*]|\d+\.) ", line)
        prose = (
            line.strip() and not fenced and (item or not re.match(r" {4}|\||#|!\[|<|\$\$", line))
        )
        if now and (item or not prose):
            found.append(" ".join(now))
            now = []
        if prose:
            now.append(line[item.end() :].strip() if item else line.strip())
    return [plain(one) for one in found]


def plain(text):
    """Without what a reader does not see of links, and with code as one word."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`]*`", "Code", text)
    return re.sub(r"\$[^$]*\$", "x", text)


def sentences(paragraph):
    """A paragraph's sentences; a colon before a list or another sentence ends none."""
    return [one for one in re.split(r"(?<=[.!?])\s+(?=[A-Z\"'*(\[0-9])", paragraph) if words(one)]


def words(text):
    return re.findall(r"[^\W_][\w'-]*", text)


def length(page):
    """Words of a page's prose, without code and tables."""
    return sum(len(paragraph.split()) for paragraph in paragraphs(page))


def guide():
    """The pages of docs/ that are the guide: those in the menu of mkdocs.yml outside of ``NO_GUIDE``."""
    menu = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))["nav"]
    sections = [one for part in menu for name, one in part.items() if name not in NO_GUIDE]
    return [
        page
        for section in sections
        for entry in ([{"": section}] if isinstance(section, str) else section)
        for page in entry.values()
    ]


def problems(page):
    """Of a page's text: a line each."""
    found, lengths = [], []
    for paragraph in paragraphs(page):
        if len(words(paragraph)) > MOST_PARAGRAPH:
            found.append(f"{len(words(paragraph))} words in the paragraph: {paragraph[:60]}...")
        for idiom in IDIOMS.finditer(paragraph):
            found.append(
                f"'{idiom.group()}' in: ...{paragraph[max(0, idiom.start() - 30):][:70]}..."
            )
        for sentence in sentences(paragraph):
            lengths.append(len(words(sentence)))
            if lengths[-1] > MOST_WORDS:
                found.append(f"{lengths[-1]} words in the sentence: {sentence[:60]}...")
    if lengths and sum(lengths) / len(lengths) > MOST_MEAN:
        found.append(f"{sum(lengths) / len(lengths):.1f} words in a sentence, on the mean")
    return found


if __name__ == "__main__":
    pages = [Path(one) for one in sys.argv[1:]] or sorted((ROOT / "docs").rglob("*.md"))
    for path in pages:
        wrong = problems(path.read_text(encoding="utf-8"))
        print(f"{path}: {length(path.read_text())} words, {len(wrong)} problems")
        if len(sys.argv) > 1:
            print("\n".join(f"  {one}" for one in wrong))
