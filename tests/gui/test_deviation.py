"""The coloured deviation in FreeCAD's window: it is drawn, and survives save, close and reopen."""

import pytest
from support import pictures
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
    pictures.keep("blade-deviation", (demo / "deviation.png").read_bytes())


def test_the_picture_is_the_manuals(freecad, demo):
    release = freecad.run("import FreeCAD\nprint('release', *FreeCAD.Version()[:2])")
    names = [line.split()[1:] for line in release.splitlines() if line.startswith("release ")]
    pictures.check([int(part) for part in names[-1]], ["blade-deviation"])


def test_unlit_its_colours_are_those_of_the_legend(freecad):
    freecad.run(
        """
from collections import Counter
from support.hands import *

job = prepare()
doc = job.Document
menu("Simulate")
wait(lambda: doc.getObject("Simulation") is not None)
press("Deviation")
press("OK")
view = Gui.ActiveDocument.ActiveView
view.setAnimationEnabled(False)
view.viewTop()
view.fitAll()
settle()

def surface():
    view.saveImage("seen.png", 400, 300, "White")
    image = QtGui.QImage("seen.png")
    pixels = (image.pixelColor(x, y).getRgb()[:3] for x in range(130, 270) for y in range(90, 210))
    return Counter(pixels)

wanted = {tuple(round(255 * c) for c in colour[:3]) for colour in doc.Deviation.VertexColors}
wanted |= {tuple(c + d for c in colour) for colour in wanted for d in (-1, 1)}
provider = doc.Deviation.ViewObject
assert provider.Lit
provider.Lit = False
unlit = surface()
most = [colour for colour, _ in unlit.most_common(3)]
assert any(colour in wanted for colour in most), (most, sorted(wanted)[:3])
provider.Lit = True
assert len(surface()) > 1
doc.saveAs("lit.FCStd")
FreeCAD.closeDocument(doc.Name)
doc = FreeCAD.openDocument("lit.FCStd")
assert doc.Deviation.ViewObject.Lit
doc.Deviation.ViewObject.Lit = False
doc.save()
FreeCAD.closeDocument(doc.Name)
doc = FreeCAD.openDocument("lit.FCStd")
assert not doc.Deviation.ViewObject.Lit
view = Gui.ActiveDocument.ActiveView
view.setAnimationEnabled(False)
view.viewTop()
view.fitAll()
settle()
assert any(colour in wanted for colour, _ in surface().most_common(3))
""",
        window=True,
    )


def test_the_colours_survive_reopening(freecad, demo):
    picture = demo / "reopened.png"
    freecad.run(REOPEN, window=True, DOCUMENT=demo / "deviation.FCStd", PICTURE=picture)
    brown, blue = coloured(picture)
    assert brown > 1000 and blue > 400


def test_the_colours_end_where_the_panel_says(freecad):
    freecad.run(
        """
import numpy as np
from support.hands import *
from beltgrinding.gui.scene.legend import label_values

job = prepare()
doc = job.Document
menu("Simulate")
wait(lambda: doc.getObject("Simulation") is not None)
press("Deviation")
press("OK")
menu("Deviation")
deviation, field_ = doc.Deviation, doc.Simulation.Proxy.field(doc.Simulation)
type_in("ColourLimit", "0.3 mm")
assert deviation.ColourLimit.Value == 0.3
limits = widgets(QtGui.QWidget, "ColourLimit")
field("Bounds").setCurrentIndex(1)  # by tolerance
settle()
assert not any(w.isVisible() for w in limits)
assert abs(deviation.ColourLimit.Value - 0.25) < 1e-9  # 5 x 0.05
type_in("TimesTolerance", "3")
assert abs(deviation.ColourLimit.Value - 0.15) < 1e-9
field("Bounds").setCurrentIndex(2)  # by percentile
settle()
type_in("Percentile", "30")
limit = deviation.ColourLimit.Value
share = field_.areas[np.abs(field_.height) <= limit + 1e-12].sum() / field_.areas.sum()
assert 0.05 < limit < 0.2 and abs(share - 0.3) < 0.01, (limit, share)
type_in("Percentile", "10")
assert abs(deviation.ColourLimit.Value - 1.01 * 0.05) < 1e-9  # outside of the tolerance
type_in("Percentile", "99")
smooth = len(set(deviation.VertexColors))
field("Bands").setValue(4)
settle()
assert smooth > 50 and len(set(deviation.VertexColors)) == 5  # four above and the band
press("OK")
doc.undo()
assert deviation.Bounds == "by hand" and deviation.Bands == 0
assert abs(deviation.ColourLimit.Value - 0.5) < 1e-9

values = label_values(-0.05, 0.05, 0.25, 4)
assert {round(v, 9) for v in values} == {-0.25, -0.2, -0.15, -0.1, -0.05, 0.05, 0.1, 0.15, 0.2, 0.25}
assert len(label_values(-0.001, 0.001, 1.0, 20)) < 32  # not over one another
""",
        window=True,
    )
