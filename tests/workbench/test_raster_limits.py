"""Raster paths: no violent motion in contact, entry and exit of passes, the check of the whole path."""

import json
import math

import numpy as np
import pytest
from support.freecad import SHARED

from beltgrinding.engine import InputError, core
from beltgrinding.job import engine_input, load as jobs, poses
from beltgrinding.raster import passes, path_check, raster_path, turn_limits
from beltgrinding.raster.footprint import plane_extents
from beltgrinding.simulation import run as runs

SETTINGS = raster_path.validate({})
X = {"along": "direction", "direction": [1, 0, 0], "spacing": "lines", "step_over_mm": 10}
WHEEL = {"radius_mm": 20, "width_mm": 15, "crown_radius_mm": 60}


def line(angles, distances, about="y"):
    """A piece along x whose normal turns by ``angles`` (degrees) about y or z in steps of ``distances``."""
    at = np.concatenate([[0.0], np.cumsum(distances)])
    turn = np.radians(np.concatenate([[0.0], np.cumsum(angles)]))
    flat = np.zeros_like(turn)
    if about == "y":  # convex along the pass
        normals = np.stack([np.sin(turn), flat, np.cos(turn)], 1)
        tangents = np.stack([np.cos(turn), flat, -np.sin(turn)], 1)
    else:  # twist
        normals = np.tile([0.0, 0.0, 1.0], (len(turn), 1))
        tangents = np.stack([np.cos(turn), np.sin(turn), flat], 1)
    points = np.stack([at, flat, flat], 1)
    return {"points": points, "normals": normals, "tangents": tangents, "closed": False}


def rates(piece):
    """(rad, mm) from point to point."""
    frames = passes.contact_frames(piece["points"], piece["normals"], piece["tangents"])
    apart = np.linalg.norm(np.diff(frames[:, :3, :3], axis=0), axis=(1, 2))
    turn = 2 * np.arcsin(apart / math.sqrt(8))
    return turn, np.linalg.norm(np.diff(piece["points"], axis=0), axis=1)


def assert_within(piece, settings):
    turn, way = rates(piece)
    assert (np.degrees(turn) <= settings["max_turn_deg"] + 1e-6).all()
    assert (np.degrees(turn) <= settings["max_turn_deg_per_mm"] * way * 1.000001 + 1e-6).all()
    assert (way <= settings["max_distance_mm"] * (1 + 1e-9)).all()


@pytest.mark.parametrize("about", ["y", "z"])
def test_a_turn_on_the_spot_is_spread_along_the_pass(about):
    found = turn_limits.limited(line([0, 30, 0], [20, 0, 20], about), SETTINGS)
    assert len(found) == 1
    assert_within(found[0], SETTINGS)
    assert found[0]["points"][[0, -1], 0] == pytest.approx([0, 40])
    whole = np.degrees(math.acos(found[0]["tangents"][0] @ found[0]["tangents"][-1]))
    assert whole == pytest.approx(30, abs=1e-6)
    turn, _ = rates(found[0])
    turning = found[0]["points"][1:, 0][turn > 1e-6]
    assert 19 < turning.min() and turning.max() < 21.1  # nowhere else


@pytest.mark.parametrize("about", ["y", "z"])
def test_a_larger_turn_ends_the_pass(about):
    found = turn_limits.limited(line([0, 81, 0], [20, 0.3, 20], about), SETTINGS)
    assert [piece["points"][[0, -1], 0].tolist() for piece in found] == [[0, 20], [20.3, 40.3]]
    for piece in found:
        assert_within(piece, SETTINGS)


def test_a_way_back_ends_the_pass():
    piece = line([0, 0, 0], [20, 10, 20])
    piece["points"][:, 0] = [0, 20, 12, 40]  # back by 8 mm
    found = turn_limits.limited(piece, SETTINGS)
    assert [p["points"][[0, -1], 0].tolist() for p in found] == [[0, 20], [20, 12], [12, 40]]


