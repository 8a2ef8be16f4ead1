"""The 3D view of a result: what its page holds. How it looks in a browser: test_view_browser.py."""

import base64
import copy
import hashlib
import json
import re
import zlib

import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.inspection import picture
from beltgrinding.job.tolerances import colour_scale
from beltgrinding.reporting import (
    language,
    pictures,
    report,
    view as views,
    view_data,
    view_library,
    view_mesh,
    worst_spots,
)
from support.results import unseal
from test_job import plate_job

SIDES = ([0, 0.6, -0.8], [0, -0.6, -0.8])  # directions of the pictures
NASTY = "</script><script>alert('1')</script><!-- \"P\" & 'Q' {0} \u2028"


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch):
    monkeypatch.setattr(picture, "PIXELS", 60000)
    monkeypatch.setattr(picture, "CLOSE_WIDTH", 160)
    monkeypatch.setattr(picture, "CLOSE_HEIGHT", 120)


@pytest.fixture(scope="module")
def ground():
    """A plate that is ground; its result is changed by no test."""
    return beltgrinding.run(plate_job())


def unpacked(text, index):
    """What Resources/report/view_data.js makes of packed arrays."""
    data, found = zlib.decompress(base64.b64decode(text)), {}
    for name, (kind, rows, columns, first) in index.items():
        size = int(kind[1])
        planes = np.frombuffer(data, np.uint8, rows * columns * size, first)
        codes = planes.reshape(columns, size, rows).astype(np.int64)
        codes = (codes << (8 * np.arange(size)[:, None])).sum(axis=1)
        steps = (codes >> 1) ^ -(codes & 1)
        values = np.cumsum(steps, axis=1) & (256**size - 1)
        found[name] = values[0] if columns == 1 else values.T
    return found


def data_of(result, code="en"):
    """(what the script is told, its arrays) of a result."""
    content = report.load(result)
    scale = colour_scale(result.job)
    spots = worst_spots.worst(result.field, scale[:2], content.verdict)
    made = view_data.data(content, scale, spots, SIDES, language.Language(code))
    json.dumps(made.about, allow_nan=False)
    return made.about, unpacked(made.arrays, made.about["arrays"])


def values_of(about, arrays, key):
    """A mode's values of the samples, NaN where it has none."""
    (mode,) = [mode for mode in about["modes"] if mode["key"] == key]
    codes = arrays[mode["values"]]
    values = mode["low"] + (mode["high"] - mode["low"]) * codes / view_mesh.STEPS
    return np.where(codes == view_mesh.MISSING, np.nan, values)


def points_of(about, codes):
    low, high = np.array(about["box"])
    return low + (high - low) * codes / view_mesh.STEPS


@pytest.mark.parametrize("kind", ["u1", "u2", "u4"])
def test_whole_numbers_come_back_as_they_were(kind):
    most = np.iinfo(view_mesh.KINDS[kind]).max
    random = np.random.default_rng(3)
    arrays = {
        "any": random.integers(0, most, (1000, 3), endpoint=True, dtype=np.uint64),
        "ends": np.array([0, most, 0, most, most, 1, 0], dtype=np.uint64),
        "none": np.zeros((0, 2), dtype=np.uint64),
    }
    packed = view_mesh.Packed()
    for name, values in arrays.items():
        packed.add(name, values, kind)
    found = unpacked(packed.text(), packed.index)
    for name, values in arrays.items():
        np.testing.assert_array_equal(found[name], values)


def test_values_come_back_to_half_a_step():
    values = np.concatenate([np.random.default_rng(1).normal(0, 0.1, 5000), [np.nan, np.inf]])
    known = np.ones(len(values), dtype=bool)
    known[7] = False
    codes, low, high = view_mesh.quantised(values, known)
    missing = np.flatnonzero(codes == view_mesh.MISSING)
    assert missing.tolist() == [7, 5000, 5001]
    again = low + (high - low) * codes / view_mesh.STEPS
    there = np.setdiff1d(np.arange(len(values)), missing)
    assert np.abs(again - values)[there].max() <= 0.501 * (high - low) / view_mesh.STEPS
    assert view_mesh.quantised(np.full(3, 2.5))[1:] == (2.5, 2.5)
    assert (view_mesh.quantised(np.full(3, np.nan))[0] == view_mesh.MISSING).all()


