"""What goes with the wheel or the belt must have room beside a raster path's passes as well."""

import json

import numpy as np
import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding.job import load, poses
from beltgrinding.objects import raster_path as objects
from beltgrinding.raster import raster_path
from beltgrinding.raster.held import Held
from beltgrinding.simulation import run as runs
from test_clearing import WIDTH, X, floor_of, job_of, on_passes, parts, wall  # noqa: F401

ARM = 8.0
FORK = {"length_mm": 100.0, "spread_mm": 40.0, "arm_thickness_mm": ARM}


def with_fork(job, **more):
    data = json.loads(json.dumps(job))
    data["belt_machine"].update(kind="small_wheel", fork=FORK)
    data.update(more)
    return load.validate(data)


def box(folder, name, low, high):
    """An STL file of a box."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    points = np.array(low) + corners * (np.array(high) - low)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    lines = ["solid box"]
    for a, b, c, d in faces:
        for three in ((a, b, c), (a, c, d)):
            lines.append("facet normal 0 0 0\nouter loop")
            lines += ["vertex {} {} {}".format(*points[k]) for k in three]
            lines.append("endloop\nendfacet")
    path = folder / f"{name}.stl"
    path.write_text("\n".join(lines + ["endsolid box"]))
    return str(path)


def told(laid, code):
    return [fact for fact in laid["warnings"] if fact.code == code]


def farthest(laid):
    """mm, of the passes towards the wall at y = 60."""
    return on_passes(laid)[:, 1, 3].max()


def collisions(job, laid):
    """Pairs of bodies that meet, as the simulation tells them."""
    job = load.validate(
        {**json.loads(json.dumps(job)), "programs": [{"poses": poses.list_poses(laid)}]}
    )
    return {tuple(e["bodies"]) for e in runs.run(job).events if e["kind"] == "collision"}


@pytest.mark.slow
def test_a_fork_keeps_passes_off_a_wall(wall):
    upright = {**X, "max_tilt_deg": 0.0}
    bare = raster_path.raster(wall, upright)
    forked = raster_path.raster(with_fork(wall), upright)
    # The arm stands 1 mm beside the wheel.
    assert farthest(bare) == pytest.approx(60.0 - 0.5 * WIDTH, abs=3.5)
    assert farthest(forked) <= 60.0 - 0.5 * WIDTH - 1.0 - ARM
    assert farthest(forked) == pytest.approx(60.0 - 0.5 * WIDTH - 1.0 - ARM, abs=3.5)
    (fact,) = told(forked, "raster.held_in_the_way")
    assert "fork" in str(fact) and not told(bare, "raster.held_in_the_way")
    lost = bare["reachable"]["share"] - forked["reachable"]["share"]
    assert lost == pytest.approx((1.0 + ARM) / 60.0, abs=0.03)
    assert fact.arguments["share"] == pytest.approx(100.0 * lost, abs=1.0)
    assert not told(forked, "raster.held_does_not_fit")


def test_what_is_laid_so_runs_into_nothing(wall):
    job = with_fork(wall, sampling={"spacing_mm": 1.0})
    laid = raster_path.raster(job, {**X, "step_over_mm": 6.0})
    assert not collisions(job, laid)
    blind = with_fork(wall, cell={"check_collisions": False})
    warned = raster_path.raster(blind, {**X, "step_over_mm": 6.0})
    assert farthest(warned) > farthest(laid) + 3.0
    assert collisions(job, warned) == {("part", "fork")}


def test_laid_all_the_same_it_tells_the_poses(wall):
    laid = raster_path.raster(with_fork(wall), {**X, "where_it_collides": "warn"})
    (fact,) = told(laid, "raster.held_does_not_fit")
    on = laid["contact"] & (laid["contacts"][:, 1, 3] > 60.0 - 0.5 * WIDTH - 1.0 - ARM)
    assert fact.arguments["count"] == on.sum()
    assert fact.arguments["pose"] == np.flatnonzero(on)[0] + 1
    # The depth of the wheel stays a number.
    assert np.isfinite(laid["fit"]).all()


@pytest.mark.parametrize("holding", ["tool_in_hand", "part_in_hand"])
def test_bodies_of_the_cell_that_go_with_the_wheel(wall, tmp_path, holding):
    """A housing beside the wheel, on the side of the wall, however it is given."""
    low, high = [-30.0, -20.0, -60.0], [30.0, -5.5, -3.0]  # y points away from the wall
    frame = {"position_mm": [10.0, -20.0, 30.0], "quaternion_wxyz": [1, 0, 0, 0]}
    cell = {"holding": holding}
    if holding == "tool_in_hand":
        cell["tcp_from_contact"], carrier = frame, "tool"
    else:
        cell["base_from_contact"], carrier = frame, "base"
    shift = np.array(frame["position_mm"])
    settings = {**X, "max_tilt_deg": 0.0}
    data = json.loads(json.dumps(wall))
    bare = raster_path.raster(load.validate({**data, "cell": cell}), settings)
    found = []
    for body in (
        {"name": "housing", "file": box(tmp_path, "a", low, high), "frame": "wheel"},
        {
            "name": "housing",
            "file": box(tmp_path, "b", low + shift, high + shift),
            "frame": carrier,
        },
    ):
        job = load.validate({**data, "cell": {**cell, "bodies": [body]}})
        found.append(raster_path.raster(job, settings))
    first, second = found
    assert np.allclose(first["contacts"], second["contacts"], atol=1e-6)
    assert farthest(bare) > farthest(first) + 10.0
    assert farthest(first) <= 60.0 - 20.0
    assert "housing" in str(told(first, "raster.held_in_the_way")[0])


def test_where_it_is_in_the_way_everywhere_that_is_told(wall, tmp_path):
    body = {
        "name": "drip tray",
        "file": box(tmp_path, "tray", [-5, -5, 2], [5, 5, 6]),
        "frame": "wheel",
    }
    data = json.loads(json.dumps(wall))
    laid = raster_path.raster(load.validate({**data, "cell": {"bodies": [body]}}), X)
    assert laid["no_room"] and laid["passes"]
    (fact,) = told(laid, "raster.no_room_for_held")
    assert "drip tray" in str(fact) and not told(laid, "raster.no_room")
    assert laid["warnings"][0] is fact


def test_of_an_invalid_part_it_is_told_that_nothing_is_known(wall):
    class Invalid:
        valid = False

    warnings = []
    held = Held(with_fork(wall), Invalid(), warnings, None)
    held.mount(with_fork(wall)["belt_machine"])
    assert [fact.code for fact in warnings] == ["raster.held_not_looked_at"] and not held.names
    for quiet in (wall, with_fork(wall, cell={"check_collisions": False})):
        Held(quiet, Invalid(), warnings, None)
    assert len(warnings) == 1


def test_the_stock_is_part_of_the_part(wall):
    from beltgrinding.job import workpiece

    shape = workpiece.read_design(wall["design"])
    frames = np.eye(4)[None].repeat(2, axis=0)
    frames[:, :3, :3] = np.diag([1.0, -1.0, -1.0])
    arm = 0.5 * WIDTH + 1.0 + ARM
    frames[:, :3, 3] = [[40.0, 60.0 - arm - 1.5, 0.0], [40.0, 60.0 - arm - 2.5, 0.0]]
    held = {}
    for allowance in (0.0, 2.0):
        job = with_fork(wall, stock={"allowance_mm": allowance})
        held[allowance] = Held(job, shape, [], None)
        held[allowance].mount(job["belt_machine"])
    assert held[0.0].first_met(frames).tolist() == [-1, -1]
    met = held[2.0].first_met(frames)
    assert met[1] == -1 and held[2.0].names[met[0]] == "fork"
    assert (held[0.0].first_met(frames, 3.0) >= 0).all()


def test_a_belt_brings_its_arms_nearer_by_what_it_gives_way(wall):
    from beltgrinding.job import workpiece

    data = json.loads(json.dumps(wall))
    machine = {
        "kind": "free_belt",
        "force_N": 10,
        "force_travel_mm": 30,
        "free_run": {"width_mm": 20, "length_mm": 80, "tension_N_per_mm": 3, "roller_radius_mm": 8},
        "frame": {"length_mm": 60, "arm_thickness_mm": 5},
    }
    job = load.validate({**data, "belt_machine": machine})
    held = Held(job, workpiece.read_design(job["design"]), [], None)
    frames = np.eye(4)[None]
    frames[0, :3, :3] = np.diag([1.0, -1.0, -1.0])
    frames[0, :3, 3] = [40.0, 30.0, 0.0]
    met = {}
    for advance in (0.0, 10.0):
        held.mount(job["belt_machine"], advance)
        met[advance] = held.first_met(frames)[0]
    assert met[0.0] == -1 and held.names[met[10.0]] in ("arms", "belt_before", "belt_behind")


@pytest.mark.slow
@pytest.mark.freecad
def test_a_documents_passes_keep_off_bodies_and_are_laid_anew_with_them():
    V = FreeCAD.Vector
    doc = FreeCAD.newDocument("held")
    part = doc.addObject("Part::Feature", "Plate")
    part.Shape = Part.makeBox(80, 60, 10, V(0, 0, -10))
    clamp = doc.addObject("Part::Feature", "Clamp")
    clamp.Shape = Part.makeBox(20, 60, 30, V(60, 0, 0))
    housing = doc.addObject("Part::Feature", "Housing")  # before the wheel's left face
    housing.Shape = Part.makeBox(60, 15, 60, V(-30, -25, -66))
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
    stock = beltgrinding.make_stock(job, Allowance="0.2 mm")
    machine = beltgrinding.make_belt_machine(job, Force="20 N", WheelRadius=20, WheelWidth=10)
    path = beltgrinding.make_raster(job, Along="direction", Direction=V(1, 0, 0), StepOver="5 mm")

    def ends():
        frames = np.asarray(path.Proxy.arrays(path)["frames"])
        on = ~np.asarray(path.Proxy.arrays(path)["rapid"]) & (frames[:, 2, 3] < 1e-6)
        return frames[on, 0, 3].max(), frames[on, 1, 3].max()

    free = ends()
    assert free[0] > 75 and path.LeftOut < 1, (free, path.LeftOut)
    machine.BodiesAtPart = [clamp]
    doc.recompute()
    clamped = ends()
    assert clamped[0] < 60 and path.LeftOut > 30, (clamped, path.LeftOut)
    # The same as from the job's file.
    beltgrinding.export_job(job, "job.json")
    given = objects.settings_of(path)
    laid = raster_path.raster(load.load("job.json"), given)
    assert np.allclose(laid["frames"], path.Proxy.arrays(path)["frames"], atol=1e-4)
    clamp.Placement.Base = V(0, 0, 200)
    doc.recompute()
    assert abs(ends()[0] - free[0]) < 1e-6

    # What goes with the wheel: below the floor's level beside it, it keeps the wheel on the plate's one side.
    stop = doc.addObject("Part::Feature", "Stop")
    stop.Shape = Part.makeBox(80, 10, 8, V(0, 60, 0))
    machine.BodiesAtWheel = [housing]
    machine.BodiesAtPart = [stop]
    doc.recompute()
    told = "\n".join(path.Warnings)
    assert "Housing" in told and ends()[1] < 60 - 20, (told, ends())
    machine.CheckCollisions = False
    doc.recompute()
    assert "Housing" not in "\n".join(path.Warnings) and ends()[1] > 50

    # Its distance to the part counts the stock; without such bodies passes stay as they are when that changes.
    machine.CheckCollisions = True
    doc.recompute()
    before = path.Inputs
    stock.Allowance = "0.4 mm"
    doc.recompute()
    assert path.Inputs != before
    machine.BodiesAtWheel = machine.BodiesAtPart = []
    doc.recompute()
    before = path.Inputs
    stock.Allowance = "0.6 mm"
    doc.recompute()
    assert path.Inputs == before
