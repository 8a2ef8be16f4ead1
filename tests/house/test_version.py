"""One version everywhere: package.xml has it; the changelog, the citation and the manual agree."""

import datetime
import os
import re
import subprocess
import xml.etree.ElementTree as tree

import yaml

from support.freecad import ROOT

WIKI = "{https://wiki.freecad.org/Package_Metadata}"
PACKAGE = tree.parse(ROOT / "package.xml").getroot()
VERSION, DATE = PACKAGE.findtext(WIKI + "version"), PACKAGE.findtext(WIKI + "date")
KINDS = {"Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"}


def releases():
    """[(version, date)] of the changelog, and its kinds of changes."""
    text = (ROOT / "CHANGELOG.md").read_text("utf-8")
    assert re.findall(r"^## (.*)$", text, re.M)[0] == "Unreleased"
    return re.findall(r"^## (\S+) - (\S+)$", text, re.M), set(re.findall(r"^### (.*)$", text, re.M))


def test_the_newest_release_of_the_changelog_is_this_one():
    found, kinds = releases()
    assert found[0] == (VERSION, DATE)
    numbers = [tuple(int(part) for part in version.split(".")) for version, _ in found]
    dates = [datetime.date.fromisoformat(date) for _, date in found]
    assert numbers == sorted(set(numbers), reverse=True) and dates == sorted(dates, reverse=True)
    assert kinds <= KINDS


def test_no_release_says_a_thing_twice():
    text = (ROOT / "CHANGELOG.md").read_text("utf-8")
    entries = [" ".join(entry.split()) for entry in re.findall(r"^- (.*(?:\n  .*)*)", text, re.M)]
    assert len(entries) == len(set(entries))


def test_cmake_takes_the_version_from_there():
    cached = ROOT / "build" / "release" / "CMakeCache.txt"
    assert (
        "project(BeltGrinding VERSION ${package_version}" in (ROOT / "CMakeLists.txt").read_text()
    )
    assert f"CMAKE_PROJECT_VERSION:STATIC={VERSION}\n" in cached.read_text()


def test_the_manual_names_this_release():
    named = re.findall(
        r"[Bb]elt[Gg]rinding[-_](\d[\d.]*\d)", (ROOT / "docs/install.md").read_text()
    )
    assert named and set(named) == {VERSION}


def test_the_citation():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert (citation["version"], str(citation["date-released"])) == (VERSION, DATE)
    assert citation["license"] == PACKAGE.findtext(WIKI + "license")
    assert citation["cff-version"] == "1.2.0" and citation["message"] and citation["authors"]
    papers = citation["references"]
    assert all(one["title"] and one["authors"] and 1900 < one["year"] < 2100 for one in papers)
    pages = [ROOT / "docs" / "methods.md", *sorted((ROOT / "docs").glob("*-method.md"))]
    methods = "\n\n".join(page.read_text("utf-8") for page in pages)
    cited = {one["authors"][0]["family-names"] for one in papers}
    for name in re.findall(
        r"([A-Z][a-zäöü]+)(?:, | and | et al\.)[^()]{0,60}\b(?:19|20)\d\d", methods
    ):
        assert any(name in str(one["authors"]) for one in papers), f"{name} of docs/*-method.md"
    assert {"Ren", "Polonsky", "Johnson", "Fritsch", "Zhang"} <= cited


def test_the_hooks_of_pre_commit_are_the_houses_own():
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text())["repos"]
    assert [one["repo"] for one in hooks] == ["local"]  # nothing is fetched
    entries = [hook["entry"] for hook in hooks[0]["hooks"]]
    assert entries == ["tools/format", "tools/subject"]
    for entry in entries:
        assert os.access(ROOT / entry, os.X_OK)
        assert subprocess.run(["bash", "-n", ROOT / entry]).returncode == 0
