"""docs/languages/statements.md says what the readers' tables say."""

import importlib.machinery
import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def tool():
    loader = importlib.machinery.SourceFileLoader("statements", str(ROOT / "tools" / "statements"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("statements", loader))
    loader.exec_module(module)
    return module


def test_the_page_is_that_of_the_code():
    statements = tool()
    assert statements.PAGE.read_text() == statements.page(), "run tools/statements"


@pytest.mark.parametrize("name, mine", tool().statements().items())
def test_no_statement_is_in_two_groups(name, mine):
    seen = {}
    for group, _ in tool().GROUPS:
        for word in getattr(mine, group):
            assert seen.setdefault(word.lower(), group) == group, word
    assert len(seen) > 5
