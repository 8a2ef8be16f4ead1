"""What only the controller knows is typed into a program's panel."""

import pytest

BODY = """
import json
from pathlib import Path
from support.hands import *
from beltgrinding.objects import set_up
from beltgrinding.gui.panels.panel import edit
import beltgrinding
start()
doc = FreeCAD.newDocument("work")
part = doc.addObject("Part::Feature", "Block")
part.Shape = Part.makeBox(60, 40, 20)
doc.recompute()
job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
beltgrinding.set_up(job)
doc = job.Document
doc.UndoMode = 1
rows = ["L P[1] 9mm/sec FINE", "L P[2] R[5:speed]mm/sec FINE", "L P[3] 9mm/sec FINE Offset,PR[15]"]
points = "".join(
    f"P[{n}]{{\\n   GP1:\\n\\tUF : F, UT : F,\\t\\tCONFIG : 'N U T, 0, 0, 0',\\n\\tX = {10 * n}.0 mm, "
    "Y = 5.0 mm, Z = 7.0 mm,\\n\\tW = 0.0 deg, P = 0.0 deg, R = 0.0 deg\\n};\\n" for n in (1, 2, 3))
text = "\\n".join(f"{k:4}:{row} ;" for k, row in enumerate(rows, 1))
Path("v.ls").write_text(f"/PROG V\\n/MN\\n{text}\\n/POS\\n{points}/END\\n")
side = Path("v.values.json")
side.unlink(missing_ok=True)  # of the other language
path = set_up.import_program(job, "v.ls")
doc.recompute()
doc.clearUndos()
assert len(path.Poses) == 2, "the third is left out"

def table():
    return field("programValues", QtGui.QTableWidget)

def cells(column):
    return [table().item(i, column).text() for i in range(table().rowCount())]

def tab():
    tabs = field("poseTabs", QtGui.QTabWidget)
    found = [k for k in range(tabs.count()) if tabs.widget(k).findChild(QtGui.QTableWidget, "programValues")]
    return tabs, found[0]

def type_cell(row, text):
    # Opens the cell's editor as a double click does, types and leaves it by Return.
    view = table()
    item = view.item(row, 1)
    view.setCurrentItem(item)
    view.editItem(item)
    (line,) = view.viewport().findChildren(QtGui.QLineEdit)
    line.selectAll()
    line.insert(text)
    key = QtGui.QKeyEvent(QtCore.QEvent.KeyPress, QtCore.Qt.Key_Return, QtCore.Qt.NoModifier)
    QtGui.QApplication.sendEvent(line, key)
    settle()
    assert item.text() == text, item.text()

edit(path)
tabs, at = tab()
tabs.setCurrentIndex(at)
settle()
assert "2" in tabs.tabText(at), tabs.tabText(at)
assert cells(0) == ["R[5]", "PR[15]"] and cells(2) == ["4", "5"] and cells(1) == ["", ""], (cells(0), cells(2))
before = [path.Values, path.Feeds, path.Problems, len(path.Poses)]
for row, text in ((1, "1 2 3"), (1, "1 2 x 0 0 0"), (1, "1 2 1e9 0 0 0"), (0, "fast"), (0, "1e300")):
    type_cell(1 - row, "")
    type_cell(row, text)
    field("applyValues").click()
    settle()
    name = cells(0)[row]
    assert name in field("note").text() and table().currentRow() == row, (text, field("note").text())
    assert before == [path.Values, path.Feeds, path.Problems, len(path.Poses)], text
type_cell(0, "12,5")
type_cell(1, "0 0 2 0 0 0")
field("applyValues").click()
settle()
assert [round(p.Base.z, 9) for p in path.Poses] == [7, 7, 9] and path.Feeds[1] == 12.5
assert not path.Problems, path.Problems
tabs, at = tab()
assert "0" in tabs.tabText(at) and tabs.currentIndex() == at and cells(1) == ["12.5", "0 0 2 0 0 0"]
assert not side.exists(), "only when asked"
areas = [a for a in visible(QtGui.QScrollArea) if a.findChildren(QtGui.QDialogButtonBox)]
over = {w.objectName() or type(w).__name__: w.minimumSizeHint().width() for a in areas
        for w in a.findChildren(QtGui.QWidget) if w.isVisible() and w.minimumSizeHint().width() > 200}
assert areas and not any(a.horizontalScrollBar().maximum() for a in areas), over
press("OK")
assert doc.UndoCount == 1
doc.undo()
assert len(path.Poses) == 2 and not path.Values
doc.redo()
assert len(path.Poses) == 3 and json.loads(path.Values)["variables"]["R[5]"] == 12.5
doc.recompute()

file = str(Path("v.FCStd").resolve())
doc.saveAs(file)
FreeCAD.closeDocument(doc.Name)
doc = FreeCAD.openDocument(file)
path = [o for o in doc.Objects if str(getattr(o, "Source", "")).endswith("v.ls")][0]
edit(path)
tabs, at = tab()
tabs.setCurrentIndex(at)
assert cells(1) == ["12.5", "0 0 2 0 0 0"]
type_cell(0, "")  # not known any more
field("saveValues").click()
settle()
data = json.loads(side.read_text())
assert data["variables"] == {"R[5]": None, "PR[15]": {"x_mm": 0, "y_mm": 0, "z_mm": 2, "a_deg": 0, "b_deg": 0, "c_deg": 0}}
press("Cancel" if LANGUAGE == "en" else "Abbrechen")
assert json.loads(path.Values)["variables"]["R[5]"] == 12.5 and side.exists()

job = [o for o in doc.Objects if o.Name == "BeltGrindingJob"][0]
again = set_up.import_program(job, "v.ls")  # the file beside it is read
assert not again.Values and len(again.Poses) == 3
edit(again)
tabs, at = tab()
tabs.setCurrentIndex(at)
assert cells(1) == ["", "0 0 2 0 0 0"], cells(1)
press("OK")
"""
GERMAN = """
import FreeCAD
general = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/General")
general.SetString("Language", "German")
FreeCAD.saveParameter("User parameter")
"""


@pytest.mark.parametrize("language", ["en", "de"])
def test_values_are_typed_kept_and_saved_where_asked(freecad, language):
    body = BODY.replace("LANGUAGE", repr(language))
    if language == "de":
        freecad.run(GERMAN)
    freecad.run(body, window=True, fresh=language == "de")
