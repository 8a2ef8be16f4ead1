"""Jobs with a curved platen, and the frame that holds a free belt or a platen: geometry, bodies, what is refused."""

import math

import numpy as np
import pytest

import beltgrinding
from beltgrinding.cell import collision
from beltgrinding.engine import InputError, core
from beltgrinding.geometry import free_run, pressed_belt
from beltgrinding.job import load as jobs
from beltgrinding.raster import tool as tools
from test_belt_machines import LAYER, belt_job

RADIUS = 80.0


def curved(radius=RADIUS, **machine):
    return belt_job(
        "platen", platen={"radius_mm": radius, "length_mm": 60, "layers": [LAYER]}, **machine
    )


def machine_of(job):
    return jobs.validate(job)["belt_machine"]


def volume(points, triangles):
    a, b, c = np.asarray(points, dtype=float)[triangles].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


@pytest.fixture(scope="module")
def ground():
    return beltgrinding.run(curved())


@pytest.mark.slow
def test_it_holds_its_force_on_a_shorter_contact_than_a_flat_platen(ground):
    assert np.allclose(ground.steps["force"], 20.0, rtol=2e-3)
    assert "not_converged" not in ground.summary["events"]
    assert "R 80 mm" in ground.summary["models"]["compliance"]
    flat = beltgrinding.run(curved(0.0))
    assert ground.steps["contact_area"].max() < 0.7 * flat.steps["contact_area"].max()
    # What is ground is the law's volume on both.
    assert ground.summary["removed_volume_mm3"] == pytest.approx(
        flat.summary["removed_volume_mm3"], rel=0.02
    )


def test_the_report_says_its_radius(ground, tmp_path):
    ground.write(tmp_path)
    text = beltgrinding.report(tmp_path).read_text(encoding="utf-8")
    assert "R 80 mm" in text


def test_the_line_is_an_arc_with_its_tangents():
    machine = machine_of(curved())
    outer, end = free_run.arc(machine)
    assert outer == 81.0 and end == pytest.approx(math.asin(30 / 80))
    first, last = free_run.ends(machine)
    # The free length is that of the middle surface.
    middle = free_run.line(machine, np.linspace(first, last, 20001), 0.5)
    assert np.linalg.norm(np.diff(middle, axis=0), axis=1).sum() == pytest.approx(200.0, rel=1e-6)
    s = np.linspace(-outer * end, outer * end, 7)
    face = free_run.line(machine, s)
    assert np.allclose(np.hypot(face[:, 0], face[:, 1] + outer), outer)
    axes = free_run.roller_axes(machine)
    assert np.allclose(axes[0], axes[1] * [-1, 1])
    # Rollers bear the belt from within, at a right angle to its run.
    at = free_run.line(machine, [last])[0]
    run = at - free_run.line(machine, [last - 1.0])[0]
    assert np.hypot(*(axes[1] - at)) == pytest.approx(1.0 + 25.0)
    assert abs((axes[1] - at) @ run) < 1e-9
    # With a radius that is none, all is as it is when flat.
    flat = machine_of(curved(0.0))
    assert free_run.arc(flat) == (0.0, 0.0)
    assert np.allclose(free_run.roller_axes(flat), [[-100, -26], [100, -26]])


def test_plate_and_layers_lie_under_the_belt_and_are_closed():
    machine = machine_of(curved())
    sizes = []
    for points, triangles in (*free_run.layers(machine), free_run.plate(machine)):
        sizes.append(volume(points, triangles))
        edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        assert len(np.unique(edges, axis=0)) == len(edges)
        assert {tuple(e) for e in edges} == {tuple(e[::-1]) for e in edges}
    end = math.asin(30 / 80)
    assert sizes[0] == pytest.approx(end * (80**2 - 75**2) * 15, rel=1e-3)
    assert sizes[1] == pytest.approx(2 * 75 * math.sin(end) * 10 * 15, rel=1e-3)


def test_the_core_and_what_is_drawn_have_one_geometry():
    machine = machine_of(curved())
    given = jobs.typed(jobs.validate(curved())).belt_machine
    places = np.array([-95.0, -40.0, -10.0, 0.0, 25.0, 70.0])
    for below in (-0.02, 0.02, 1.0):
        x, z = free_run.line(machine, places, below).T
        points = np.stack([x, np.zeros(len(x)), z], axis=1)
        for point in points:
            depth = core.run_fit(given, 50.0, np.eye(4)[None], point[None])[0]
            # Along z, what `below` is along the normal.
            turned = np.clip(np.interp(point[0], x, places) / 81.0, -1, 1) * math.asin(30 / 80)
            assert (depth > 0.0) == (below > 0.0)
            assert depth <= max(below, 0.0) / math.cos(math.asin(30 / 80)) + 1e-3, turned


