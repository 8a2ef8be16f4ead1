"""One version everywhere: package.xml has it; the changelog, the citation and the manual agree."""

import datetime
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as tree

import yaml

from support.freecad import ROOT

WIKI = "{https://wiki.freecad.org/Package_Metadata}"
PACKAGE = tree.parse(ROOT / "package.xml").getroot()
VERSION, DATE = PACKAGE.findtext(WIKI + "version"), PACKAGE.findtext(WIKI + "date")
GROUPS = [
    "Before you upgrade", "Programs", "Planning", "Robot", "Window", "Command line", "Packages", "Accuracy",
]  # fmt: skip
MOST_WORDS = 1000  # of a release: two pages


def releases():
    """[(version, date, text)] of the changelog."""
    text = (ROOT / "CHANGELOG.md").read_text("utf-8")
    assert re.findall(r"^## (.*)$", text, re.M)[0] == "Unreleased"
    return re.findall(r"^## (\S+) - (\S+)\n(.*?)(?=^## |\Z)", text, re.M | re.S)


def test_the_newest_release_of_the_changelog_is_this_one():
    found = releases()
    assert found[0][:2] == (VERSION, DATE)
    numbers = [tuple(int(part) for part in version.split(".")) for version, _, _ in found]
    dates = [datetime.date.fromisoformat(date) for _, date, _ in found]
    assert numbers == sorted(set(numbers), reverse=True) and dates == sorted(dates, reverse=True)


def test_each_release_is_two_pages_of_entries_that_lead_to_their_pages():
    for version, _, text in releases():
        assert len(text.split()) <= MOST_WORDS, version
        groups = re.findall(r"^### (.*)$", text, re.M)
        assert groups == [one for one in GROUPS if one in groups], version
        for line in filter(None, text.splitlines()):
            assert re.match("### |- ", line), line
            assert line.startswith("###") or re.search(r"\]\((docs/|CONTRIBUTING)", line), line


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
    for page, word in (
        ("docs/install.md", r"[Bb]elt[Gg]rinding[-_]"),
        ("README.md", "BeltGrinding-"),
        ("docs/index.md", "[Vv]ersion "),
        ("mkdocs.yml", "Version "),
    ):
        named = re.findall(word + r"(\d[\d.]*\d)", (ROOT / page).read_text("utf-8"))
        assert named and set(named) == {VERSION}, page


def test_the_next_release_is_one_command(tmp_path):
    names = "package.xml CITATION.cff CHANGELOG.md README.md mkdocs.yml docs tools/release".split()
    for name in names:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        (tmp_path / name).parent.mkdir(exist_ok=True)
        copy(ROOT / name, tmp_path / name)

    def release(*words):
        command = [tmp_path / "tools" / "release", *words]
        return subprocess.run(command, capture_output=True, text=True)

    assert release("98.76.5", "2031-02-03").returncode == 0
    for path in map(tmp_path.joinpath, names[:-2] + ["docs/install.md", "docs/index.md"]):
        text = path.read_text("utf-8")
        assert "98.76.5" in text and (path.name == "CHANGELOG.md" or VERSION not in text), path
    assert "## Unreleased\n\n## 98.76.5 - 2031-02-03\n" in (tmp_path / names[2]).read_text("utf-8")
    assert "find_package(BeltGrinding 98.76 " in (tmp_path / "docs/library.md").read_text("utf-8")
    again = release("98.76.5")
    assert again.returncode == 1 and "98.76.5 already" in again.stderr
    assert release("98.76").returncode == 2


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
