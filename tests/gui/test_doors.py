"""FreeCAD with the workbench listens nowhere, also while a study runs from its panel."""

import os
import tempfile

import pytest
from PySide import QtGui

from support import doors as sockets
from support.hands import field, menu, prepare, press, type_in, visible, wait
from support.workers import worker_processes

pytestmark = pytest.mark.freecad(window=True)


def test_freecad_listens_nowhere():
    pytest.importorskip("openturns")

    def doors():
        # FreeCAD has one of its own, by which another FreeCAD of the same user hands it files.
        own = os.path.join(tempfile.gettempdir(), "FreeCAD")
        return {one for one in sockets.doors(os.getpid()) if not one.endswith(f": unix {own}")}

    job = prepare()
    doc = job.Document
    job.Spacing = "1 mm"
    doc.recompute()
    assert not doors(), doors()
    menu("Study...")
    study = doc.Study
    field("studyKeys", QtGui.QComboBox).setEditText("belt_machine.force_N")
    press("Add")
    type_in("variedValues1", "20 60")
    field("Runs", QtGui.QSpinBox).setValue(24)
    field("Workers", QtGui.QSpinBox).setValue(2)
    press("Run")
    found, workers = set(), set()

    def over():
        found.update(doors())
        workers.update(worker_processes(os.getpid()))
        return study.Fingerprint

    wait(over, 250)
    assert study.RunsDone == 24
    assert not found, found
    assert len(workers) >= 3, workers  # two, and the one of OpenTURNS
    assert not worker_processes(os.getpid())
    press("Close")
    menu("Simulate")
    wait(lambda: not visible(QtGui.QPushButton, "Cancel"), 60)
    assert not doors(), doors()