def test_directions_come_back_to_about_a_degree():
    n = np.random.default_rng(2).normal(size=(4000, 3))
    n = np.vstack([n / np.linalg.norm(n, axis=1, keepdims=True), np.eye(3), -np.eye(3)])
    flat = view_mesh.octahedral(n) / 127.0 - 1.0
    z = 1.0 - np.abs(flat).sum(axis=1)
    folded = (1.0 - np.abs(flat[:, ::-1])) * np.where(flat >= 0.0, 1.0, -1.0)
    again = np.column_stack([np.where(z[:, None] < 0.0, folded, flat), z])
    again /= np.linalg.norm(again, axis=1, keepdims=True)
    assert np.degrees(np.arccos(np.clip((again * n).sum(axis=1), -1, 1))).max() < 1.2


def test_the_page_holds_the_samples_of_the_result(ground):
    field = ground.field
    about, arrays = data_of(ground)
    assert about["samples"] == about["of"] == field.size
    size = np.ptp(about["box"], axis=0).max()
    points = points_of(about, arrays["points"])
    assert np.abs(points - field.points).max() <= size / view_mesh.STEPS
    deviation = values_of(about, arrays, "deviation")
    assert np.abs(deviation - field.height).max() < 1e-5
    triangles = arrays["triangles"].copy()
    triangles[:, 1:] = (triangles[:, 1:] + triangles[:, :1]) & 0xFFFFFFFF
    np.testing.assert_array_equal(triangles, field.triangles)
    pressure = values_of(about, arrays, "pressure")
    assert np.abs(pressure - field.trace["peak_pressure"]).max() < 1e-4
    removed = values_of(about, arrays, "removed")
    assert np.abs(removed - np.maximum(field.stock_height - field.height, 0)).max() < 1e-5
    never = field.trace["dominant"] == core.NEVER
    assert (np.isnan(values_of(about, arrays, "motion")) == never).all()
    np.testing.assert_array_equal(arrays["motion.dominant"] == 0, never)
    assert {mode["key"] for mode in about["modes"]} >= {"deviation", "verdict", "stock"}
    worst = [spot["number"] for spot in about["spots"]]
    assert worst[0] == ground.verdict["clusters"][0]["number"]


def test_colours_are_those_of_the_core(ground):
    mode = data_of(ground)[0]["modes"][0]
    scale = mode["scale"]
    lower, upper, limit = colour_scale(ground.job)
    assert (scale["low"], scale["high"]) == (-limit, limit)
    count = len(scale["colours"])
    middles = limit * (2.0 * (np.arange(count) + 0.5) / count - 1.0)
    expected = core.colour_scale(lower, upper, limit, middles.tolist())
    assert [int(colour, 16) for colour in scale["colours"]] == [int(c) >> 8 for c in expected]
    assert [tick[0] for tick in mode["ticks"]] == [-limit, lower, upper, limit]
    assert [word[1] for word in mode["words"]] == ["cut too deep", "good", "too much left"]
    colours = core.deviation_colours(ground.field, lower, upper, limit)
    flags = np.full(1, core.MISSED, dtype=np.uint8)
    missed = core.height_colours(np.zeros(1), flags, lower, upper, limit)
    assert int(missed[0]) >> 8 == 0x707070 and len(colours)


