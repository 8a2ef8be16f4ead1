"""The start of the workbench where something is missing, and its manual."""

import shutil
import sys

import pytest
import FreeCADGui as Gui
import Part
from PySide import QtCore, QtGui

from beltgrinding.gui import manual
from support.freecad import FreeCad, MOD, ROOT
from support.hands import field, menu, press, settle, visible, widgets


def choose():
    Gui.activateWorkbench("BeltGrindingWorkbench")
    settle()
    boxes = visible(QtGui.QMessageBox, "BeltGrinding_Error")
    report = widgets(QtGui.QTextEdit, "Report view")[0].toPlainText()
    return boxes, report


@pytest.fixture
def release(tmp_path):
    """A FreeCAD with an unpacked release that has no core yet; (FreeCad, its folder)."""
    freecad = FreeCad(tmp_path, link=False)
    folder = tmp_path / ".local" / "share" / "FreeCAD" / "Mod" / "BeltGrinding-0.1.0"
    shutil.copytree(MOD, folder, ignore=shutil.ignore_patterns("__pycache__", "*.so*"))
    for name in ("Resources", "docs"):
        shutil.copytree(ROOT / name, folder / name)
    return freecad, folder


def chosen(release, function, *arguments):
    freecad, folder = release
    variables = {"PYTHONPATH": folder, "BELTGRINDING_BUILD": ""}
    freecad.call(function, *arguments, window=True, fresh=True, variables=variables)


@pytest.mark.slow
def test_a_core_for_another_python_is_named_with_the_way_out(release):
    core = release[1] / "beltgrinding_core.cpython-37m-x86_64-linux-gnu.so"
    core.write_bytes(b"\x7fELF of another time")
    core.with_name(core.name + ".json").write_text(
        '{"system": "Debian GNU/Linux 10 (buster)", "python": "3.7", "opencascade": "7.3.0"}'
    )
    chosen(release, another_python)


@pytest.mark.slow
def test_a_core_that_the_loader_refuses_says_why(release):
    import importlib.machinery

    suffix = importlib.machinery.EXTENSION_SUFFIXES[0]
    (release[1] / f"beltgrinding_core{suffix}").write_bytes(b"no library at all")
    chosen(release, refused_by_the_loader, suffix)


@pytest.mark.slow
def test_a_core_for_another_opencascade_is_refused_before_it_is_loaded(release):
    import importlib.machinery

    core = release[1] / f"beltgrinding_core{importlib.machinery.EXTENSION_SUFFIXES[0]}"
    core.write_bytes(b"never looked at")
    core.with_name(core.name + ".json").write_text('{"opencascade": "6.9.1"}')
    chosen(release, another_opencascade)


@pytest.mark.slow
def test_a_missing_python_package_is_named(release):
    (release[1] / "jsonschema.py").write_text(
        "raise ModuleNotFoundError(\"No module named 'jsonschema'\", name='jsonschema')\n"
    )
    built = ROOT / "build" / "release" / "python"
    cores = list(built.glob("beltgrinding_core*.so*"))
    if not cores:
        pytest.skip("the core is not built in this checkout")
    for core in cores:
        shutil.copy(core, release[1])
    chosen(release, a_package_is_missing)


@pytest.mark.freecad(window=True)
def test_the_manual_leads_from_page_to_page_and_shows_its_pictures():
    Gui.activateWorkbench("BeltGrindingWorkbench")
    manual.show_manual("workbench-run.md")  # as F1 does; Contents does not lead there
    menu("Help")
    view = field("BeltGrinding_ManualView")
    home = view.toPlainText()
    view.setSource(view.source().resolved(QtCore.QUrl("workbench-job.md")))
    settle()
    assert "Sample spacing" in view.toPlainText()
    blocks, images = view.document().begin(), []
    while blocks.isValid():
        it = blocks.begin()
        while not it.atEnd():
            form = it.fragment().charFormat()
            if form.isImageFormat():
                images.append(form.toImageFormat().name())
            it += 1
        blocks = blocks.next()
    assert images
    for name in images:
        picture = view.loadResource(QtGui.QTextDocument.ImageResource, QtCore.QUrl(name))
        assert 100 < picture.width() <= view.width(), name
    press("Contents")
    same = view.toPlainText() == home  # pytest cannot tell texts with % apart
    assert same


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_freecad_starts_without_the_core():
    import sys
    import FreeCAD

    assert "beltgrinding.gui.workbench" in sys.modules  # the workbench is offered
    assert not any(name.startswith("beltgrinding_core") for name in sys.modules)
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/BeltGrinding").SetInt("Threads", 1)
    import beltgrinding.objects.api  # what a button or a macro calls: the preference holds by then
    from beltgrinding import core

    assert core.threads() == 1, core.threads()


def another_python():
    boxes, report = choose()
    here = f"Python {sys.version_info[0]}.{sys.version_info[1]}"
    assert len(boxes) == 1 and boxes[0].isVisible()
    for text in (boxes[0].text(), report):
        assert f"There is none for {here}" in text, text
        assert "Debian GNU/Linux 10 (buster): Python 3.7, OpenCASCADE 7.3.0" in text
        assert "docs/install.md" in text and "tools/install" in text
    boxes[0].close()
    Gui.activateWorkbench("PartWorkbench")
    Gui.activateWorkbench("BeltGrindingWorkbench")
    settle()
    assert not visible(QtGui.QMessageBox)
    menu("Help")
    assert "troubleshooting" in field("BeltGrinding_ManualView").toPlainText().lower()


def refused_by_the_loader(suffix):
    boxes, report = choose()
    assert len(boxes) == 1
    assert f"beltgrinding_core{suffix} cannot be loaded" in boxes[0].text(), boxes[0].text()
    assert "apt install ./beltgrinding_*.deb" in report


def another_opencascade():
    boxes, _ = choose()
    assert f"needs OpenCASCADE 6.9.1; this FreeCAD runs with {Part.OCC_VERSION}" in boxes[0].text()


def a_package_is_missing():
    boxes, _ = choose()
    assert len(boxes) == 1 and "apt install python3-jsonschema" in boxes[0].text(), boxes[0].text()
