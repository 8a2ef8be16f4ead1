"""The release zip: what FreeCAD's Addon Manager asks of it, and an unpacked one at work."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
import FreeCAD
import FreeCADGui as Gui

import beltgrinding
from support.freecad import FreeCad, ROOT
from support.hands import example, field, menu, wait

BUILD = ROOT / "build" / "release"


@pytest.fixture(scope="module")
def content(tmp_path_factory):
    """The folder whose content tools/package zips."""
    if not (BUILD / "cmake_install.cmake").exists():
        pytest.skip("the core is not built in this checkout")
    folder = tmp_path_factory.mktemp("release") / "addon"
    command = ["cmake", "--install", BUILD, "--component", "addon", "--prefix", folder]
    subprocess.run(command, check=True, capture_output=True)
    return folder


@pytest.mark.slow
def test_an_unpacked_release_grinds_the_example(content, tmp_path):
    freecad = FreeCad(tmp_path, link=False)
    mod = tmp_path / ".local" / "share" / "FreeCAD" / "Mod" / "BeltGrinding"
    shutil.copytree(content, mod)
    freecad.call(ground_by, mod, window=True, fresh=True)


def ground_by(mod):
    Gui.activateWorkbench("BeltGrindingWorkbench")
    example("Compressor blade")
    doc = FreeCAD.ActiveDocument
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None, 200)
    assert beltgrinding.__file__.startswith(str(mod)), beltgrinding.__file__
    assert beltgrinding.core.__file__.startswith(str(mod)), beltgrinding.core.__file__
    menu("Help")
    assert "tutorial" in field("BeltGrinding_ManualView").toPlainText().lower()


@pytest.mark.freecad
def test_its_package_xml_holds_what_freecad_demands(content):
    version = re.search(r"<version>(.*)</version>", (ROOT / "package.xml").read_text()).group(1)
    folder = Path(content)
    data = FreeCAD.Metadata(str(folder / "package.xml"))
    assert data.Name and not set(data.Name) & set('/\\?%*:|"<>'), data.Name
    assert data.Version == version and re.fullmatch(r"\d+[.]\d+[.]\d+", data.Version)
    assert data.Description
    assert data.Maintainer and all(one["email"] for one in data.Maintainer)
    assert data.License[0]["name"] == "LGPL-2.1-or-later"
    assert (folder / data.License[0]["file"]).is_file() and (folder / data.Icon).is_file()
    (bench,) = data.Content["workbench"]
    assert (folder / bench.Subdirectory / bench.Icon).is_file(), bench.Icon
    assert f"class {bench.Classname}(" in (folder / bench.Subdirectory / "InitGui.py").read_text()
    depends = {one["package"] if isinstance(one, dict) else one for one in bench.Depend}
    assert depends == {"numpy", "jsonschema", "matplotlib", "Pillow"}, depends


@pytest.mark.freecad
def test_the_addon_manager_installs_it(content, tmp_path):
    archive = shutil.make_archive(str(tmp_path / "BeltGrinding"), "zip", content)
    try:
        from addonmanager_installer import AddonInstaller
        from addonmanager_devmode_metadata_checker import MetadataValidators
        from addonmanager_metadata import MetadataReader
        from Addon import Addon
    except ImportError:
        pytest.skip("the Addon Manager of this FreeCAD installs from the net only")
    else:
        addon = Addon("BeltGrindingZip", archive, Addon.Status.NOT_INSTALLED, "main")
        installer = AddonInstaller(addon, [])
        installer.installation_path = str(tmp_path)
        failures = []
        installer.failure.connect(lambda *told: failures.append(told))
        assert installer.run() and not failures, failures
        folder = Path(str(tmp_path), "BeltGrindingZip")
        assert (folder / "InitGui.py").is_file() and list(folder.glob("beltgrinding_core*.so"))
        addon.metadata = MetadataReader.from_file(str(folder / "package.xml"))
        addon.extract_metadata_dependencies(addon.metadata)
        assert addon.display_name
        benches = addon.metadata.content["workbench"]
        needed = {one.package for one in benches[0].depend}
        assert needed == {"numpy", "jsonschema", "matplotlib", "Pillow"}
        wrong = MetadataValidators().validate_top_level(addon)
        wrong += MetadataValidators().validate_content(addon)
        # There is no public repository yet, and none is invented.
        assert wrong == ["No <url> elements found, at least a repo url must be provided"], wrong
