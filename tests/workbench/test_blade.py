"""The example blade, made by FreeCAD and ground from the command line's functions."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import beltgrinding
from beltgrinding.examples import blade
from beltgrinding.inspection import picture
from beltgrinding.programs.registry import read_program
from support import browser, pictures

ROOT = Path(__file__).resolve().parents[2]

DRAWN_BY = "156."  # Chromium that the kept picture of the view is of; another one has other letters
LAID_OUT_BY = "57.2"  # weasyprint that the kept picture is of; another one breaks lines its way


@pytest.fixture(scope="module")
def example(freecad, tmp_path_factory):
    out = tmp_path_factory.mktemp("blade")
    freecad.call(make_blade, out)
    return out


def make_blade(out):
    solid, face = blade.shape()
    assert solid.isValid() and solid.isClosed() and solid.ShapeType == "Solid"
    blade.make(str(out))


@pytest.fixture(scope="module")
def ground(example):
    """(the result of the example's job, the folder that it is written to)."""
    result = beltgrinding.run(example / "job.json")
    result.write(example / "out")
    return result, example / "out"


def test_the_program_says_what_the_raster_path_meant(example):
    program = read_program(example / "blade_pressure_side.src")
    assert not program.problems
    assert len(program.motions) == 10 * 27


@pytest.mark.slow
def test_the_job_grinds_the_pressure_side(ground):
    summary = ground[0].summary
    assert 6000 < summary["design_area_mm2"] < 8000
    assert 0.3 < summary["removed_volume_mm3"] / summary["stock_volume_mm3"] < 1.5
    assert abs(summary["deviation_mm"]["p50"]) < 0.15
    assert summary["in_tolerance_area_share"] > 0.2


@pytest.mark.slow
def test_the_manuals_report_is_that_of_the_example(example, ground):
    weasyprint = pytest.importorskip("weasyprint")
    if not shutil.which("pdftoppm"):
        pytest.skip("pdftoppm is not installed")
    beltgrinding.report(ground[1], pdf=example / "report.pdf", title="Compressor blade")
    command = ["pdftoppm", "-png", "-r", "80", "-f", "1", "-l", "1", "-singlefile"]
    subprocess.run([*command, "report.pdf", "page"], cwd=example, check=True)
    page = np.asarray(Image.open(example / "page.png").convert("RGB"))
    frame = np.pad(page, ((4, 4), (4, 4), (0, 0)), constant_values=200)
    pictures.keep("report", picture.png(frame))
    if weasyprint.__version__ == LAID_OUT_BY:
        pictures.check(pictures.RELEASE, ["report"])


@pytest.mark.slow
@pytest.mark.skipif(browser.program() is None, reason="Chromium is not installed")
def test_the_manuals_view_is_that_of_the_example(ground):
    """The page of the view is small, and looks as the manual shows it."""
    page = beltgrinding.view(ground[1], title="Compressor blade")
    report = beltgrinding.report(ground[1], title="Compressor blade")
    assert page.stat().st_size < 3e6 and report.stat().st_size < 4e6
    with browser.Browser(size=(1200, 720)) as found:
        shown = found.open(page, size=(1200, 720))
        shown.wait("document.getElementById('view').dataset.ready === 'yes'")
        assert not shown.faults
        pictures.keep("view", picture.png(shown.picture()))
        if DRAWN_BY in found.call("Browser.getVersion")["product"]:
            pictures.check(pictures.RELEASE, ["view"])
