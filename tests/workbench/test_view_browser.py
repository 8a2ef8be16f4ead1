"""The 3D view in a real browser: drawn, turned, probed, cut, played; and what remains without WebGL."""

import copy
import re

import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import core
from beltgrinding.inspection import picture
from beltgrinding.job.tolerances import colour_scale
from support import browser as browsers
from test_job import plate_job

READY = "document.getElementById('view').dataset.ready === 'yes'"
CANVAS = "#view canvas"

pytestmark = pytest.mark.skipif(browsers.program() is None, reason="Chromium is not installed")


@pytest.fixture(scope="module")
def ground(tmp_path_factory):
    """A plate of which all is known, its view and its report."""
    folder = tmp_path_factory.mktemp("view")
    patch = pytest.MonkeyPatch()
    patch.setattr(picture, "PIXELS", 60000)
    job = plate_job()
    job["belt_machine"]["force_N"] = 120
    for k, pose in enumerate(job["programs"][0]["poses"]):
        pose["line"] = 70 + k
    result = beltgrinding.run(job)
    beltgrinding.view(result, folder / "view.html", title="Plate </script> 'P'")
    beltgrinding.view(result, folder / "german.html", language="de")
    beltgrinding.report(result, folder / "report.html")
    patch.undo()
    return folder, result


@pytest.fixture(scope="module")
def browser():
    with browsers.Browser() as found:
        yield found


@pytest.fixture
def page(ground, browser):
    """The view, just opened."""
    found = browser.open(ground[0] / "view.html")
    found.wait(READY)
    yield found
    faults = found.faults
    found.close()
    assert not faults


def places(page, samples):
    """(k, 2) pixels in the window at which samples are drawn."""
    asked = ",".join(map(str, samples))
    left, top, *_ = page.box(CANVAS)
    found = page.value(
        f"(v => [{asked}].map(i => v.camera.pixel([0, 1, 2].map(k => v.result.ground[3 * i + k]))))"
        "(beltgrindingView)"
    )
    return np.array(found) + [left, top]