def area_of(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def large_field(count):
    """About ``count`` samples of a plate, with waves in them and one deep scratch."""
    shape = core.shape_from_mesh(
        core.TriangleMesh(
            np.array([[0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0]], np.float32),
            np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
        )
    )
    field, _ = core.sample_faces(shape, [], (2400 / count) ** 0.5)
    core.apply_allowance(field, 0.2)
    x, y = field.points[:, 0], field.points[:, 1]
    height = 0.1 * np.sin(x) * np.cos(3 * y) + np.random.default_rng(0).normal(0, 0.02, field.size)
    k = int(np.argmin(np.hypot(x - 20, y - 11)))
    height[k] = -0.9
    field.set_height(height)
    return field, k


def thinned_slowly(points, normals, groups, most, keep):
    """What ``view_mesh.thinned`` promises, sample by sample."""
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    edge = np.linalg.norm(size) / len(points) ** 0.5
    while True:
        firsts, found = {}, {}
        for i, cell in enumerate(np.floor((points - low) / edge).astype(int).tolist()):
            cube = (groups[i], *cell)
            first = firsts.setdefault(cube, i)
            found.setdefault((cube, bool((normals[i] * normals[first]).sum() < 0.0)), []).append(i)
        if len(found) <= most:
            break
        edge *= max(1.02, (len(found) / most) ** 0.5)
    place = np.empty(len(points), dtype=int)
    for samples in found.values():
        away = np.linalg.norm(points[samples] - points[samples].sum(axis=0) / len(samples), axis=1)
        kept = [i for i in samples if i in keep]
        place[samples] = kept[0] if kept else samples[int(np.argmin(away))]
    return np.unique(place, return_inverse=True)


@pytest.mark.parametrize("groups, most", [(1, 10), (1, 700), (4, 300)])
def test_samples_are_thinned_as_one_by_one(groups, most):
    random = np.random.default_rng(7)
    points = random.normal(size=(3000, 3)) * [30.0, 5.0, 0.2]
    points[500:600] = points[500]  # in one place
    normals = random.normal(size=(3000, 3)).astype(np.float32)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    groups, keep = random.integers(0, groups, 3000), [2900, 17, 560, 18]
    chosen, place = view_mesh.thinned(points, normals, groups, most, keep)
    wanted, wanted_place = thinned_slowly(points, normals, groups, most, keep)
    assert len(chosen) <= most
    np.testing.assert_array_equal(chosen, wanted)
    np.testing.assert_array_equal(place, wanted_place)
    triangles = random.integers(0, 3000, (500, 3)).astype(np.uint32)
    moved = [t for t in place[triangles].tolist() if len(set(t)) == 3]
    assert core.replaced(triangles, place).tolist() == moved


def test_thinning_refuses_what_does_not_fit():
    points, groups = np.eye(3), np.zeros(3)
    for code, wrong in [
        ("thinning.counts", (points, points[:2], groups, 1, [])),
        ("thinning.counts", (points, points, groups[:2], 1, [])),
        ("thinning.size", (points, points, groups, 0, [])),
        ("thinning.keep", (points, points, groups, 1, [3])),
        ("call.thinning_rows", (points[:, :2], points, groups, 1, [])),
    ]:
        with pytest.raises(InputError) as error:
            core.thinned(*wrong)
        assert error.value.code == code
    with pytest.raises(InputError) as error:
        core.replaced(np.array([[0, 1, 3]]), np.arange(3))
    assert error.value.code == "thinning.corner"
    chosen, place = core.thinned(points, points, np.arange(3), 1, [])  # as few as the groups allow
    assert chosen.tolist() == place.tolist() == [0, 1, 2]


@pytest.mark.parametrize("corners", [3, 40, 2**21, 2**21 + 1, 2**31])
def test_proper_triangles_are_each_there_once(corners):
    triangles = np.random.default_rng(3).integers(0, corners, (500, 3))
    triangles[:10] = corners - 1 - np.arange(3)  # the largest numbers, many times
    triangles = np.vstack([triangles, np.roll(triangles, 1, axis=1), triangles[:, [0, 1, 1]]])
    found = {t[k:] + t[:k] for t in map(tuple, triangles.tolist()) for k in [t.index(min(t))] if len(set(t)) == 3}  # fmt: skip
    assert [tuple(t) for t in view_mesh.proper_triangles(triangles).tolist()] == sorted(found)


@pytest.mark.slow
def test_a_million_samples_are_thinned_honestly(ground):
    field, deepest = large_field(1_000_000)
    assert field.size > 900_000
    result = copy.copy(ground)
    result.field, result.verdict, result.motions = field, None, None
    about, arrays = data_of(result)
    packed = sum(len(array) for array in arrays.values())
    assert packed and about["of"] == field.size
    assert 0.2 * view_data.MOST_SAMPLES < about["samples"] <= view_data.MOST_SAMPLES
    deviation = values_of(about, arrays, "deviation")
    assert deviation.min() == pytest.approx(-0.9, abs=1e-4)  # the worst spot is among them
    points = points_of(about, arrays["points"])
    step = np.ptp(about["box"], axis=0).max() / view_mesh.STEPS
    at = np.argmin(deviation)
    assert np.abs(points[at] - field.points[deepest]).max() <= step
    # Each that is shown has its own place and value: none is a mean.
    own = {tuple(p): h for p, h in zip(np.round(field.points / step / 4).astype(int).tolist(), field.height)}  # fmt: skip
    keys = np.round(points / step / 4).astype(int).tolist()
    found = [(own[tuple(k)], d) for k, d in zip(keys, deviation) if tuple(k) in own]
    assert len(found) > 0.5 * len(keys)
    shown, kept = np.array(found).T
    assert np.abs(shown - kept).max() < 1e-4
    triangles = arrays["triangles"].copy()
    triangles[:, 1:] = (triangles[:, 1:] + triangles[:, :1]) & 0xFFFFFFFF
    assert area_of(points, triangles) == pytest.approx(2400, rel=0.02)  # no holes, no second layer


def test_no_result_makes_a_page_that_cannot_be_sent(ground, monkeypatch):
    field, _ = large_field(60_000)
    result = copy.copy(ground)
    result.field, result.verdict, result.motions = field, None, None
    monkeypatch.setattr(view_data, "MOST_BYTES", 150_000)
    content = report.load(result)
    words = language.Language()
    made = view_data.data(content, colour_scale(result.job), [], SIDES, words)
    assert len(made.arrays) <= 150_000 and made.about["samples"] < field.size
    scale = colour_scale(result.job)
    drawn = pictures.draw(result.field, scale, content.shape, [], near=False, beside=dict)
    markup = views.view(content, scale, [], drawn["beside"], words).markup
    nth = round(field.size / made.about["samples"])
    assert f"samples, every {words.ordinal(nth)} on average" in markup


def test_what_is_missing_is_told_as_missing():
    job = plate_job()
    corners = np.array([[0, 0, 0.1], [30, 0, 0.1], [30, 40, 0.1], [0, 40, 0.1]], np.float32)
    lid = core.TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    job["stock"] = {"kind": "solid", "brep": core.shape_from_mesh(lid).write_brep()}
    result = beltgrinding.run(job)
    missed = (result.field.flags & core.MISSED) != 0
    about, arrays = data_of(result)
    assert missed.any() and not missed.all()
    for key in ("deviation", "verdict", "removed", "stock", "pressure"):
        np.testing.assert_array_equal(np.isnan(values_of(about, arrays, key)), missed)
    everywhere = copy.copy(result)
    everywhere.field = result.field.copy()
    about, _ = data_of(everywhere)
    assert about["modes"][0]["missing"] == "no stock"


def test_zones_have_their_own_limits_and_thickness():
    job = plate_job()
    zones = [
        {"name": "rim", "faces": [1], "tolerance_mm": [-0.02, 0.3], "thickness_mm": [-0.1, 0.1]}
    ]
    job["inspection"] = {"zones": zones}
    result = beltgrinding.run(job)
    about, arrays = data_of(result)
    assert about["zones"][0] == ["rim", -0.02, 0.3] and about["zones"][-1][0] is None
    place = values_of(about, arrays, "verdict")
    inside = (place >= 0) & (place <= 1)
    expected = (result.field.height >= -0.02) & (result.field.height <= 0.3)
    of_zone = arrays["zones"] == 0
    assert of_zone.any() and (inside == expected)[of_zone].mean() > 0.999
    thick = [mode for mode in about["modes"] if mode["key"] == "thickness"]
    assert len(thick) == 1 and thick[0]["missing"] == "not measured"


def test_an_uncertainty_and_a_scan_have_their_modes(ground):
    result = copy.copy(ground)
    result.field = ground.field.copy()
    measured = np.array(result.field.height) + 0.01
    measured[:5] = np.nan
    result.field.set_measured(measured.tolist())
    result.field.set_height_sd(np.full(result.field.size, 0.004).tolist())
    about, arrays = data_of(result)
    difference = values_of(about, arrays, "difference")
    assert np.isnan(difference[:5]).all()
    np.testing.assert_allclose(difference[5:], 0.01, atol=1e-5)
    np.testing.assert_allclose(values_of(about, arrays, "sd"), 0.004, atol=1e-6)
    assert np.isnan(values_of(about, arrays, "measured")).sum() == 5


def test_the_wheel_goes_the_programs_way(ground):
    about, arrays = data_of(ground)
    low, high = np.array(about["wheel"]["box"])
    way = low + (high - low) * arrays["wheel.place"] / view_mesh.STEPS
    np.testing.assert_allclose(way[[0, -1]], [[10, 20, 0.2], [50, 20, 0.2]], atol=1e-3)
    assert about["wheel"]["time"] == pytest.approx(40 / 30, rel=1e-6)
    assert (np.diff(arrays["wheel.time"]) >= 0).all() and about["wheel"]["radius"] == 60
    turns = 2.0 * arrays["wheel.turn"] / view_mesh.STEPS - 1.0
    np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1.0, atol=1e-3)


