"""The texts of the window: all marked so that they can be translated, all translated."""

import json
import subprocess
import sys
import xml.etree.ElementTree as tree

import pytest
from support import texts
from support.freecad import ROOT

SOURCES = ROOT / "Mod" / "BeltGrinding"
FILES = sorted((ROOT / "Resources" / "messages").glob("*.json"))
MAKER = ROOT / "cmake" / "window_catalogue.py"


def test_every_text_is_translated_and_its_placeholders_fit():
    assert [path.name for path in FILES] == ["de.json"]
    assert len(texts.marked(SOURCES)) > 300
    for path in FILES:
        assert texts.mistakes(SOURCES, path) == []


def test_what_is_missing_or_does_not_fit_is_found(tmp_path):
    source = tmp_path / "module.py"
    source.write_text('translate("A", "{} mm, " "{:.1f} s")\ntranslate("A", "new")\n')
    file = tmp_path / "x.json"
    file.write_text(
        json.dumps({"window": {"A": {"{} mm, {:.1f} s": "{} mm, {} s", "gone": "fort"}}})
    )
    wrong = "\n".join(texts.mistakes(tmp_path, file))
    assert "module.py:1" in wrong and "other placeholders" in wrong
    assert "module.py:2: no translation of 'new'" in wrong
    assert "'gone' is no longer used" in wrong
    source.write_text('translate("A", "{} mm, " "{:.1f} s")\n')
    file.write_text(json.dumps({"window": {"A": {"{} mm, {:.1f} s": "{:.1f} s, {} mm"}}}))
    assert texts.mistakes(tmp_path, file) == []
    file.write_text(json.dumps({"window": {"A": {"{} mm, {:.1f} s": ""}}}))
    assert texts.mistakes(tmp_path, file)


def test_qt_is_given_every_text_as_it_is(tmp_path):
    held = {"A": {'a <b> & "c"\n': "ä <b> & „c“\n", " 3 ": " drei "}, "B": {" 3 ": "3"}}
    source, made = tmp_path / "de.json", tmp_path / "de.ts"
    source.write_text(json.dumps({"window": held, "some.code": "x"}), encoding="utf-8")
    subprocess.run([sys.executable, MAKER, source, made], check=True)
    found = {}
    for context in tree.parse(made).getroot().iter("context"):
        for one in context.iter("message"):
            told = found.setdefault(context.findtext("name"), {})
            told[one.findtext("source")] = one.findtext("translation")
    assert found == held


def test_a_text_that_is_no_literal_is_refused(tmp_path):
    (tmp_path / "module.py").write_text('translate("A", TITLES[0])\n')
    with pytest.raises(ValueError, match="module.py:1"):
        texts.marked(tmp_path)
