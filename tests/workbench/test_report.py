"""The report of a result, without FreeCAD."""

import ast
import base64
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import beltgrinding
from beltgrinding.base import messages
from beltgrinding.engine import InputError, core
from beltgrinding.job import inputs
from beltgrinding.inspection import picture
from beltgrinding.simulation import result as results
from beltgrinding.reporting import (
    charts,
    convergence_section as converged,
    facts,
    findings,
    language,
    markup,
)
from test_job import plate_job
from support.results import unseal

ROOT = Path(__file__).resolve().parents[2]

NASTY = 'Blade <img src=x onerror="alert(1)"> & "co" \u0007'


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch):
    monkeypatch.setattr(picture, "PIXELS", 60000)
    monkeypatch.setattr(picture, "CLOSE_WIDTH", 160)
    monkeypatch.setattr(picture, "CLOSE_HEIGHT", 120)


class Page(HTMLParser):
    """Elements of a page, its text, and whether every element is closed."""

    VOID = {"meta", "link", "br", "img", "col", "input"}

    def __init__(self, html):
        super().__init__()
        self.open, self.elements, self.texts = [], [], []
        self.feed(html)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] not in (["style"], ["script"]):
            self.texts.append(data)

    @property
    def text(self):
        return re.sub(r"\s+", " ", " ".join(self.texts))

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


