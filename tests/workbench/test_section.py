"""Cross-sections: figures, CSV, SVG, and the command line."""

import csv
import io
import json
import math
import subprocess
import sys
import xml.etree.ElementTree as tree

import numpy as np
import pytest
from support.freecad import ROOT

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.inspection import section, section_plot
from test_job import plate_job

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def result():
    job = plate_job()
    calibration = {
        "parameters": ["coefficient"],
        "covariance": [[0.0025]],
        "scatter": 0.08,
    }
    job["law"] = {"model": "local", "calibration": calibration}
    return beltgrinding.run(job)


def test_the_section_is_what_the_field_holds(result):
    found = section.section(result, (0, 20, 0), (0, 1, 0))
    (piece,) = found["pieces"]
    assert piece["face"] == 0 and not piece["closed"]
    np.testing.assert_allclose(piece["point"][:, 1], 20.0, atol=1e-9)
    np.testing.assert_allclose(piece["s"], piece["point"][:, 0], atol=1e-9)  # y x z = x
    np.testing.assert_allclose(piece["stock_height"], 0.2, atol=1e-7)
    # Against the nearest samples of the field.
    points, height = result.field.points, result.field.height
    for k in range(0, len(piece["s"]), 7):
        near = np.argsort(((points - piece["point"][k]) ** 2).sum(axis=1))[:3]
        low, high = height[near].min() - 0.01, height[near].max() + 0.01
        assert low <= piece["height"][k] <= high
    figures = section.summary(found)
    assert figures["length_mm"] == pytest.approx(60.0, abs=1e-6)
    assert figures["removed_mean_mm"] == pytest.approx(0.2 - figures["deviation_mm"]["mean"])
    assert figures["deviation_mm"]["min"] < 0.1 < figures["deviation_mm"]["max"]
    # Mean removal across the pass, times its length, is the removed volume.
    across = [section.section(result, (x, 0, 0), (1, 0, 0)) for x in np.arange(0.3, 60, 0.6)]
    volume = sum(40.0 * 0.6 * section.summary(one)["removed_mean_mm"] for one in across)
    assert volume == pytest.approx(result.summary["removed_volume_mm3"], rel=0.01)


def test_a_line_between_two_points(result):
    found = section.between(result, "10, 5, 0", "40,30,0")
    (piece,) = found["pieces"]
    np.testing.assert_allclose(piece["point"][[0, -1]], [[10, 5, 0], [40, 30, 0]], atol=1e-9)
    assert piece["s"][-1] == pytest.approx(math.hypot(30, 25))


def test_the_csv_says_it_all(result, tmp_path):
    found = section.section(result, (0, 20, 0), (0, 1, 0))
    section.write_csv(found, tmp_path / "section.csv")
    rows = list(csv.DictReader(io.StringIO((tmp_path / "section.csv").read_text())))
    (piece,) = found["pieces"]
    assert tuple(rows[0]) == section.COLUMNS and len(rows) == len(piece["s"])
    told = {name: np.array([float(row[name]) for row in rows]) for name in section.COLUMNS[:-1]}
    np.testing.assert_allclose(told["s_mm"], piece["s"], rtol=1e-8)
    np.testing.assert_allclose(told["deviation_mm"], piece["height"], rtol=1e-8)
    np.testing.assert_allclose(told["sd_mm"], piece["height_sd"], rtol=1e-8)
    np.testing.assert_allclose(
        told["removed_mm"], told["stock_mm"] - told["deviation_mm"], atol=1e-8
    )
    assert (told["face"] == 1).all() and told["sd_mm"].max() > 0
    lower, upper = found["tolerance"]
    for row, height in zip(rows, piece["height"]):
        expected = "above" if height > upper else "below" if height < lower else "good"
        assert row["verdict"] == expected


def with_gap(found):
    """The section with three points that missed the stock in its middle."""
    piece = {name: np.copy(value) for name, value in found["pieces"][0].items()}
    k = len(piece["s"]) // 2
    for name in ("height", "stock_height", "height_sd"):
        piece[name][k : k + 3] = np.nan
    return {**found, "pieces": [{**piece, "face": 0, "closed": False}]}