def test_a_part_in_the_robots_hand_stays_and_the_wheel_moves(ground):
    """The same contact, the part held: the wheel's way over the part is the same."""
    job = plate_job()
    job["cell"] = {"holding": "part_in_hand", "base_from_contact": {"position_mm": [900, 0, 500]}}
    base_from_contact = np.eye(4)
    base_from_contact[:3, 3] = [900, 0, 500]
    from beltgrinding.base import frames

    for pose in job["programs"][0]["poses"]:
        place = [pose[k] for k in ("x_mm", "y_mm", "z_mm")]
        work_from_contact = frames.from_quaternion(
            place, [pose[k] for k in ("qw", "qx", "qy", "qz")]
        )
        tcp = base_from_contact @ np.linalg.inv(work_from_contact)
        turn = frames.to_quaternions(tcp[None, :3, :3])[0]
        pose.update(
            zip(("x_mm", "y_mm", "z_mm"), tcp[:3, 3]), **dict(zip(("qw", "qx", "qy", "qz"), turn))
        )
    about, arrays = data_of(beltgrinding.run(job))
    expected, others = data_of(ground)
    np.testing.assert_allclose(about["wheel"]["box"], expected["wheel"]["box"], atol=1e-6)
    assert np.abs(arrays["wheel.place"][-1].astype(int) - others["wheel.place"][-1]).max() <= 1


