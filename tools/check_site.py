"""check_site.py FOLDER: looks at every page of a site of static pages.

Each link to a page, picture, script or style sheet of the site must find its file, and its anchor
there; each page must be reached from index.html; and nothing may be fetched from elsewhere: a site
that is read without the net must look the same. Links that a reader may follow to other sites are
let be.
"""

import argparse
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Attributes whose address a browser fetches by itself; of the others a reader decides.
FETCHED = {
    *{(tag, "src") for tag in ("img", "script", "iframe", "audio", "video", "source", "embed")},
    *{
        ("link", "href"),
        ("object", "data"),
        ("image", "href"),
        ("use", "href"),
        ("image", "xlink:href"),
    },
}
FOLLOWED = {("a", "href"), ("area", "href"), ("a", "xlink:href")}
IN_STYLE = re.compile(r"url\(\s*['\"]?([^'\")]+)['\"]?\s*\)|@import\s+['\"]([^'\"]+)['\"]")
IN_SCRIPT = re.compile(r"['\"]((?:https?:)?//[^'\"\s]+\.(?:js|css|json|woff2?|ttf|png|svg))['\"]")
UNLINKED = ("404.html", "search.html")  # shown by a server, or by the search box


class Page(HTMLParser):
    """The addresses and anchors of one page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.fetched, self.anchors, self._raw = [], [], {"", "top"}, None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        given = {name: value or "" for name, value in attributes}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        for name, value in given.items():
            if (tag, name) in FETCHED and given.get("rel") not in ("canonical", "next", "prev"):
                self.fetched.append(value)
            elif (tag, name) in FOLLOWED:
                self.links.append(value)
            elif name == "srcset":
                self.fetched += [part.split()[0] for part in value.split(",") if part.strip()]
            elif name == "style":
                self.fetched += in_style(value)
        self._raw = tag if tag in ("style", "script") else None

    def handle_endtag(self, tag):
        self._raw = None

    def handle_data(self, data):
        if self._raw == "style":
            self.fetched += in_style(data)
        elif self._raw == "script":
            self.fetched += IN_SCRIPT.findall(data)


def in_style(text):
    """Addresses that a style sheet fetches."""
    return ["".join(found) for found in IN_STYLE.findall(text)]


def read(path):
    """The Page of a file."""
    return Page(path.read_text("utf-8", errors="replace"))


def check(folder):
    """Sentences on what is wrong with the site in ``folder``. Raises OSError."""
    folder = folder.resolve()
    pages = {path: read(path) for path in sorted(folder.rglob("*.html"))}
    if folder / "index.html" not in pages:
        return ["index.html is missing"]
    wrong, reached = [], {path: set() for path in pages}

    def look(path, address, fetched):
        """The file that an address in ``path`` names, None if there is nothing to look for."""
        parts = urlsplit(address)
        here = path.relative_to(folder)
        if parts.scheme in ("data", "javascript") or (
            not fetched and (parts.scheme or parts.netloc)
        ):
            return None
        if parts.scheme or parts.netloc:
            wrong.append(f"{here} would fetch {address}")
            return None
        base = folder if parts.path.startswith("/") else path.parent
        target = Path(base, unquote(parts.path).lstrip("/")).resolve() if parts.path else path
        if target.is_dir():
            target = target / "index.html"
        if folder not in target.parents or not target.is_file():
            wrong.append(f"{here} leads to {address}, which is not there")
            return None
        anchor = unquote(parts.fragment)
        if target in pages and not fetched and anchor not in pages[target].anchors:
            wrong.append(f"{here} leads to {address}, which has no such anchor")
        return target

    for path, page in pages.items():
        for address in page.fetched:
            look(path, address, True)
        for address in page.links:
            reached[path].add(look(path, address, False))
    for path in sorted(folder.rglob("*.css")):
        for address in in_style(path.read_text("utf-8", errors="replace")):
            look(path, address.partition("#")[0] or path.name, True)
    for path in sorted(folder.rglob("*.js")):
        for address in IN_SCRIPT.findall(path.read_text("utf-8", errors="replace")):
            look(path, address, True)
    seen, to_do = set(), [folder / "index.html"]
    while to_do:
        path = to_do.pop()
        if path not in seen:
            seen.add(path)
            to_do += [target for target in reached[path] if target in pages]
    for path in pages:
        if path not in seen and path.name not in UNLINKED and path.parent == folder:
            wrong.append(f"{path.relative_to(folder)} is reached from no page")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    wrong = check(parser.parse_args().folder)
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