def flat_samples(field, colours, count=60):
    """Samples in the middle of a patch of nearly one colour, where a pixel must have it."""
    channels = colours[:, None] >> np.array([24, 16, 8]) & 255
    corners = channels[field.triangles].astype(int)
    spread = np.zeros(field.size)
    for k in range(3):
        np.maximum.at(spread, field.triangles[:, k], np.ptp(corners, axis=1).max(axis=1))
    good = (spread <= 6) & ((field.flags & core.ON_BOUNDARY) == 0)
    x, y = field.points[:, 0], field.points[:, 1]
    good &= (np.abs(x - 30) < 28) & (np.abs(y - 20) < 18)  # beside the edge's line
    found = np.flatnonzero(good)
    return found[:: max(len(found) // count, 1)], channels


def shown_colours(page, field, colours):
    """Of some samples: (their colours on the screen, those that they should have)."""
    page.value("document.getElementById('view-marks').style.visibility = 'hidden', 1")
    samples, channels = flat_samples(field, colours)
    pixels = page.picture()
    x, y = np.round(places(page, samples)).astype(int).T
    return pixels[y, x].astype(int), channels[samples].astype(int)


def reading(page):
    return page.value("document.getElementById('view-tip').innerText")


def stage(page):
    """The drawn picture alone."""
    x, y, width, height = page.box(CANVAS)
    return page.picture([x + 80, y + 60, width - 200, height - 150])


def change(one, other):
    """The share of pixels that differ."""
    return float((np.abs(one.astype(int) - other.astype(int)).max(axis=2) > 24).mean())


def test_it_opens_offline_and_nothing_is_loaded(page, ground):
    assert page.requests == [f"file://{ground[0] / 'view.html'}"]
    assert page.value("document.getElementById('view-instead').offsetHeight") == 0
    assert page.value("document.querySelector('h1').textContent") == "Plate </script> 'P'"
    # The page's policy holds: what is put in later does not run, and nothing can be fetched.
    page.value(
        "(s => { s.textContent = 'window.broken = 1'; document.body.append(s); return 1; })"
        "(document.createElement('script'))"
    )
    assert page.value("window.broken === undefined")
    refused = "fetch('data:text/plain,x').then(() => false, () => true)"
    assert page.value(refused)
    page.browser.events.clear()  # the refusals were told on the console, as they should be


def test_colours_on_the_screen_are_the_legends(page, ground):
    field, scale = ground[1].field, colour_scale(ground[1].job)
    seen, expected = shown_colours(page, field, core.deviation_colours(field, *scale))
    assert len(seen) > 20 and len(np.unique(expected, axis=0)) > 3
    away = np.abs(seen - expected).max(axis=1)
    assert np.median(away) <= 3 and (away <= 8).mean() > 0.95
    # The legend's bar has them, too: its ends and the band.
    x, y, width, height = page.box("#view-legend .bar canvas")
    bar = page.picture([x, y, width, height])[:, int(0.5 * width)].astype(int)
    limit = scale[2]
    ends = core.colour_scale(*scale, [limit, 0.0, -limit])
    told = np.array([[int(c) >> s & 255 for s in (24, 16, 8)] for c in ends])
    assert np.abs(bar[[2, len(bar) // 2, -3]] - told).max() < 12


def test_colours_say_the_same_from_every_side(page, ground):
    field, scale = ground[1].field, colour_scale(ground[1].job)
    colours = core.deviation_colours(field, *scale)
    for turn in ("azimuth: 2.1", "azimuth: -0.7", "elevation: 1.4"):
        page.value(f"beltgrindingView.camera.set({{{turn}}}), 1")
        seen, expected = shown_colours(page, field, colours)
        assert np.median(np.abs(seen - expected)) <= 3, turn


@pytest.mark.slow
def test_each_mode_has_its_colours_and_legend(page, ground):
    field = ground[1].field
    labels = page.value("[...document.getElementById('view-mode').options].map(o => o.label)")
    assert labels[0] == "Deviation from the design" and "Largest pressure" in labels
    before = stage(page)
    for k, label in enumerate(labels[1:], 1):
        page.choose("#view-mode", str(k))
        told = page.value("document.getElementById('view-legend').innerText")
        assert told.strip(), label
        if label != "Good or not, by the zones' limits":
            assert change(before, stage(page)) > 0.02, label
    page.choose("#view-mode", str(labels.index("Largest pressure")))
    top = page.value(
        "beltgrindingView.result.about.modes.find(m => m.key == 'pressure').scale.high"
    )
    pressure = np.array(field.trace["peak_pressure"], dtype=float)
    seen, expected = shown_colours(page, field, core.magnitude_colours(pressure, field.flags, top))
    assert np.median(np.abs(seen - expected).max(axis=1)) <= 3


def test_a_point_tells_its_value_face_and_line(page, ground):
    field, trace = ground[1].field, ground[1].field.trace
    touched = np.flatnonzero(
        (trace["dominant"] != core.NEVER) & ((field.flags & core.ON_BOUNDARY) == 0)
    )
    untouched = np.flatnonzero(
        (trace["dominant"] == core.NEVER) & ((field.flags & core.ON_BOUNDARY) == 0)
    )
    page.value("document.getElementById('view-marks').hidden = true, 1")
    for sample in [*touched[:: len(touched) // 6], untouched[len(untouched) // 2]]:
        (x, y), = places(page, [sample])  # fmt: skip
        page.hover(x, y)
        page.wait("!document.getElementById('view-tip').hidden")
        page.settle()
        number = int(page.value("document.getElementById('view-tip').dataset.sample"))
        away = np.linalg.norm(field.points[number] - field.points[sample])
        assert away <= 1.5 * field.spacing
        text = reading(page).splitlines()
        value = float(text[0].split(" mm")[0].replace("−", "-"))
        assert value == pytest.approx(field.height[number], abs=6e-4)
        verdict = (
            "cut too deep" if value < -0.05 else "too much left" if value > 0.05 else "in tolerance"
        )
        assert text[0].endswith(verdict)
        assert f"Face{field.faces[number] + 1}" in text[1] and "−0.050 … +0.050 mm" in text[1]
        motion = trace["dominant"][number]
        made = (
            "never touched by the wheel"
            if motion == core.NEVER
            else f"line {70 + motion} removed most"
        )
        assert text[2] == made
        told = [
            float(one)
            for one in re.findall(r"−?[\d.]+", text[3].replace("−", "-").replace("(-", "(-"))
        ]
        assert text[3].startswith("(") and len(told) == 3
    page.choose("#view-mode", "4")
    page.hover(x + 1, y)
    assert "Largest pressure: " in reading(page) and "MPa" in reading(page)
    left, top, *_ = page.box(CANVAS)
    page.hover(left + 5, top + 400)
    assert page.value("document.getElementById('view-tip').hidden")


@pytest.mark.slow
def test_the_mouse_turns_shifts_and_zooms(page):
    left, top, width, height = page.box(CANVAS)
    x, y = left + 0.5 * width, top + 0.5 * height
    state = "beltgrindingView.camera.state"
    first, before = stage(page), page.value(state)
    page.drag(x, y, 120, 40)
    turned, after = stage(page), page.value(state)
    assert change(first, turned) > 0.1
    assert after["azimuth"] == pytest.approx(before["azimuth"] - 0.9, abs=0.05)
    assert after["elevation"] > before["elevation"] and after["target"] == before["target"]
    page.drag(x, y, 60, 0, button="right")
    shifted = page.value(state)
    assert shifted["azimuth"] == after["azimuth"] and shifted["target"] != after["target"]
    # What lies under the cursor stays there.
    at = (round(x + 90), round(y - 60))
    ray = f"beltgrindingView.camera.ray({at[0] - left}, {at[1] - top}).origin"
    origin = page.value(ray)
    page.mouse("Wheel", *at, deltaX=0, deltaY=-240)
    page.settle()
    assert page.value(state)["height"] < 0.8 * shifted["height"]
    out = page.value("beltgrindingView.camera.axes().out")
    moved = np.subtract(page.value(ray), origin)
    assert np.linalg.norm(moved - np.dot(moved, out) * np.array(out)) < 1e-6
    page.click("#view-home")
    page.wait(f"Math.abs({state}.azimuth - {before['azimuth']}) < 1e-6")
    assert change(first, stage(page)) < 0.01
    page.value(f"document.querySelector('{CANVAS}').focus(), 1")
    for kind in ("keyDown", "keyUp"):
        page.call("Input.dispatchKeyEvent", type=kind, key="ArrowLeft", code="ArrowLeft")
    assert page.value(state)["azimuth"] != pytest.approx(before["azimuth"], abs=1e-3)
    page.click("#view-axes .plus.z")
    page.wait("Math.abs(beltgrindingView.camera.axes().out[2] - 1) < 1e-9")


def test_a_worst_spot_is_shown_from_its_button(page, ground):
    spot = page.value("beltgrindingView.result.about.spots[0]")
    assert spot["number"] == ground[1].verdict["clusters"][0]["number"]
    page.click("[data-spot='0']")
    middle = page.value("beltgrindingView.result.middle")
    wanted = np.subtract(spot["point"], middle).tolist()
    page.wait(
        f"Math.hypot(...beltgrindingView.camera.state.target.map((v, k) => v - {wanted}[k])) < 1e-6"
    )
    page.settle()
    assert np.dot(page.value("beltgrindingView.camera.axes().out"), spot["normal"]) > 0.2
    assert page.value("!document.querySelector('#view-marks .glyph').hidden")


def coloured(page):
    """How many pixels of the stage are neither ground nor grey."""
    pixels = stage(page).astype(int)
    return int((np.ptp(pixels, axis=2) > 12).sum())


def test_a_section_cuts_and_draws_its_lines(page, ground):
    page.value("document.getElementById('view-marks').style.visibility = 'hidden', 1")
    page.value("beltgrindingView.camera.go(beltgrindingView.camera.fitting("
               "beltgrindingView.camera.towards([0, 0, -1]), beltgrindingView.result.ground), true), 1")  # fmt: skip
    whole = stage(page)
    page.choose("#view-cut", "x")
    parts = []
    for place in (200, 500, 800):
        page.choose("#view-place", str(place))
        told = page.value("document.getElementById('view-where').value")
        assert told == f"{60 * place / 1000:.1f} mm"
        parts.append(change(whole, stage(page)))
        pink = np.abs(stage(page).astype(int) - [0xD9, 0x00, 0x8C]).max(axis=2) < 40
        assert pink.sum() > 50
    assert parts[0] > parts[1] > parts[2] or parts[0] < parts[1] < parts[2]
    page.click("#view-flip")
    assert abs(change(whole, stage(page)) - parts[2]) > 0.05
    assert "× 20" in page.value("document.getElementById('view-lines').innerText")
    # What is cut away is not probed.
    field = ground[1].field
    gone = page.value("Math.sign(beltgrindingView.scene.cut.side)")
    sample = int(np.argmin(np.abs(field.points - [55 if gone > 0 else 5, 20, 0]).sum(axis=1)))
    page.hover(*places(page, [sample])[0])
    assert page.value("document.getElementById('view-tip').hidden")
    page.choose("#view-cut", "view")
    assert page.value("beltgrindingView.scene.cut !== null")
    page.choose("#view-cut", "")
    assert change(whole, stage(page)) < 0.01


def test_the_wheel_goes_its_way(page):
    before = stage(page)
    page.choose("#view-time", "300")
    early = stage(page)
    told = page.value("document.getElementById('view-moment').innerText")
    assert re.fullmatch(r"0\.4 of 1\.3 s; line 71", told), told
    assert change(before, early) > 0.02
    assert page.value("document.getElementById('view-final').offsetHeight") > 0
    page.choose("#view-time", "700")
    assert change(early, stage(page)) > 0.01
    page.value("document.getElementById('view-time').value = 0, 1")
    page.click("#view-play")
    assert page.value("document.getElementById('view-play').textContent") == "Pause"
    page.wait("document.getElementById('view-time').value > 20")
    page.click("#view-play")
    at = page.value("document.getElementById('view-time').value")
    page.settle()
    assert page.value("document.getElementById('view-time').value") == at
    page.choose("#view-time", "1000")
    page.click("#view-play")
    page.wait("document.getElementById('view-time').value < 900")


def test_it_speaks_german(browser, ground):
    page = browser.open(ground[0] / "german.html")
    page.wait(READY)
    sample = ground[1].field.size // 2
    page.value("document.getElementById('view-marks').hidden = true, 1")
    page.hover(*places(page, [sample])[0])
    text = reading(page)
    assert re.match(
        r"[+−]\d,\d{3} mm: (in Toleranz|zu tief geschliffen|zu viel stehen geblieben)", text
    )
    assert "am meisten trug ab: Zeile 7" in text or "von der Scheibe nie berührt" in text
    assert not page.faults
    page.close()


def test_dark_and_narrow(browser, ground):
    page = browser.open(ground[0] / "view.html", dark=True, size=(420, 800))
    page.wait(READY)
    assert page.value("document.documentElement.scrollWidth") <= 420
    assert page.picture()[5, 5].max() < 90
    page.click("#view-play")  # all of the panel can be reached
    assert page.value("document.getElementById('view-play').textContent") == "Pause"
    page.close()


def test_the_report_holds_it_and_scrolls_on(browser, ground):
    page = browser.open(ground[0] / "report.html")
    page.wait(READY)
    assert page.requests == [f"file://{ground[0] / 'report.html'}"] and not page.faults
    page.value("document.getElementById('view').scrollIntoView(), 1")
    left, top, width, height = page.box(CANVAS)
    x, y = left + 0.5 * width, top + 0.5 * height
    tall = "beltgrindingView.camera.state.height"
    before, scrolled = page.value(tall), page.value("window.scrollY")
    page.mouse("Wheel", x, y, deltaX=0, deltaY=120)
    page.wait(f"window.scrollY > {scrolled}")
    assert page.value(tall) == before
    page.value("document.getElementById('view').scrollIntoView(), 1")
    page.press(x, y)
    page.mouse("Wheel", x, y, deltaX=0, deltaY=120)
    page.wait(f"{tall} > {before}")
    # On paper the pictures remain.
    page.call("Emulation.setEmulatedMedia", media="print")
    assert page.value("document.getElementById('view').offsetHeight") == 0
    assert page.value("document.querySelectorAll('svg.picture').length") >= 3
    page.close()


def test_without_webgl_the_pictures_remain(ground):
    with browsers.Browser(webgl=False) as browser:
        for name in ("view.html", "report.html"):
            page = browser.open(ground[0] / name)
            page.settle()
            assert not page.value("!!document.createElement('canvas').getContext('webgl')")
            assert page.value("document.getElementById('view').offsetHeight") == 0
            shown = "[...document.querySelectorAll('svg.picture')].filter(p => p.getBoundingClientRect().height > 50).length"
            assert page.value(shown) >= 2
            assert not [one for one in page.faults if "exceptionDetails" in one]
            page.close()


def test_missing_samples_are_grey_and_say_so(browser, tmp_path, ground):
    job = plate_job()
    corners = np.array([[0, 0, 0.1], [30, 0, 0.1], [30, 40, 0.1], [0, 40, 0.1]], np.float32)
    lid = core.TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    job["stock"] = {"kind": "solid", "brep": core.shape_from_mesh(lid).write_brep()}
    result = beltgrinding.run(job)
    beltgrinding.view(result, tmp_path / "v.html")
    page = browser.open(tmp_path / "v.html")
    page.wait(READY)
    field = result.field
    sample = int(np.argmin(np.abs(field.points - [50, 12, 0]).sum(axis=1)))
    assert field.flags[sample] & core.MISSED
    x, y = places(page, [sample])[0]
    assert np.abs(page.picture()[int(y), int(x)].astype(int) - 0x70).max() < 4
    page.hover(x, y)
    assert reading(page).startswith("no stock")
    page.close()


@pytest.mark.slow
def test_an_empty_trace_and_many_samples(browser, tmp_path, ground):
    """No motions: the colours stay at the end, and the page says so."""
    result = copy.copy(ground[1])
    shape = core.Shape.from_brep(result.job["design"]["brep"])
    field, _ = core.sample_faces(shape, [], 0.12)
    core.apply_allowance(field, 0.2)
    result.field, result.motions, result.verdict = field, None, None
    beltgrinding.view(result, tmp_path / "v.html")
    page = browser.open(tmp_path / "v.html")
    page.wait(READY)
    assert f"of {len(field.height):,}".replace(",", "\u202f") in page.value(
        "document.body.innerText"
    )
    x, y, width, height = page.box(CANVAS)
    page.value("document.getElementById('view-marks').hidden = true, 1")
    page.hover(x + 0.5 * width, y + 0.5 * height)
    assert "too much left" in reading(page)
    page.choose("#view-time", "500")
    told = page.value("document.getElementById('view-final').innerText")
    assert told == "Heights and colours are those at the end."
    assert not page.faults
    page.close()


def test_the_surface_beside_a_sharp_edge_is_where_it_was_ground(browser, tmp_path):
    points = np.array([[0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0], [60, 0, -20], [60, 40, -20]])
    corners = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]], np.uint32)
    shape = core.shape_from_mesh(core.TriangleMesh(points.astype(np.float32), corners))
    job = plate_job()
    job["design"] = {"brep": shape.write_brep()}
    result = beltgrinding.run(job)
    field = result.field
    tops = field.points + field.height[:, None] * field.rays
    assert (
        np.linalg.norm(tops - field.points - field.height[:, None] * field.normals, axis=1).max()
        > 0.1
    )
    beltgrinding.view(result, tmp_path / "view.html")
    page = browser.open(tmp_path / "view.html")
    page.wait(READY)
    assert page.value("beltgrindingView.result.about.samples") == field.size
    drawn = page.value("Array.from(beltgrindingView.result.ground)")
    middle = page.value("beltgrindingView.result.middle")
    assert np.abs(np.array(drawn).reshape(-1, 3) + middle - tops).max() < 0.01
    assert not page.faults
    page.close()