def test_a_part_that_is_gone_leaves_what_was_ground(tmp_path):
    job = plate_job()
    (tmp_path / "plate.brep").write_text(job["design"].pop("brep"))
    job["design"]["file"] = str(tmp_path / "plate.brep")
    beltgrinding.run(job).write(tmp_path / "out")
    (tmp_path / "plate.brep").unlink()
    html = beltgrinding.view(tmp_path / "out").read_text()
    assert 'id="view"' in html and (tmp_path / "out" / "view.html").exists()
    assert re.search(r'class="notes told">[^<]*plate\.brep', html)


def test_programs_that_are_gone_leave_the_wheel_out(tmp_path):
    job = plate_job()
    text = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s\n10,20,0.2,0,1,0,0,30\n50,20,0.2,0,1,0,0,30\n"
    (tmp_path / "p.csv").write_text(text)
    job["programs"] = [{"file": str(tmp_path / "p.csv")}]
    result = beltgrinding.run(job)
    (tmp_path / "p.csv").unlink()
    about, _ = data_of(result)
    assert about["wheel"] is None
    html = beltgrinding.view(result, tmp_path / "v.html").read_text()
    assert "No wheel is shown: " in html and 'id="view-play"' not in html


def test_an_older_result_has_its_view(ground, tmp_path):
    ground.write(tmp_path / "out")
    for name in ("steps.csv", "motions.csv", "verdict.json"):
        (tmp_path / "out" / name).unlink()
    unseal(tmp_path / "out")
    assert "Worst spots" in beltgrinding.view(tmp_path / "out").read_text()