def test_random_passes_keep_every_limit():
    generator = np.random.default_rng(7)
    for k in range(200):
        n = int(generator.integers(1, 40))
        angles = generator.normal(0, generator.choice([0.5, 5, 40, 120]), n)
        ways = generator.choice([0.0, 1e-7, 0.01, 0.5, 3.0, 25.0], n)
        settings = {**SETTINGS, "max_turn_deg_per_mm": float(generator.choice([1, 30, 300]))}
        for piece in turn_limits.limited(line(angles, ways, "yz"[k % 2]), settings):
            assert len(piece["points"]) > 1 and np.isfinite(piece["normals"]).all()
            assert_within(piece, settings)


def test_a_ring_stays_one_and_is_cut_at_its_edge_only():
    turn = np.radians(np.arange(0, 361, 5.0))
    flat = np.zeros_like(turn)
    normals = np.stack([np.cos(turn), np.sin(turn), flat], 1)
    tangents = np.stack([-np.sin(turn), np.cos(turn), flat], 1)
    ring = {"points": 20 * normals, "normals": normals, "tangents": tangents, "closed": True}
    (found,) = turn_limits.limited(ring, SETTINGS)
    assert found["closed"] and found["points"][0] == pytest.approx(found["points"][-1])
    ring["normals"] = normals.copy()
    ring["normals"][36] = [-math.cos(1.2), 0, math.sin(1.2)]  # one point stands off
    found = turn_limits.limited(ring, SETTINGS)
    assert found and not any(piece["closed"] for piece in found)
    # The beginning of the ring is no end of a piece.
    ends = np.array([piece["points"][k] for piece in found for k in (0, -1)])
    assert np.linalg.norm(ends - ring["points"][0], axis=1).min() > 10


def holed(radius, length=100.0, width=60.0):
    """A plate with a round hole in its middle, as a mesh's BREP; triangles along the hole's border."""
    points, triangles = [], []
    for x in np.arange(0, length + 1, 2.0):
        for y in np.arange(0, width + 1, 2.0):
            points.append([x, y, 0.0])
    rows = int(width / 2) + 1
    for i in range(int(length / 2)):
        for j in range(rows - 1):
            middle = np.array([2 * i + 1 - length / 2, 2 * j + 1 - width / 2])
            if np.linalg.norm(middle) < radius:
                continue
            a = i * rows + j
            triangles += [[a, a + rows, a + rows + 1], [a, a + rows + 1, a + 1]]
    mesh = core.TriangleMesh(np.array(points, np.float32), np.array(triangles, np.uint32))
    return core.shape_from_mesh(mesh).write_brep()


def job_of(brep, **parts):
    machine = {"wheel": WHEEL, "force_N": 30, **parts.pop("machine", {})}
    return jobs.validate(
        {
            "design": {"brep": brep},
            "sampling": {"spacing_mm": 1.0},
            "belt_machine": machine,
            "programs": [{"poses": []}],
            **parts,
        }
    )


def ground(job, laid):
    """(mm3 by pose, to which poses it goes along a pass)."""
    steps = runs.run(jobs.validate({**job, "programs": [{"poses": poses.list_poses(laid)}]})).steps
    volume = np.bincount(
        steps["pose"], steps["removal_rate"] * steps["duration"], len(laid["frames"])
    )
    within = np.zeros(len(volume), dtype=bool)
    within[1:] = path_check.motion(laid)["within"]
    return volume, within


def test_no_hole_is_bridged_by_a_turn_back():
    job = job_of(holed(8.0))
    for spacing in ("even", "lines"):
        laid = raster_path.raster(
            job, {**X, "spacing": spacing, "step_over_mm": 2, "bridge_mm": 30}
        )
        assert laid["check"]["reversals"] == 0 and laid["check"]["fast_turns"] == 0
        assert laid["check"]["turn_deg"] <= 5.0 + 1e-6
        for one in laid["passes"]:
            x = laid["contacts"][one["first"] : one["last"] + 1, 0, 3]
            assert (np.diff(x) > 0).all() or (np.diff(x) < 0).all()