def test_missed_samples_leave_a_gap(result):
    found = with_gap(section.section(result, (0, 20, 0), (0, 1, 0)))
    rows = list(csv.DictReader(io.StringIO(section.csv_text(found))))
    missed = [row for row in rows if row["verdict"] == "missed"]
    assert len(missed) == 3 and all(row["deviation_mm"] == row["sd_mm"] == "" for row in missed)
    layers = {layer["key"]: layer for layer in section_plot.plot(found)["layers"]}
    assert len(layers["ground"]["lines"]) == len(layers["stock"]["lines"]) == 2
    assert len(layers["design"]["lines"]) == 1
    assert math.isfinite(section.summary(found)["deviation_mm"]["rms"])
    assert "nan" not in section_plot.svg(found)


def test_the_svg_shows_the_curves_where_they_are(result, tmp_path):
    found = section.section(result, (0, 20, 0), (0, 1, 0))
    section.write_svg(found, tmp_path / "section.svg")
    root = tree.fromstring((tmp_path / "section.svg").read_text())
    lines = {line.get("class"): line for line in root.iter(f"{SVG}polyline")}
    assert set(lines) == {"design", "stock", "ground"}
    assert {p.get("class") for p in root.iter(f"{SVG}polygon")} == {"tolerance", "uncertainty"}

    def heights(name):
        return np.array([float(p.split(",")[1]) for p in lines[name].get("points").split()])

    # The stock's 0.2 mm and the design's 0 give the scale; the ground profile follows it.
    scale = (heights("design")[0] - heights("stock")[0]) / 0.2
    ground = (heights("design")[0] - heights("ground")) / scale
    np.testing.assert_allclose(ground, found["pieces"][0]["height"], atol=0.01 / scale + 1e-3)
    texts = [text.text for text in root.iter(f"{SVG}text")]
    for word in ("arc length, mm", "design", "stock", "ground", "tolerance", "95 % uncertainty"):
        assert word in texts, texts


def test_the_shape_is_true_but_for_enlarged_heights(result):
    found = section.section(result, (0, 20, 0), (0, 1, 0))
    drawn = section_plot.plot(found, "shape", 10.0)
    layers = {layer["key"]: layer for layer in drawn["layers"]}
    design, ground = layers["design"]["lines"][0], drawn["ground"][0]
    np.testing.assert_allclose(np.ptp(design, axis=0), [60.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(ground[:, 1], 10.0 * found["pieces"][0]["height"], atol=1e-6)
    assert drawn["equal"] and "×10" in drawn["x_label"]
    assert section_plot.plot(found, "shape")["exaggeration"] == 20.0  # 0.12 * 60 / 0.2 is 36
    tree.fromstring(section_plot.svg(found, "shape"))
    with pytest.raises(InputError, match="exaggeration"):
        section_plot.plot(found, "shape", 0.0)
    with pytest.raises(InputError, match="no mode"):
        section_plot.plot(found, "round")


@pytest.mark.parametrize("low, high", [(0.0, 1.0), (-0.05, 0.2), (1e-6, 3e-6), (0.0, 12345.6)])
def test_ticks_are_round_and_inside(low, high):
    values, decimals = section_plot.ticks(low, high)
    assert 3 <= len(values) <= 9 and values[0] >= low - 1e-12 and values[-1] <= high + 1e-9
    assert all(round(value, decimals) == pytest.approx(value, abs=1e-12) for value in values)


def beltgrind(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "beltgrinding", *map(str, arguments)],
        cwd=ROOT / "Mod" / "BeltGrinding",
        capture_output=True,
        text=True,
    )


def test_the_command_line_writes_both(result, tmp_path):
    result.write(tmp_path / "out")
    files = [tmp_path / "section.csv", tmp_path / "section.svg"]
    outputs = [word for path in files for word in ("-o", path)]
    cut = ("section", tmp_path / "out")
    done = beltgrind(*cut, "--point", "0,20,0", "--normal=0,-1,0", *outputs, "--mode", "shape")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["length_mm"] == pytest.approx(60.0)
    assert files[0].read_text().startswith("piece,face,s_mm")
    tree.fromstring(files[1].read_text())
    assert beltgrind(*cut, "--from", "5,5,0", "--to", "50,30,0").returncode == 0
    for wrong, message in (
        (("--point", "0,50,0", "--normal", "0,1,0"), "misses"),
        (("--point", "0,50,0"), "--from and --to"),
        (("--point", "0,x,0", "--normal", "0,1,0"), "three numbers"),
        (("--point", "0,5,0", "--normal", "0,0,0"), "normal other than 0"),
        (("--point", "0,5,0", "--normal", "0,1,0", "-o", "a.pdf"), ".csv or .svg"),
    ):
        done = beltgrind(*cut, *wrong)
        assert done.returncode == 2 and message in done.stderr, done.stderr
        assert len(done.stderr.splitlines()) == 1
