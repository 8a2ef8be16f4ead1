"""Which tests may skip: tests/allowed_skips.toml. Where ``strict()``, any other skip is a failure.

    python3 tests/support/skips.py REPORT...

names, where it is strict, the skips of JUnit reports that are not allowed, and ends with 1 if there
are any.
"""

import fnmatch
import os
import re
import sys
import tomllib
import xml.etree.ElementTree as tree
from pathlib import Path
from typing import NamedTuple

LIST = Path(__file__).resolve().parents[1] / "allowed_skips.toml"
SHARED = Path(os.environ.get("BELTGRINDING_SHARED", LIST.parents[2] / "shared"))
NOT_RUN = ("notrun", "disabled")  # ctest's states of a test that skips


class Allowed(NamedTuple):
    """A kind of skip that may be; see the head of allowed_skips.toml."""

    test: str
    says: str
    why: str
    without: str = ""


def strict(environment=os.environ):
    """Whether a skip that is not on the list is a failure: in CI, or where it is asked for."""
    asked = environment.get("BELTGRINDING_STRICT") or environment.get("CI") or ""
    return asked.lower() not in ("", "0", "false", "no")


def allowed(path=LIST):
    """The list. Raises TypeError where an entry lacks a key or has another."""
    entries = [Allowed(**entry) for entry in tomllib.loads(path.read_text("utf-8"))["skip"]]
    for entry in entries:
        re.compile(entry.says)
    return entries


def unexpected(test, reason, entries=None, shared=SHARED):
    """A sentence on a skip that is not on the list, "" for one that is."""
    for entry in allowed() if entries is None else entries:
        here = not entry.without or not (shared / entry.without).is_dir()
        if here and fnmatch.fnmatchcase(test, entry.test) and re.search(entry.says, reason):
            return ""
    return f"{test} skipped, and that is not in {LIST.parent.name}/{LIST.name}: {reason}"


def in_report(path, entries=None, shared=SHARED):
    """Sentences on the unexpected skips of a JUnit report."""
    found = []
    for case in tree.parse(path).iter("testcase"):
        told = case.find("skipped")
        if told is None and case.get("status") not in NOT_RUN:
            continue
        said = (told.get("message") or "") + (told.text or "") if told is not None else ""
        reason = " ".join((said + (case.findtext("system-out") or "")).split())
        sentence = unexpected(case.get("name"), reason, entries, shared)
        if sentence:
            found.append(sentence)
    return found


if __name__ == "__main__":
    reports = [path for path in sys.argv[1:] if strict() and Path(path).is_file()]
    wrong = [sentence for path in reports for sentence in in_report(path)]
    print("\n".join(wrong), end="\n" if wrong else "")
    sys.exit(1 if wrong else 0)