def test_next_to_nothing_is_removed_by_plunging():
    job = job_of(holed(8.0))
    laid = raster_path.raster(job, X)
    volume, within = ground(job, laid)
    assert volume[~within].sum() <= 0.02 * volume.sum()
    assert laid["check"]["plunge_share"] == 0.0 and not laid["check"]["problems"]
    direct = raster_path.raster(job, {**X, "entry": "direct"})
    volume, within = ground(job, direct)
    share = volume[~within].sum() / volume.sum()
    assert share > 0.05
    # The estimate, by force and time, is what the simulation finds.
    assert direct["check"]["plunge_share"] == pytest.approx(share, abs=0.03)
    assert [fact.code for fact in direct["check"]["problems"]] == ["raster.plunges"]
    touched = raster_path.raster(job, {**X, "touch_force_share": 0.3})
    assert 0.0 < touched["check"]["plunge_share"] < direct["check"]["plunge_share"]


def test_the_force_grows_over_the_border():
    job = job_of(holed(0.0))
    laid = raster_path.raster(job, X)
    length = plane_extents(job, engine_input.of(job), raster_path.validate(X))[0]
    assert 3 < length < 20
    for one in laid["passes"]:
        on = slice(one["first"], one["last"] + 1)
        x = np.sort(laid["contacts"][on, 0, 3])
        assert x[[0, -1]] == pytest.approx([-length / 2, 100 + length / 2], abs=1e-3)
        forces = laid["forces"][on]
        assert forces[0] == 0.0 and (forces <= 30).all()
        full = np.flatnonzero(forces < 0)  # the machine's
        assert len(full) and (np.diff(full) == 1).all()
        assert (np.diff(forces[: full[0]]) > 0).all() and (
            np.diff(forces[full[-1] + 1 :]) < 0
        ).all()
    assert laid["beside"] == 0
    short = raster_path.raster(
        job, {**X, "ramp_mm": 4, "lead_mm": 3, "entry_feed_mm_s": 10, "force_N": 20}
    )
    one = short["passes"][0]
    on = slice(one["first"] + 1, one["last"] + 1)
    ramp = short["forces"][on] < 20
    assert ramp.any() and short["feeds"][on][ramp] == pytest.approx(10)
    assert short["feeds"][on][~ramp] == pytest.approx(50) and short["forces"].max() == 20


def test_at_borders_the_force_is_less_and_the_feed_with_it():
    job = job_of(holed(0.0))
    share, spares = 0.2, {"border_force_share": 0.2, "force_N": 20.0}
    half = plane_extents(job, engine_input.of(job), raster_path.validate({**X, **spares}))[0] / 2
    laid = raster_path.raster(job, {**X, **spares})
    for one in laid["passes"]:
        on = slice(one["first"] + 1, one["last"] + 1)
        x = laid["contacts"][one["first"] : one["last"] + 1, 0, 3]
        middle = 0.5 * (x[1:] + x[:-1])
        inside = np.minimum(middle, 100.0 - middle)  # mm from the border
        forces, feeds = laid["forces"][on], laid["feeds"][on]
        grown = np.clip(inside / half, 0.0, 1.0) ** 2
        on_face = inside > 0.0
        wanted = np.maximum(share, grown)[on_face]
        assert forces[on_face] / 20.0 == pytest.approx(wanted, abs=1e-6)
        assert feeds[on_face] / 50.0 == pytest.approx(wanted, abs=0.01)  # in tenths at most
        assert (~on_face).any() and (forces[~on_face] < share * 20.0).all()
    # Where no force is set, nothing of it is.
    for plain in ({"entry": "direct"}, {}):
        control = {"machine": {"control": "position"}} if not plain else {}
        other = job_of(holed(0.0), **control)
        a, b = (raster_path.raster(other, {**X, **plain, **more}) for more in ({}, spares))
        assert (a["feeds"] == b["feeds"]).all() and (a["frames"] == b["frames"]).all()