def made(folder, **options):
    return Page(beltgrinding.report(folder, **options).read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def ground(tmp_path_factory):
    """A plate ground by a program of a nasty name; its job file and what the run wrote."""
    folder = tmp_path_factory.mktemp("ground")
    job = plate_job()
    (folder / "plate & co.brep").write_text(job["design"].pop("brep"))
    job["design"]["file"] = "plate & co.brep"
    job["programs"][0]["name"] = NASTY
    job["law"] = {"heat_limit_MPa_m_s": 0.01}
    (folder / "job.json").write_text(json.dumps(job))
    beltgrinding.run(folder / "job.json").write(folder / "out")
    return folder


def test_the_report_is_one_file_that_needs_nothing_else(ground):
    html = beltgrinding.report(ground / "out").read_text(encoding="utf-8")
    page = Page(html)
    assert not page.all("link") and not page.all("iframe")
    assert page.all("script") and not any("src" in a for a in page.all("script"))
    assert page.all("meta")[1]["content"].startswith("default-src 'none'; img-src data:;")
    addresses = [a[k] for _, a in page.elements for k in ("href", "src") if k in a]
    assert addresses and all(address.startswith("data:") for address in addresses)
    assert not re.search(r"\burl\(|@import", html)
    assert not [a for _, a in page.elements if any(key.startswith("on") for key in a)]
    assert "<img" not in html and NASTY[:-1] in page.text
    assert "\u0007" not in html


def test_verdict_figures_and_doubts_stand_in_it(ground):
    page = made(ground / "out")
    summary = json.loads((ground / "out" / "summary.json").read_text())
    assert "Not in tolerance" in page.text and ("div", {"class": "verdict fail"}) in page.elements
    share = f"{100 * summary['in_tolerance_area_share']:.1f} %"
    assert f"{share} of the ground area keeps within −0.050 … +0.050 mm" in page.text
    assert f"{summary['deviation_mm']['max']:+.3f} mm" in page.text
    assert "Burn risk" in page.text and "Pressure times belt speed" in page.text
    for what, _, _ in facts.doubts(
        results.Result.read(ground / "out").job, summary, [], None, language.Language()
    ):
        assert what in page.text
    assert "dh/dt = K · k_t · V_b · p" in page.text
    for version in summary["versions"].values():
        assert str(version) in page.text


def test_the_report_repeats_the_result(ground, tmp_path):
    page = made(ground / "out")
    (link,) = [a for a in page.all("a") if "download" in a]
    (tmp_path / "again.json").write_bytes(base64.b64decode(link["href"].partition(",")[2]))
    again = beltgrinding.run(tmp_path / "again.json")
    field, _ = core.HeightField.from_hdf5(str(ground / "out" / "heightfield.h5"))
    np.testing.assert_array_equal(again.field.height, field.height)
    design = hashlib.sha256((ground / "plate & co.brep").read_bytes()).hexdigest()
    assert design in page.text
    assert hashlib.sha256(inputs.canonical(again.job)).hexdigest() in page.text


def test_inputs_that_changed_since_the_run_are_told(ground, tmp_path):
    for name in ("out", "plate & co.brep"):
        source = ground / name
        (shutil.copytree if source.is_dir() else shutil.copy)(source, tmp_path / name)
    file = tmp_path / "out" / "summary.json"
    summary = unseal(tmp_path / "out")
    text = made(tmp_path / "out").text
    assert "changed since" not in text and "not among the run's hashes" not in text
    summary["inputs"][1]["sha256"] = "0" * 64
    file.write_text(json.dumps(summary))
    assert "changed since the run" in made(tmp_path / "out").text
    summary["inputs"][1]["file"] = "/absent"
    file.write_text(json.dumps(summary))
    assert "no longer there" in made(tmp_path / "out").text
    assert "not among the run's hashes" in made(tmp_path / "out").text  # the file that is read now


def test_the_nearest_bodies_of_the_cell_are_told(tmp_path):
    result = beltgrinding.run(plate_job())
    pair = {"bodies": ["wheel", "clamp & co"], "distance_mm": 3.25, "program": 0, "pose": 1}
    result.summary["clearances"] = [{**pair, "line": 7, "time_s": 1.5, "points": None}]
    page = Page(beltgrinding.report(result, tmp_path / "r.html").read_text())
    assert "Clearances" in page.text and "wheel – clamp & co" in page.text
    assert "3.2 line 7, pose 2, 1.50 s" in page.text or "3.3 line 7" in page.text


def test_a_result_of_an_older_version_has_its_report(ground, tmp_path):
    shutil.copytree(ground / "out", tmp_path / "out")
    (tmp_path / "out" / "steps.csv").unlink()
    file = tmp_path / "out" / "summary.json"
    summary = unseal(tmp_path / "out")
    del summary["inputs"]
    file.write_text(json.dumps(summary))
    page = made(tmp_path / "out")
    assert "holds no time series" in page.text and "The run kept no hashes" in page.text


def test_a_design_that_cannot_be_read_any_more_leaves_a_note(tmp_path):
    job = plate_job()
    (tmp_path / "plate.brep").write_text(job["design"].pop("brep"))
    job["design"]["file"] = str(tmp_path / "plate.brep")
    beltgrinding.run(job).write(tmp_path / "out")
    (tmp_path / "plate.brep").unlink()
    page = made(tmp_path / "out")
    assert "plate.brep" in page.text and ("p", {"class": "note"}) in page.elements


@pytest.mark.parametrize("tolerance, words", [([-1, 1], "In tolerance"), ([0, 0], "Not in")])
def test_the_verdict_follows_the_tolerance(tmp_path, tolerance, words):
    job = plate_job()
    job["inspection"] = {"tolerance_mm": tolerance}
    result = beltgrinding.run(job)
    beltgrinding.report(result, tmp_path / "r.html", title="P")
    page = Page((tmp_path / "r.html").read_text())
    assert words in page.text
    assert ("Spot 1" in page.text) == (words != "In tolerance")
    assert "Nothing out of the ordinary" in page.text  # no events


def test_where_nothing_is_known_nothing_is_claimed(tmp_path):
    job = plate_job()
    corners = np.array([[0, 0, 0.1], [30, 0, 0.1], [30, 40, 0.1], [0, 40, 0.1]], np.float32)
    lid = core.TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    job["stock"] = {"kind": "solid", "brep": core.shape_from_mesh(lid).write_brep()}
    job["inspection"] = {"tolerance_mm": [-9, 9]}
    result = beltgrinding.run(job)
    assert result.summary["missed_rays"] > 0
    beltgrinding.report(result, tmp_path / "r.html")
    page = Page((tmp_path / "r.html").read_text())
    assert "Cannot be told" in page.text and "verdict open" in str(page.elements)


def test_the_verdict_tells_the_line_that_gouged_and_the_zones(tmp_path):
    job = plate_job()
    for k, pose in enumerate(job["programs"][0]["poses"]):
        pose["line"] = 70 + k
    job["belt_machine"]["force_N"] = 120
    job["inspection"] = {
        "zones": [{"name": 'rim <i>"', "faces": [1], "tolerance_mm": [-0.02, 0.3]}],
        "sections": [{"name": "mid <b>", "point_mm": [30, 0, 0], "normal": [1, 0, 0]}],
    }
    result = beltgrinding.run(job)
    beltgrinding.report(result, tmp_path / "r.html")
    page = Page((tmp_path / "r.html").read_text())
    assert "Section mid <b>" in page.text and page.text.count("not all around") >= 6  # a flat face
    assert 'rim <i>"' in page.text and "−0.020 … +0.300 mm" in page.text
    cluster = result.verdict["clusters"][0]
    assert cluster["side"] == "below" and "line 71 (" in page.text
    assert f"{cluster['area_mm2']:.1f}" in page.text and "Spot 1" in page.text
    assert "keeps within the limits of its zone" in page.text
    assert f"{result.verdict['gouge_volume_mm3']:.1f} mm³" in page.text
    assert page.text.count("Never touched by the wheel") == 1

    result.verdict = None  # that of an older result is found when the report is made
    beltgrinding.report(result, tmp_path / "again.html")
    assert (tmp_path / "again.html").read_text() == (tmp_path / "r.html").read_text()


def test_pictures_show_every_sample_where_it_is(ground):
    result = results.Result.read(ground / "out")
    shape = core.Shape.read(str(ground / "plate & co.brep"))
    colours = core.deviation_colours(result.field, -0.05, 0.05, 0.5)
    front, back = picture.Studio(result.field, colours, shape).both()
    assert front.pixels.shape == back.pixels.shape
    points = result.field.points + result.field.height[:, None] * result.field.normals
    inner = (result.field.flags & core.ON_BOUNDARY) == 0
    assert front.shows(points, 0.5).all() and not front.shows([[0, 0, -50]], 0.5)[0]
    x, y, depth = front.project(points[inner]).T
    rows, columns = y.astype(int), x.astype(int)
    np.testing.assert_allclose(front.depth[rows, columns], depth, atol=1.0 / front.scale)
    packed = colours[inner][:, None] >> np.array([24, 16, 8]) & 255
    shown = front.pixels[rows, columns].astype(float)
    light = shown.sum(axis=1) / packed.sum(axis=1)
    assert 0.5 < light.min() and light.max() <= 1.03
    assert np.median(np.abs(shown - light[:, None] * packed)) < 3.0
    # The plate is a sheet: from behind it is lit and coloured as well.
    assert (back.pixels != 255).any()


def test_a_close_up_cuts_away_what_hides_the_spot():
    def box(low, high):
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])  # fmt: skip
        faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        triangles = [t for a, b, c, d in faces for t in ([a, b, c], [a, c, d])]
        return corners, np.array(triangles)

    floor, triangles = box((-10, -10, -1), (10, 10, 0))
    lid, _ = box((-10, -10, 6), (10, 10, 7))
    shape = core.shape_from_mesh(
        core.TriangleMesh(
            np.vstack([floor, lid]).astype(np.float32),
            np.vstack([triangles, triangles + 8]).astype(np.uint32),
        )
    )
    tops = [
        i
        for i in range(shape.face_count)
        if np.allclose(core.sample_faces(shape, [i], 1.0)[0].points[:, 2], 0.0)
    ]
    field, _ = core.sample_faces(shape, tops, 0.5)
    colours = np.full(field.size, 0x00C000FF, dtype=np.uint32)
    view = picture.Studio(field, colours, shape).close_up([0, 0, 0], [0, 0, 1])
    middle = view.pixels[view.pixels.shape[0] // 2, view.pixels.shape[1] // 2].astype(int)
    assert middle[1] > 100 and middle[0] == middle[2] == 0


def test_png_is_what_others_read():
    pixels = np.random.default_rng(1).integers(0, 256, (13, 17, 3), dtype=np.uint8)
    read = np.asarray(Image.open(BytesIO(picture.png(pixels))).convert("RGB"))
    np.testing.assert_array_equal(read, pixels)


def test_markup_cannot_be_broken_by_a_text():
    html = markup.element("p", "<b>&\ud800\x00", None, ["x", 2], title='"><', hidden=True, id=None)
    assert html == '<p title="&quot;&gt;&lt;" hidden>&lt;b&gt;&amp;\ufffd\ufffdx2</p>'
    assert str(html).encode()


def spoken():
    """Every text that the report asks its language for."""
    folder = ROOT / "Mod" / "BeltGrinding" / "beltgrinding" / "reporting"
    texts = set()
    for file in folder.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            name = getattr(getattr(node, "func", None), "id", None)
            if isinstance(node, ast.Call) and name == "words":
                if isinstance(node.args[0], ast.Constant):
                    texts.add(node.args[0].value)
    texts |= {text for _, text, _, _ in charts.SERIES} | set(facts.ELASTICITY.values())
    texts |= {name for name, _ in facts.LAWS.values()}
    for table in (converged.NAMES, converged.SETTINGS, converged.LEVEL_NAMES):
        texts |= set(table.values())
    return texts


def test_every_text_is_there_in_german():
    german = messages.of_report("de")
    for kind in core.event_kinds():
        assert messages.kind_text(kind["code"]) in german and kind["advice"] in german, kind
    assert set(messages.BELT_TITLES) <= {kind["code"] for kind in core.event_kinds()}
    assert set(messages.BELT_TITLES.values()) <= german.keys()
    missing = sorted(spoken() - german.keys())
    assert not missing, missing
    fields = re.compile(r"\{\w+\}")
    for text, other in german.items():
        assert set(fields.findall(text)) == set(fields.findall(other)), text


def test_the_german_report_writes_numbers_as_germans_do(ground):
    page = made(ground / "out", language="de", output=ground / "de.html")
    assert "Nicht in Toleranz" in page.text and "−0,050 … +0,050 mm" in page.text
    assert page.all("html") == [{"lang": "de"}]
    words = language.Language("de")
    assert words.figures(1.25e-7) == "1,25 · 10⁻⁷" and words.whole(1234567) == "1\u202f234\u202f567"
    assert words.percent(0.9999999) == "> 99,9 %" and words.percent(1.0) == "100,0 %"
    assert words.short("a" * 36) == "a" * 36 and len(words.short("a" * 20 + "b" * 30)) == 36
    assert words.number(-0.00001) == "0,000" and words.number(float("nan")) == "–"
    with pytest.raises(InputError, match="no language 'fr'"):
        language.Language("fr")


def test_the_time_series_keeps_the_peaks():
    n = 5000
    steps = {"time": np.arange(n) + 0.5, "duration": np.ones(n)}
    steps.update({name: np.zeros(n) for name, *_ in charts.SERIES})
    steps["peak_pressure"][1234] = 7.0
    bins = charts.binned(steps, 100)
    assert len(bins["time"]) == 100 and max(bins["peak_pressure"]) == 7.0
    assert bins["peak_pressure"].index(7.0) == 24


@pytest.mark.slow
def test_command_line_writes_html_and_pdf(ground, tmp_path):
    pytest.importorskip("weasyprint")
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "Mod" / "BeltGrinding")}
    core_folder = str(Path(core.__file__).parent)
    environment["PYTHONPATH"] += os.pathsep + core_folder

    def cli(*arguments):
        return subprocess.run(
            [sys.executable, "-m", "beltgrinding", "report", *map(str, arguments)],
            env=environment,
            capture_output=True,
            text=True,
        )

    done = cli(ground / "out", "-o", tmp_path / "r.html", "--pdf", tmp_path / "r.pdf")
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.strip()).read_bytes().startswith(b"<!DOCTYPE html>")
    data = (tmp_path / "r.pdf").read_bytes()
    assert data.startswith(b"%PDF") and data.count(b"/Subtype /Image") + data.count(b"/Image") > 0
    if shutil.which("pdftotext"):
        text = subprocess.run(
            ["pdftotext", "-layout", tmp_path / "r.pdf", "-"], capture_output=True, text=True
        ).stdout
        assert "Not in tolerance" in text and "How to repeat it" in text
    (tmp_path / "alone").mkdir()
    (tmp_path / "alone" / "r.html").write_text("mine")
    before = sorted((ground / "out").iterdir())
    done = cli(ground / "out", "-o", tmp_path / "alone" / "r.PDF")
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.strip()).read_bytes().startswith(b"%PDF")
    assert (tmp_path / "alone" / "r.html").read_text() == "mine"
    assert len(list((tmp_path / "alone").iterdir())) == 2
    assert sorted((ground / "out").iterdir()) == before
    assert cli(tmp_path / "absent").returncode == 2
    done = cli(ground / "out", "-o", tmp_path / "no" / "r.html")
    assert done.returncode == 2 and "cannot be written" in done.stderr


