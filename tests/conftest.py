"""What all Python tests share."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
for folder in (ROOT / "Mod" / "BeltGrinding", ROOT / "tests"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

from support import skips  # noqa: E402
from support.freecad import freecad  # noqa: E402, F401


def _judged(report):
    """The report, a failure if it is a skip that may not be."""
    if report.skipped and not hasattr(report, "wasxfail") and skips.strict():
        told = report.longrepr
        reason = told[2] if isinstance(told, tuple) else str(told)
        sentence = skips.unexpected(report.nodeid, reason)
        if sentence:
            report.outcome, report.longrepr = "failed", sentence
    return report


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport():
    _judged((yield).get_result())


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report():
    _judged((yield).get_result())