def test_edges_that_are_kept_are_not_ground():
    """Neither the outer border nor that of the hole; the seams between the mesh's faces are none."""
    keep, stock = 4.0, 0.3
    job = job_of(holed(8.0))
    wanted = {**X, "step_over_mm": 4.0, "keep_edge_mm": keep}
    laid = raster_path.raster(job, wanted)
    length, width = plane_extents(job, engine_input.of(job), raster_path.validate(wanted))
    x, y = laid["contacts"][laid["contact"], :2, 3].T
    assert min(x.min(), 100.0 - x.max()) == pytest.approx(keep + length / 2, abs=1.0)
    assert min(y.min(), 60.0 - y.max()) >= keep + width / 2 - 1e-6
    assert not (np.hypot((x - 50.0), (y - 30.0)) < 8.0 + keep).any()
    ran = runs.run(jobs.validate({**job, "programs": [{"poses": poses.list_poses(laid)}]}))
    points, height = np.asarray(ran.field.points), np.asarray(ran.field.height)
    removed = np.asarray(ran.field.stock_height) - height
    px, py = points[:, 0], points[:, 1]
    off = np.minimum.reduce([px, 100.0 - px, py, 60.0 - py, np.hypot(px - 50.0, py - 30.0) - 9.0])
    assert removed[off < keep - 1.0].max() < 0.02 * stock and removed[off > 12.0].mean() > 0.1
    with pytest.raises(InputError) as refused:
        raster_path.raster(job, {**wanted, "keep_edge_mm": 25.0})
    assert refused.value.code == "raster.no_pass_beside_edges"


def test_beside_a_wall_the_wheel_comes_down_on_the_face():
    # A floor of 60 x 40 with a wall at x = 60.
    points = [[0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0], [60, 0, 30], [60, 40, 30]]
    triangles = [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]
    mesh = core.TriangleMesh(np.array(points, np.float32), np.array(triangles, np.uint32))
    brep = core.shape_from_mesh(mesh).write_brep()
    shape = core.Shape.from_brep(brep, "corner")
    floor = [
        k + 1
        for k in range(shape.face_count)
        if core.sample_faces(shape, [k], 5.0)[0].normals[0][2] > 0.5
    ]
    job = job_of(brep, design={"brep": brep, "faces": floor})
    laid = raster_path.raster(job, {**X, "run_out_mm": 0, "where_it_collides": "warn"})
    x = laid["contacts"][laid["contact"], 0, 3]
    assert x.min() < -2 and x.max() == pytest.approx(60, abs=1e-3)
    assert laid["beside"] == len(laid["passes"])
    # By default it keeps clear of the wall: its axis stays a radius of 20 mm away.
    x = raster_path.raster(job, X)["contacts"][:, 0, 3]
    assert 60 - 20 - 3 < x.max() <= 60 - 20 + 0.5


def test_position_control_and_rigid_wheels_take_no_force():
    job = job_of(holed(0.0), machine={"control": "position"}, law={"model": "geometric"})
    laid = raster_path.raster(job, X)
    assert (laid["forces"] == -1).all() and laid["check"]["plunge_share"] is None
    assert laid["contacts"][laid["contact"], 0, 3].min() < -3  # it comes down outside


def test_the_check_sees_what_is_wrong():
    job, settings = job_of(holed(0.0)), raster_path.validate(X)
    laid = raster_path.raster(job, settings)
    assert not path_check.check(job, settings, laid)["problems"]
    json.dumps(raster_path.summary({**laid, "warnings": []}))
    one = laid["passes"][0]
    k = one["first"] + 5
    bad = {**laid, "contacts": laid["contacts"].copy()}
    turn = math.radians(20)
    bad["contacts"][k, :3, :3] = bad["contacts"][k, :3, :3] @ np.array(
        [[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]]
    )
    found = path_check.check(job, settings, bad)
    assert found["fast_turns"] == 2 and found["turn_deg"] == pytest.approx(20)
    assert "raster.turns_too_fast" in [fact.code for fact in found["problems"]]
    back = {**laid, "contacts": laid["contacts"].copy()}
    back["contacts"][k, 0, 3] = back["contacts"][k - 2, 0, 3]
    found = path_check.check(job, settings, back)
    assert found["reversals"] >= 1
    assert "raster.reverses" in [fact.code for fact in found["problems"]]


