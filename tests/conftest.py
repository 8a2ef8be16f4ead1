"""What all Python tests share."""

import os
import sys
from pathlib import Path

import pytest

from support import left_behind, skips

ROOT = Path(__file__).resolve().parents[1]
SLOW = {"robustness", "fuzz", "validation", "library"}  # suites all of whose tests take long

pytest_plugins = ["support.freecad", "support.inside"]


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


def pytest_collection_modifyitems(config, items):
    """With BELTGRINDING_SHARE 2/5, of those that take long only the second of every five is passed."""
    share = os.environ.get("BELTGRINDING_SHARE", "")
    if not share:
        return
    which, parts = (int(number) for number in share.split("/"))

    def name(item):
        return item.nodeid.partition("[")[0]

    def takes_long(item):
        return item.get_closest_marker("slow") or item.path.parent.name in SLOW

    numbers = {one: k for k, one in enumerate(sorted({name(i) for i in items if takes_long(i)}), 1)}
    out = [item for item in items if (numbers.get(name(item), which) - which) % parts]
    if out:
        items[:] = [item for item in items if item not in set(out)]
        config.hook.pytest_deselected(items=out)


def pytest_deselected(items):
    config = items[0].config
    config.left_out = getattr(config, "left_out", 0) + len(items)


def pytest_terminal_summary(terminalreporter, config):
    if getattr(config, "left_out", 0):
        terminalreporter.write_line(f"{config.left_out} tests left out")


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """All workers of xdist leave out the same tests; the session's own process hears of none."""
    node.config.left_out = getattr(node, "workeroutput", {}).get("left_out", 0)


def pytest_sessionstart(session):
    if not hasattr(session.config, "workerinput"):  # once, not by each worker of xdist
        session.config.checkout_before = left_behind.listing(ROOT)


def pytest_sessionfinish(session):
    """Fails the session, with a sentence, if a file was left in the checkout."""
    if hasattr(session.config, "workerinput"):
        session.config.workeroutput["left_out"] = getattr(session.config, "left_out", 0)
        return
    told = left_behind.sentence(session.config.checkout_before, left_behind.listing(ROOT))
    if told:
        print(f"\nFAILED: {told}", file=sys.stderr)
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