def test_a_result_without_a_trace_has_its_view(tmp_path):
    job = plate_job()
    shape = core.Shape.from_brep(job["design"]["brep"])
    result = beltgrinding.run(job)
    field, _ = core.sample_faces(shape, [], 0.6)
    core.apply_allowance(field, 0.2)
    result.field, result.motions, result.verdict = field, None, None
    about, arrays = data_of(result)
    assert not about["traced"] and "motion.last" not in arrays
    assert "those at the end" in beltgrinding.view(result, tmp_path / "v.html").read_text()


def test_a_part_of_many_solids_and_faces(tmp_path):
    """A closed body whose one face is ground, and one that is ground all over."""
    corners = np.array([[x, y, z] for x in (0, 60) for y in (0, 40) for z in (-20, 0)], np.float32)
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = np.array([t for a, b, c, d in faces for t in ([a, b, c], [a, c, d])], np.uint32)
    shape = core.shape_from_mesh(core.TriangleMesh(corners, triangles))
    job = plate_job()
    job["design"] = {"brep": shape.write_brep()}
    job["sampling"] = {"spacing_mm": 1.5}
    whole, arrays = data_of(beltgrinding.run(job))
    assert len(arrays["rest.points"]) == 0 and len(whole["faces"]) == shape.face_count
    assert "face" in {mode["key"] for mode in whole["modes"]}
    top = [
        k + 1
        for k in range(shape.face_count)
        if np.allclose(core.sample_faces(shape, [k], 5.0)[0].points[:, 2], 0.0)
    ]
    job["design"]["faces"] = top
    about, arrays = data_of(beltgrinding.run(job))
    assert about["faces"] == top and about["solid"]
    creases = points_of(about, arrays["rest.points"])[arrays["rest.creases"]]
    length = np.linalg.norm(creases[:, 0] - creases[:, 1], axis=1).sum()
    assert length == pytest.approx(4 * (60 + 40) - 200 + 4 * 20 + 200, rel=0.01)


def scripts(html):
    """(attributes, text) of the elements that a browser would take for scripts."""
    return re.findall(r"<script([^>]*)>(.*?)</script>", html, re.DOTALL)