def test_the_check_asks_the_jobs_robot():
    near = {"preset": "kuka_kr16_2", "base_from_robot": {"position_mm": [-900, 0, -500]}}
    job = job_of(holed(0.0), robot=near)
    found = raster_path.raster(job, X)["check"]["reach"]
    assert found["poses"] == found["reached"] > 0 or found["events"]
    far = {**near, "base_from_robot": {"position_mm": [-9000, 0, 0]}}
    laid = raster_path.raster(job_of(holed(0.0), robot=far), X)
    assert laid["check"]["reach"]["reached"] == 0
    assert "raster.out_of_reach" in [fact.code for fact in laid["check"]["problems"]]
    assert raster_path.raster(job_of(holed(0.0)), X)["check"]["reach"] is None


@pytest.mark.parametrize(
    "settings",
    [{"max_turn_deg_per_mm": 0}, {"touch_force_share": 1.5}, {"entry": "fly"}, {"lead_mm": -1}],
)
def test_mistakes_are_named(settings):
    with pytest.raises(InputError, match=next(iter(settings))):
        raster_path.raster(job_of(holed(0.0)), {**X, **settings})


CRANK = SHARED / "data" / "cad" / "crank_arm.brep"


@pytest.mark.slow
@pytest.mark.skipif(not CRANK.exists(), reason=f"no shared data at {SHARED}")
def test_a_real_part_with_holes_has_no_violent_motion():
    job = job_of("", design={"file": str(CRANK), "faces": [5]})
    laid = raster_path.raster(job, {})
    seen = laid["check"]  # 173 degrees from pose to pose, and four reversals, before
    assert seen["turn_deg"] <= 5.0 + 1e-6 and seen["turn_deg_per_mm"] <= 30.0 + 1e-6
    assert seen["fast_turns"] == seen["reversals"] == seen["leaps"] == 0


def test_a_ring_that_goes_back_where_it_begins_is_none():
    angle = np.linspace(0.0, 2.0 * math.pi, 200)
    ring = np.stack([30 * np.cos(angle), 30 * np.sin(angle), 0 * angle], axis=1)
    spike = np.vstack([[[30.0, 4.0, 0.0]], ring, [[30.0, 4.0, 0.0]]])
    for points, closed in ((ring, True), (spike, False)):
        normals = np.tile([0.0, 0.0, 1.0], (len(points), 1))
        tangents = np.gradient(points, axis=0)
        tangents /= np.linalg.norm(tangents, axis=1)[:, None]
        piece = {"points": points, "normals": normals, "tangents": tangents, "closed": True}
        left = turn_limits.limited(piece, raster_path.validate({}))
        assert [one["closed"] for one in left if len(one["points"]) > 100] == [closed]
        for one in left:
            steps = np.diff(one["points"], axis=0)
            assert ((steps[1:] * steps[:-1]).sum(axis=1) > 0).all()


def test_a_ring_whose_ends_look_different_ways_is_none():
    """Its beginning was leaned and its end was not: over the seam the wheel would jump."""
    angle = np.linspace(0.0, 2.0 * math.pi, 200)
    points = np.stack([30 * np.cos(angle), 30 * np.sin(angle), 0 * angle], axis=1)
    tangents = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    lean = np.clip(0.2 - 0.02 * np.arange(200), 0.0, None)[:, None]
    outwards = points / 30.0
    normals = np.cos(lean) * outwards + np.sin(lean) * np.array([0.0, 0.0, 1.0])
    piece = {"points": points, "normals": normals, "tangents": tangents, "closed": True}
    (one,) = turn_limits.limited(piece, raster_path.validate({}))
    assert not one["closed"]
    even = {**piece, "normals": outwards}
    assert turn_limits.limited(even, raster_path.validate({}))[0]["closed"]
