"""Every panel fits the dock as FreeCAD opens it on a small screen, in English and in German."""

import json
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtGui

import beltgrinding
from support import freecad as windows
from support.cut_off import cut_off
from support.hands import field, settle, start, visible, widgets
from support.restoring import speak


@pytest.mark.slow
@pytest.mark.parametrize("language", ["English", "German"])
def test_panels_fit_a_small_screen(tmp_path, monkeypatch, language):
    monkeypatch.setattr(windows, "SHOWN", 60000)
    monkeypatch.setattr(windows, "SCREEN", "-screen 0 1366x768x24")
    freecad = windows.FreeCad(tmp_path)
    if language == "German":
        freecad.call(speak, "German")
    freecad.call(panels, window=True, fresh=True)
    assert "Traceback" not in freecad.output, freecad.output


def panels():
    start()
    doc = FreeCAD.newDocument("work")
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
    beltgrinding.set_up(job)
    beltgrinding.make_belt(job)
    beltgrinding.import_program(job, "pass.csv")
    beltgrinding.make_raster(job)
    beltgrinding.simulate(job)
    beltgrinding.make_deviation(job)
    # Programs that ask for what only the controller knows: one has a path without it, one has none yet.
    line = "LIN {X %d,Y 0,Z 30,A 0,B 0,C 180}\n"
    asked = (
        "LIN XAPPROACH_OF_FIXTURE_LEFT\n$BASE=BASE_DATA[17]\n"
        + line % 7
        + "LIN_REL {Z STEPOVER_OF_THE_LAST_ROW}\n"
    )
    Path("some.src").write_text("DEF some()\n" + line % 1 + line % 2 + asked + "END\n")
    Path("none.src").write_text("DEF none()\n" + asked + "END\n")
    Path("some.values.json").write_text(
        json.dumps(
            {
                "bases": {
                    "BASE_DATA[17]": dict(
                        zip(
                            ("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg"),
                            (1234.5678, -2345.6789, 3456.789, 123.45678, -89.98765, 179.1234),
                        )
                    )
                }
            }
        )
    )
    programs = [beltgrinding.import_program(job, name) for name in ("some.src", "none.src")]
    assert (
        len(programs[0].Poses) >= 2
        and len(programs[1].Poses) < 2
        and all(p.Asked for p in programs)
    )
    assert QtGui.QGuiApplication.primaryScreen().size().width() <= 1368
    wide, short = {}, {}

    def buttons(area):
        return area.findChildren(QtGui.QDialogButtonBox)

    def look(name):
        settle()
        assert Gui.Control.activeDialog(), name
        # FreeCAD 1.0 has other areas besides, on its start page.
        panels = [
            area for area in visible(QtGui.QScrollArea) if any(b.isVisible() for b in buttons(area))
        ]
        assert panels, name
        over = max([area.horizontalScrollBar().maximum() for area in panels], default=0)
        if over > 0:
            wide[name] = over, sorted(
                (
                    w.minimumSizeHint().width(),
                    type(w).__name__,
                    w.objectName(),
                    getattr(w, "text", str)(),
                )
                for area in panels
                for w in area.widget().findChildren(QtGui.QWidget)
                if w.isVisible() and w.minimumSizeHint().width() > 150
            )
        for area in panels:
            if found := cut_off(area):
                short[name] = found
        view = Gui.getDocument(doc.Name)
        view.resetEdit() if view.getInEdit() else Gui.Control.closeDialog()
        settle()

    for name in (
        "BeltGrindingJob",
        "Stock",
        "BeltMachine",
        "RobotPath",
        "RasterPath",
        "Deviation",
        "Belt",
    ):
        view = doc.getObject(name).ViewObject
        view.Proxy.doubleClicked(view)
        look(name)
    for kind in ("free_belt", "platen", "small_wheel"):
        doc.BeltMachine.Kind = kind
        doc.BeltMachine.PlatenLayers = json.dumps(
            [{"thickness_mm": 12.345, "youngs_modulus_MPa": 2.3456, "poissons_ratio": 0.4567}]
        )
        view = doc.BeltMachine.ViewObject
        view.Proxy.doubleClicked(view)
        look(kind)
    doc.BeltMachine.Kind = "contact_wheel"
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    field("foldHeat").click()
    field("thermalPreset", QtGui.QComboBox).setCurrentIndex(5)
    look("heat")
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    field("foldFinish").click()
    field("finishChoice", QtGui.QComboBox).setCurrentIndex(1)
    look("finish")
    for program in programs:
        view = program.ViewObject
        view.Proxy.doubleClicked(view)
        settle()
        tabs = field("poseTabs", QtGui.QTabWidget)
        page = (
            field("programValues")
            if len(program.Poses) < 2
            else tabs.findChild(QtGui.QTableWidget, "programValues")
        )
        tabs.setCurrentIndex(
            [k for k in range(tabs.count()) if tabs.widget(k).isAncestorOf(page)][0]
        )
        settle()
        assert page.isVisible() and page.rowCount() >= 2, page.rowCount()
        look(program.Label)
    for program in programs:
        doc.removeObject(program.Name)
    beltgrinding.make_plan(job, Rounds=1, Check=False, ForceMax="40 N")
    varied = [
        {"key": "belt_machine.force_dynamics.overshoot_limit", "range": [0.123456, 1.234567]},
        {"key": "belt_machine.force_dynamics.rate_limit_N_s", "range": [0.123456, 1.234567]},
    ]
    pairs = [{"between": [one["key"] for one in varied], "coefficient": -0.123456789}]
    asked = {
        "best": {
            "figure": "lost_volume_mm3",
            "limits": {"lost_volume_mm3": [-0.123456789, 123456.789]},
        }
    }
    beltgrinding.make_study(
        job, compute=False, Vary=varied, Correlations=pairs, Asked=asked, Runs=1000000
    )
    for command in (
        "Plan",
        "Study",
        "Cell",
        "Simulate",
        "Contact",
        "Calibrate",
        "Zones",
        "CheckSettings",
        "Scan",
        "BeltPlan",
        "RobotProgram",
    ):
        Gui.runCommand("BeltGrinding_" + command)
        look(command)
    docks = set()
    for command in ("Verdict", "Section", "Playback"):
        Gui.runCommand("BeltGrinding_" + command)
        settle()
        for dock in visible(QtGui.QDockWidget):
            if dock.objectName().startswith("BeltGrinding_"):
                docks.add(dock.objectName())
                if found := cut_off(dock):
                    short[dock.objectName()] = found
                dock.close()
        settle()
    assert not wide, wide
    assert len(docks) == 3, docks
    told = [f"{where}: {one}" for where, found in short.items() for one in found]
    assert not short, "\n".join(told)
    # Panels that went while they worked have left nothing behind.
    assert not [w for w in widgets(QtGui.QWidget, "BeltGrinding_Progress") if w.isVisible()]
