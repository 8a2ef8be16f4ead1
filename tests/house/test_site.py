"""The manual as static pages: it builds without a warning, and its checker sees what it is for."""

import re
import shutil
import subprocess

import pytest

from support import browser
from support.freecad import ROOT

from check_site import check

INDEX = '<h1 id="top-of-it">T</h1><a href="a.html#here">a</a><a href="https://x.org/">x</a>{}'
OTHER = '<p id="here"><a href="index.html#top-of-it">back</a><a href="#here">self</a>'


@pytest.fixture
def site(tmp_path):
    def make(addition="", **files):
        (tmp_path / "index.html").write_text(INDEX.format(addition))
        (tmp_path / "a.html").write_text(OTHER)
        for name, text in files.items():
            (tmp_path / name.replace("_", ".")).write_text(text)
        return check(tmp_path)

    return make


def test_a_sound_site_passes(site):
    sound = '<img src="p.png"><a href="p.png">p</a><a href="mailto:a@b.org">m</a><a href="">i</a>'
    sound += (
        '<link rel="canonical" href="https://x.org/index.html"><a name="n"></a><a href="#n">n</a>'
    )
    assert site(sound, p_png="", s_css="a { background: url('p.png') } b { c: url(data:x) }") == []


@pytest.mark.parametrize(
    "addition, sentence",
    [
        ('<a href="b.html">b</a>', "index.html leads to b.html, which is not there"),
        ('<a href="a.html#no">b</a>', "index.html leads to a.html#no, which has no such anchor"),
        ('<a href="#no">b</a>', "index.html leads to #no, which has no such anchor"),
        ('<img src="no.png">', "index.html leads to no.png, which is not there"),
        ('<a href="../outside.html">b</a>', "index.html leads to ../outside.html, which is not"),
        ('<script src="https://x.org/a.js"></script>', "index.html would fetch https://x.org/a.js"),
        ('<link rel="stylesheet" href="//x.org/f">', "index.html would fetch //x.org/f"),
        ("<style>@import 'http://x.org/f.css'</style>", "would fetch http://x.org/f.css"),
        ('<p style="background:url(http://x.org/a)">', "would fetch http://x.org/a"),
        ('<script>load("https://x.org/m.min.js")</script>', "would fetch https://x.org/m.min.js"),
    ],
)
def test_a_fault_is_told(site, addition, sentence):
    (told,) = site(addition)
    assert sentence in told


def test_faults_outside_of_the_pages_are_told(site):
    (told,) = site(s_css="@font-face { src: url(https://x.org/f.woff) }")
    assert told == "s.css would fetch https://x.org/f.woff"
    (told,) = site(s_css="", s_js="import('https://x.org/f.js')")
    assert told == "s.js would fetch https://x.org/f.js"
    (told,) = site(s_js="", lost_html="<p>nobody leads here</p>")
    assert told == "lost.html is reached from no page"


def test_a_site_without_a_first_page_is_a_fault(tmp_path):
    assert check(tmp_path) == ["index.html is missing"]


def test_the_menu_names_every_page_of_the_manual():
    listed = re.findall(r": ([\w-]+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE)
    pages = {path.name for path in (ROOT / "docs").glob("*.md")}
    assert len(listed) == len(set(listed))
    assert pages <= set(listed)


@pytest.fixture(scope="module")
def site_built():
    """The folder of the site, just built."""
    assert shutil.which("mkdocs"), "mkdocs is not installed"
    done = subprocess.run([ROOT / "tools" / "docs"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == str(ROOT / "build" / "site" / "index.html")
    return ROOT / "build" / "site"


def test_the_site_shows_every_picture(site_built):
    pictures = {path.name for path in (ROOT / "docs" / "images").glob("*.png")}
    shown = set()
    for page in site_built.glob("*.html"):
        shown |= set(re.findall(r'src="images/([\w-]+\.png)"', page.read_text()))
    assert pictures - shown <= {"tap.png"}  # that one is the README's


FREE = re.compile(
    r"^(?!using|namespace|struct|class|enum|template)\w[\w:<>,&* ]*[ &*](\w+)\(", re.M
)


def test_the_library_s_functions_are_on_its_pages(site_built):
    """Each class and each function outside of classes of every public header."""
    headers = sorted((ROOT / "src").glob("*/include/beltgrinding/*.h"))
    assert len(headers) > 20
    for header in headers:
        text = header.read_text("utf-8")
        wanted = set(re.findall(r"^(?:struct|class) (\w+)(?: final)?(?: : .*)? \{", text, re.M))
        wanted |= set(FREE.findall(text))
        page = (site_built / "api" / f"{header.stem}.html").read_text("utf-8")
        assert wanted and wanted <= set(re.findall(r'<h2 id="[\w-]+">([\w:]+)', page)), header.name


@pytest.mark.skipif(browser.program() is None, reason="Chromium is not installed")
def test_the_search_works_from_the_folder(site_built):
    found = "[...document.querySelectorAll('.md-search-result__link')].map(a => a.href)"
    with browser.Browser(webgl=False) as chromium:
        page = chromium.open(f"{site_built}/languages/krl.html?q=contact_frame")
        page.wait(f"{found}.length")
        assert (
            f"file://{site_built}/api/tool_path.html?h=contact_frame#contact_frame"
            in page.value(found)
        )
        assert not page.faults
