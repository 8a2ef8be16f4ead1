"""count.py REPORT...: the figures of JUnit reports, as "N passed, N failed, N skipped"."""

import sys
import xml.etree.ElementTree as tree


def count(paths):
    """(passed, failed, skipped). Raises OSError, xml.etree.ElementTree.ParseError."""
    passed = failed = skipped = 0
    for path in paths:
        for case in tree.parse(path).iter("testcase"):
            if case.find("failure") is not None or case.find("error") is not None:
                failed += 1
            elif case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
                skipped += 1
            else:
                passed += 1
    return passed, failed, skipped


if __name__ == "__main__":
    print("{} passed, {} failed, {} skipped".format(*count(sys.argv[1:])))