def test_a_raster_looks_at_the_bent_belt():
    job = jobs.validate(curved())
    tool, flat = tools.of(job), tools.of(jobs.validate(curved(0.0)))
    frame = np.eye(4)[None]  # z into the work
    beside = np.array([[28.0, 0.0, -3.0]])
    assert tool.depth(frame, beside)[0] == 0.0 and flat.depth(frame, beside)[0] > 2.9
    on = np.array([[28.0, 0.0, -(81 - math.sqrt(81**2 - 28**2)) - 0.01]])
    assert tool.under(on, frame, 60.0, 0.0).all() and not flat.under(on, frame, 60.0, 0.0).any()
    assert tool.chord(0.1) == pytest.approx(2 * math.sqrt(2 * 81 * 0.1)) and flat.chord(0.1) == 200
    assert tool.edge_gap(20.0, 15.0) == pytest.approx(400 / (8 * 81))
    assert flat.edge_gap(20.0, 15.0) == pytest.approx(0.05)
    assert (tool.over_border(np.array([0.0, 20.0])) == [0.05, 0.25 * 400 / 162]).all()


@pytest.mark.parametrize(
    ("platen", "run", "code"),
    [
        ({"radius_mm": -1.0}, {}, "base.below_minimum"),
        ({"radius_mm": 34.0}, {}, "job.platen_radius"),  # half of its length is 30 mm
        ({"radius_mm": 40.0, "layers": [{**LAYER, "thickness_mm": 40}]}, {}, "job.platen_layers"),
        ({"radius_mm": 36.0}, {"length_mm": 64}, "job.platen_length"),  # its arc is 71 mm long
        ({"radius_mm": 36.0}, {}, None),
    ],
)
def test_what_cannot_be_is_refused(platen, run, code):
    job = belt_job("platen")
    job["belt_machine"]["platen"].update({"length_mm": 60, **platen})
    job["belt_machine"]["free_run"].update(run)
    if code is None:
        jobs.validate(job)
        return
    with pytest.raises(InputError) as error:
        jobs.validate(job)
    assert error.value.code == code, error.value


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["free_belt", "platen"])
def test_the_runs_beyond_the_rollers_may_not_meet_the_part(kind):
    job = belt_job(kind)
    job["belt_machine"]["free_run"].update(length_mm=120, roller_radius_mm=8)
    if kind == "platen":
        job["belt_machine"]["platen"]["length_mm"] = 60
    plain = beltgrinding.run(job)
    names = {name for pair in plain.summary["clearances"] for name in pair["bodies"]}
    assert not names & {"belt_before", "belt_behind", "arms"}
    job["belt_machine"]["frame"] = {"length_mm": 150, "spread_mm": 60, "arm_thickness_mm": 5}
    framed = beltgrinding.run(job)
    names = {name for pair in framed.summary["clearances"] for name in pair["bodies"]}
    assert {"belt_before", "belt_behind", "arms"} <= names
    assert np.array_equal(plain.field.height, framed.field.height)


@pytest.mark.parametrize("radius", [0.0, 10.0, 25.0])
def test_runs_and_arms_are_closed_and_the_runs_are_tangents(radius):
    for job in (belt_job(), curved()):
        job["belt_machine"]["free_run"]["roller_radius_mm"] = radius
        job["belt_machine"]["frame"] = {
            "length_mm": 120,
            "spread_mm": 70,
            "arm_thickness_mm": 6,
            "arm_sides": "minus_y",
        }
        machine = machine_of(job)
        axes = free_run.roller_axes(machine)
        for side, axis in zip((-1.0, 1.0), axes):
            corners = free_run.run_corners(machine, side)
            touch, far = corners[:2]
            assert np.hypot(*(touch - axis)) == pytest.approx(radius + 1.0)
            assert abs((touch - axis) @ (far - touch)) < 1e-9
            assert side * (touch - axis)[0] > 0.0  # the outer side
            assert far == pytest.approx([side * 35.0, axes[:, 1].min() - 120.0])
            assert volume(*free_run.run(machine, side)) > 0.0
        arms = free_run.arms(machine)
        assert len(arms) == 1 and volume(*arms[0]) > 0.0
        assert arms[0][0][:, 1].max() <= -0.5 * 15 - free_run.GAP + 1e-9
    job["belt_machine"]["frame"]["length_mm"] = radius + 1.0
    with pytest.raises(InputError) as error:
        jobs.validate(job)
    assert error.value.code == "job.short_frame"
    assert "arms" not in dict(collision.machine_bodies(machine_of(belt_job())))


