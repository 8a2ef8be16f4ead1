"""The coloured deviation in FreeCAD's window: it is drawn, and survives save, close and reopen."""

import pytest
from support.freecad import ROOT
from support.picture import coloured

REOPEN = """
import os
import FreeCAD
import FreeCADGui
doc = FreeCAD.openDocument(os.environ["DOCUMENT"])
deviation = doc.getObject("Deviation")
assert len(deviation.VertexColors) == deviation.Mesh.CountPoints > 0
assert deviation.ViewObject.Coloring
assert deviation.InTolerance > 0 and deviation.Maximum > deviation.Minimum
assert not doc.getObject("Simulation").OutOfDate
FreeCADGui.updateGui()
FreeCADGui.ActiveDocument.ActiveView.saveImage(os.environ["PICTURE"], 400, 300, "White")
"""


@pytest.fixture(scope="module")
def demo(freecad, tmp_path_factory):
    out = tmp_path_factory.mktemp("demo")
    script = (ROOT / "tools" / "demo_document.py").read_text()
    freecad.run(script, window=True, BELTGRINDING_OUT=out)
    return out


def test_the_picture_shows_both_ramps(demo):
    brown, blue = coloured(demo / "deviation.png")
    assert brown > 30000 and blue > 20000


def test_the_colours_survive_reopening(freecad, demo):
    picture = demo / "reopened.png"
    freecad.run(REOPEN, window=True, DOCUMENT=demo / "deviation.FCStd", PICTURE=picture)
    brown, blue = coloured(picture)
    assert brown > 1000 and blue > 400