def test_messages_of_events_are_told_in_german():
    def told(*facts):
        message = "; ".join(core.Fact(code, text, **named) for code, text, named in facts)
        kept = [dict(zip(("code", "text", "arguments"), fact)) for fact in facts]
        event = json.loads(json.dumps({"message": message, "facts": kept}))
        assert messages.event_message(event, "en") == message
        return messages.event_message(event, "de")

    assert told(
        ("event.gouge", "ground to {height:.3f} mm", {"height": -0.12345, "limit": -0.05})
    ) == ("bis −0,123 mm geschliffen, unter die untere Grenze von −0,05 mm")
    near = {"body": "housing", "other": "3", "distance": 1.25}
    assert told(("event.near_miss_rapid", "{body}, {other}", near)) == (
        "housing und 3 kommen einander in einer Eilbewegung auf 1,25 mm nahe"
    )
    beyond = {"joint": 2, "angle": 130.0, "beyond": 5.0, "limit": 125.0}
    wound = ("event.wound_up", "it would fit at {angle:.1f} deg", {"angle": -230.0})
    assert told(("event.joint_limit", "joint {joint}", beyond), wound).endswith(
        "; verdreht: Bei −230,0 Grad würde es passen"
    )
    high = ("event.over_pressure", "{pressure:.3g} MPa", {"pressure": 1234.5, "limit": 1.0})
    assert told(high).startswith("der Druck erreicht 1,23e+03 MPa")
    meet = ("event.collision", "{body}, {other}", {"body": "part", "other": "wheel"})
    assert told(meet) == "Bauteil und Scheibe stoßen zusammen"
    # Of a later version, and of an earlier one, which kept no facts.
    assert told(("event.of_a_later_version", "{mm:.1f} mm", {"mm": 2.0})) == "2.0 mm"
    old = {"message": "ground to -0.123 mm, below the lower limit of -0.05 mm"}
    assert messages.event_message({**old, "facts": []}, "de") == old["message"]


def test_errors_are_told_in_german(tmp_path):
    path = tmp_path / "a {0}.ply"
    path.write_text("none")
    with pytest.raises(InputError) as caught:
        core.read_ply(str(path))
    english, german = "cannot be read as a PLY mesh", "lässt sich nicht als PLY-Netz lesen"
    assert messages.sentence(caught.value, "en") == f"{path}: {english}: it has no PLY header"
    told = messages.sentence(caught.value, "de")
    assert told == f"{path}: {german}: sie hat keinen PLY-Kopf"
    assert caught.value.culprit == {"file": str(path)}
    assert messages.sentence(InputError("a {0}"), "de") == "a {0}"
    assert messages.sentence(ValueError("of another kind"), "de") == "of another kind"