def test_a_part_collides_with_the_run_it_stands_in():
    job = belt_job()
    job["belt_machine"]["free_run"].update(length_mm=50, roller_radius_mm=0)
    # Beside the rollers, over the plate of 60 x 40 mm, the runs lead away nearly level.
    job["belt_machine"]["frame"] = {"length_mm": 40, "spread_mm": 2000}
    for pose in job["programs"][0]["poses"]:
        pose["z_mm"] = 0.5
    hit = set()
    for event in beltgrinding.run(job).events:
        if event["kind"] == "collision":
            hit |= set(event["bodies"])
    assert not hit & {"belt_before", "belt_behind"}
    turned = 0.5 * math.radians(20.0)
    for pose in job["programs"][0]["poses"]:  # about y, so that one of them goes through it
        pose.update(qx=math.cos(turned), qz=math.sin(turned), z_mm=10.0)
    hit = set()
    for event in beltgrinding.run(job).events:
        if event["kind"] == "collision":
            hit |= set(event["bodies"])
    assert hit & {"belt_before", "belt_behind"}


def _ball(radius, z):
    """Points and triangles of a rough ball whose middle lies at z."""
    angles = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    heights = np.linspace(-1.0, 1.0, 25)
    ring = np.sqrt(1.0 - heights**2)
    points = np.stack(
        [
            np.cos(angles)[None, :] * ring[:, None],
            np.sin(angles)[None, :] * ring[:, None],
            np.broadcast_to(heights[:, None], (25, 48)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    i, k = np.meshgrid(np.arange(24), np.arange(48), indexing="ij")
    a, b = i * 48 + k, i * 48 + (k + 1) % 48
    quads = np.stack([a, b, b + 48, a + 48], axis=-1).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return radius * points + [0.0, 0.0, z], triangles


def test_a_free_belt_is_drawn_as_a_string_over_the_part():
    machine = machine_of(belt_job())
    points, triangles = _ball(30.0, 25.0)  # 5 mm through it
    x, depth = pressed_belt.pushed(machine, pressed_belt.slab(points, triangles, 7.5))
    assert (np.diff(x) > 0).all() and depth[[0, -1]] == pytest.approx(0.0)
    assert x[[0, -1]] == pytest.approx([-100, 100]) and depth.max() == pytest.approx(5.0, abs=0.2)
    # A tangent from the roller, and nothing of the part beyond it.
    section = pressed_belt.slab(points, triangles, 7.5)
    assert (np.interp(section[:, 0], x, depth) >= -section[:, 1] - 1e-9).all()
    sine = 30.0 / math.hypot(100.0, 25.0)
    slope = math.tan(math.asin(sine) - math.atan2(25.0, 100.0))
    assert depth[1] / (x[1] - x[0]) == pytest.approx(slope, rel=0.05)
    # Beside the belt, or short of it, nothing presses.
    assert (
        pressed_belt.pushed(machine, pressed_belt.slab(points + [0, 60, 0], triangles, 7.5)) is None
    )
    assert (
        pressed_belt.pushed(machine, pressed_belt.slab(points + [0, 0, 6], triangles, 7.5)) is None
    )
    # A face without corners in the belt's width is seen where it crosses it.
    wide = np.array([[-20.0, -50, -1], [-20, 50, -1], [20, 50, -1], [20, -50, -1]])
    flat = np.array([[0, 1, 2], [0, 2, 3]])
    x, depth = pressed_belt.pushed(machine, pressed_belt.slab(wide, flat, 7.5))
    assert np.interp([-20, 0, 20], x, depth) == pytest.approx([1, 1, 1])


@pytest.mark.parametrize("radius", [0.0, 80.0])
def test_on_a_platen_the_belt_is_pressed_in_where_the_part_is(radius):
    machine = machine_of(curved(radius))
    points, triangles = _ball(30.0, 29.5)
    x, depth = pressed_belt.pushed(machine, pressed_belt.slab(points, triangles, 7.5))
    assert (np.diff(x) >= 0).all()
    assert depth.max() == pytest.approx(0.5, abs=0.1)
    half = math.sqrt(0.5 * 2 * 30.0 if radius == 0 else 1.0 / (1 / 30 + 1 / 81))
    assert np.interp([-2 * half, 2 * half, -99, 99], x, depth) == pytest.approx([0, 0, 0, 0])
