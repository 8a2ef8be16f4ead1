"""The texts of the window: all marked so that they can be translated, all translated."""

import pytest
from support import texts
from support.freecad import ROOT

SOURCES = ROOT / "Mod" / "BeltGrinding"
FILES = sorted((ROOT / "Resources" / "translations").glob("BeltGrinding_*.ts"))
TS = """<?xml version="1.0"?><TS><context><name>A</name>
<message><source>{} mm, {:.1f} s</source><translation>%s</translation></message>
<message><source>gone</source><translation>fort</translation></message>
</context></TS>"""


def test_every_text_is_translated_and_its_placeholders_fit():
    assert [path.name for path in FILES] == ["BeltGrinding_de.ts"]
    assert len(texts.marked(SOURCES)) > 300
    for path in FILES:
        assert texts.mistakes(SOURCES, path) == []


def test_what_is_missing_or_does_not_fit_is_found(tmp_path):
    source = tmp_path / "module.py"
    source.write_text('translate("A", "{} mm, " "{:.1f} s")\ntranslate("A", "new")\n')
    file = tmp_path / "x.ts"
    file.write_text(TS % "{} mm, {} s")
    wrong = "\n".join(texts.mistakes(tmp_path, file))
    assert "module.py:1" in wrong and "other placeholders" in wrong
    assert "module.py:2: no translation of 'new'" in wrong
    assert "'gone' is no longer used" in wrong
    source.write_text('translate("A", "{} mm, " "{:.1f} s")\n')
    file.write_text((TS % "{:.1f} s").replace("gone", "{} mm, {:.1f} s"))
    assert texts.mistakes(tmp_path, file)


def test_a_text_that_is_no_literal_is_refused(tmp_path):
    (tmp_path / "module.py").write_text('translate("A", TITLES[0])\n')
    with pytest.raises(ValueError, match="module.py:1"):
        texts.marked(tmp_path)