def test_no_text_of_a_user_ends_a_script(ground, tmp_path):
    result = copy.copy(ground)
    result.job = copy.deepcopy(ground.job)
    result.job["programs"][0]["name"] = NASTY
    for write in (beltgrinding.view, beltgrinding.report):
        html = write(result, tmp_path / "v.html", title=NASTY).read_text(encoding="utf-8")
        found = scripts(html)
        assert len(found) == 4 and html.count("<script") == 4 and html.count("</script") == 4
        about = json.loads(found[0][1])
        assert about["title"] == NASTY and "<" not in found[0][1]
        assert "<!--" not in html.replace("<!DOCTYPE", "")
        # The page's policy lets just these run.
        (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', html)
        allowed = re.findall(r"sha256-([\w+/=]+)", policy)
        run = [text for kind, text in found if "type=" not in kind]
        assert allowed == [
            base64.b64encode(hashlib.sha256(t.encode()).digest()).decode() for t in run
        ]
        assert (
            "default-src &#x27;none&#x27;" in policy
            and "unsafe-inline" not in policy.split("script-src")[1]
        )


def test_the_library_keeps_its_licence(ground, tmp_path):
    html = beltgrinding.view(ground, tmp_path / "v.html").read_text(encoding="utf-8")
    assert "Permission is hereby granted, free of charge" in html
    release = view_library.library().release
    assert f"Drawn by three.js r{release} (MIT licence)" in html


def test_without_three_js_the_report_says_what_to_install(ground, tmp_path, monkeypatch):
    monkeypatch.setenv(view_library.ELSEWHERE, str(tmp_path / "absent.js"))
    html = beltgrinding.report(ground, tmp_path / "r.html").read_text(encoding="utf-8")
    assert "<script" not in html and "libjs-three" in html and html.count("<svg") > 3
    with pytest.raises(InputError, match="install Debian's libjs-three") as caught:
        beltgrinding.view(ground, tmp_path / "v.html")
    assert caught.value.code == "reporting.no_three" and not (tmp_path / "v.html").exists()
    (tmp_path / "new.js").write_text('var REVISION="170"')
    monkeypatch.setenv(view_library.ELSEWHERE, str(tmp_path / "new.js"))
    with pytest.raises(InputError, match="release 110 to 124"):
        beltgrinding.view(ground, tmp_path / "v.html")
    with pytest.raises(InputError, match="what file to write"):
        beltgrinding.view(ground)


@pytest.mark.slow
def test_a_pdf_carries_no_script(ground, tmp_path):
    pytest.importorskip("weasyprint")
    beltgrinding.report(ground, tmp_path / "r.html", pdf=tmp_path / "r.pdf")
    beltgrinding.report(ground, tmp_path / "alone.pdf")
    library = len(view_library.library().script)
    assert (tmp_path / "r.html").stat().st_size > library
    for name in ("r.pdf", "alone.pdf"):
        assert (tmp_path / name).stat().st_size < 0.5 * library
        assert b"WebGLRenderer" not in (tmp_path / name).read_bytes()


def test_the_view_speaks_german(ground, tmp_path):
    html = beltgrinding.view(ground, tmp_path / "v.html", language="de").read_text(encoding="utf-8")
    told = json.loads(scripts(html)[0][1])
    assert told["modes"][0]["label"] == "Abweichung vom Entwurf"
    assert told["modes"][0]["ticks"][1][1] == "−0,050"
    assert [word[1] for word in told["modes"][0]["words"]] == [
        "zu tief geschliffen",
        "gut",
        "zu viel stehen geblieben",
    ]
    assert "Scheibe auf ihrem Weg" in html and "Nicht in Toleranz" in html
    words = language.Language("de")
    assert words.ordinal(3) == "3." and language.Language().ordinal(3) == "3rd"
    assert [language.Language().ordinal(n) for n in (1, 2, 11, 12, 22, 100)] == [
        "1st", "2nd", "11th", "12th", "22nd", "100th"]  # fmt: skip


def bent_sheet(count):
    """A mesh of 2 x ``count`` x ``count`` facets: 60 x 60 mm, wavy, level up to x = 30, then down at 45 degrees."""
    x, y = np.meshgrid(np.linspace(0, 60, count + 1), np.linspace(0, 60, count + 1), indexing="ij")
    points = np.stack(
        [x, y, np.minimum(30 - x, 0) + np.sin(x / 9) * np.cos(y / 9)], axis=-1
    ).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(*2 * [np.arange(count)], indexing="ij"))
    a, b, c, d = ((i + p) * (count + 1) + j + q for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
    triangles = np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return core.TriangleMesh(points.astype(np.float32), triangles.astype(np.uint32))


def test_a_mesh_part_has_no_holes_and_no_facets_edges(ground, monkeypatch):
    monkeypatch.setattr(view_data, "MOST_SAMPLES", 4000)
    mesh = bent_sheet(20)
    shape = core.shape_from_mesh(mesh)
    assert shape.face_count > view_data.MOST_FACES
    field, _ = core.sample_faces(shape, [], 0.5)
    core.apply_allowance(field, 0.2)
    result = copy.copy(ground)
    result.job = {**ground.job, "design": {**ground.job["design"], "brep": shape.write_brep()}}
    result.field, result.verdict, result.motions = field, None, None
    about, arrays = data_of(result)
    assert about["samples"] <= 4000 < field.size
    points = points_of(about, arrays["points"])
    triangles = arrays["triangles"].copy()
    triangles[:, 1:] = (triangles[:, 1:] + triangles[:, :1]) & 0xFFFFFFFF
    whole = area_of(mesh.vertices.astype(float), mesh.triangles)
    assert area_of(points, triangles) == pytest.approx(whole, rel=0.03)
    # Its rim and the bend, and hardly anything else.
    ends = points[arrays["borders"]]
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    middle = ends.mean(axis=1)
    rim = (
        np.minimum.reduce([middle[:, 0], 60 - middle[:, 0], middle[:, 1], 60 - middle[:, 1]]) < 1.5
    )
    bend = np.abs(middle[:, 0] - 30) < 1.5
    assert lengths[~rim & ~bend].sum() < 0.05 * lengths.sum() and lengths[bend & ~rim].sum() > 40
