"""Bodies of the cell in a job: what is followed, what is told."""

import json
import os
import time
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import Mesh
import Part
from test_job import DOWN, plate_job

import beltgrinding
from beltgrinding.base import schemas
from beltgrinding.cell import collision, events
from beltgrinding.engine import InputError, core
from beltgrinding.geometry.body_names import LINKS
from beltgrinding.job import load as jobs, poses, workpiece
from beltgrinding.presets import library, robot as robots, robot_shape
from support.block import block, make, write_pass

ROOT = Path(__file__).resolve().parents[2]


SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
BOX_FACES = np.array(
    [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]]
    + [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
)


def box(low, high):
    """core.TriangleMesh of a box between two corners."""
    corners = [[(low, high)[k >> i & 1][i] for i in range(3)] for k in range(8)]
    return core.TriangleMesh(np.array(corners, np.float32), BOX_FACES.astype(np.uint32))


def brep(low, high):
    return core.shape_from_mesh(box(low, high)).write_brep()


def write_stl(path, mesh, unit_mm=1.0):
    """A text STL, in units of ``unit_mm``."""
    lines = ["solid body"]
    for triangle in mesh.triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        for k in triangle:
            lines.append("vertex {:.9g} {:.9g} {:.9g}".format(*(mesh.vertices[k] / unit_mm)))
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid body", ""]))


def collisions(result, kind="collision"):
    return [event for event in result.events if event["kind"] == kind]


def test_a_clamp_in_the_way_is_a_collision_with_its_time():
    job = plate_job()
    # The wheel (60 mm, its body 10 mm less, 15 mm wide) goes along x at 30 mm/s, axis at z = 60.2.
    job["cell"] = {
        "bodies": [
            {"name": "clamp", "frame": "part", "brep": brep([95, 0, 40], [120, 40, 80])},
            {"name": "beside", "frame": "part", "brep": brep([0, 31, 40], [60, 40, 80])},
        ]
    }
    result = beltgrinding.run(job)
    assert not schemas.problems(result.events, events.schema(), "events")
    (event,) = collisions(result)
    assert event["bodies"] == ["clamp", "wheel"] and event["severity"] == "error"
    x = 95 - 50  # where the body's front touches the clamp
    assert event["time"] == pytest.approx((x - 10) / 30, abs=0.01)
    assert event["point"][0] == pytest.approx(95, abs=0.3)
    (near,) = collisions(result, "near_miss") or [None]
    clearances = {tuple(c["bodies"]): c for c in result.summary["clearances"]}
    assert clearances["clamp", "wheel"]["distance_mm"] == 0.0
    side = clearances["beside", "wheel"]
    assert side["distance_mm"] == pytest.approx(31 - 27.5, abs=0.25)
    assert near is None  # 3.5 mm are more than the 2 mm asked for
    job["cell"]["clearance_mm"] = 4.0
    (near,) = collisions(beltgrinding.run(job), "near_miss")
    assert near["bodies"] == ["beside", "wheel"] and near["limit"] == 4.0
    job["cell"]["check_collisions"] = False
    off = beltgrinding.run(job)
    assert not collisions(off) and off.summary["clearances"] == []
    np.testing.assert_array_equal(off.field.height, result.field.height)


def test_the_wheel_keeps_its_body_away_from_the_part_and_its_stock():
    job = plate_job()
    clear = {tuple(c["bodies"]): c for c in beltgrinding.run(job).summary["clearances"]}
    # The programmed pose lies on the stock, 0.2 mm over the plate; the wheel's body 10 mm higher.
    distance = clear["part", "wheel"]["distance_mm"]
    assert distance == pytest.approx(10.0, rel=0.06)
    for pose in job["programs"][0]["poses"]:
        pose["z_mm"] = -11.0
    job["belt_machine"]["force_travel_mm"] = 20.0
    (event,) = collisions(beltgrinding.run(job))
    assert event["bodies"] == ["part", "wheel"]


def test_a_rapid_motion_through_a_sheet_is_seen():
    job = plate_job()
    poses = job["programs"][0]["poses"]
    poses.append({"x_mm": 50, "y_mm": 20, "z_mm": 80, **DOWN, "feed_mm_s": 1000, "rapid": True})
    poses.append({"x_mm": 900, "y_mm": 20, "z_mm": 80, **DOWN, "feed_mm_s": 1000, "rapid": True})
    sheet = brep([600, -200, -200], [600.2, 200, 400])
    job["cell"] = {"bodies": [{"name": "curtain", "brep": sheet}]}
    (event,) = collisions(beltgrinding.run(job))
    assert event["pose"] == 3 and "rapid" in event["message"]


def test_bodies_come_from_files_in_any_unit_and_place(tmp_path):
    mesh = box([0, 0, 0], [10, 20, 30])
    write_stl(tmp_path / "body.stl", mesh, unit_mm=1000.0)
    (tmp_path / "body.brep").write_text(brep([0, 0, 0], [10, 20, 30]))
    turned = {"position_mm": [100, 0, 0], "abc_deg": [90, 0, 0]}  # x to y, y to -x
    for name, unit in (("body.stl", 1000.0), ("body.brep", 1.0)):
        body = {"file": str(tmp_path / name), "unit_mm": unit, "placement": turned}
        found = collision.read_body(body, "body", [])
        np.testing.assert_allclose(found.vertices.min(axis=0), [80, 0, 0], atol=1e-4)
        np.testing.assert_allclose(found.vertices.max(axis=0), [100, 10, 30], atol=1e-4)


def test_wheel_bodies_follow_the_rim():
    def extents(inset=10.0, **wheel):
        job = jobs.validate({**plate_job(), "belt_machine": {"wheel": wheel}})
        body = collision.wheel_body(job["belt_machine"]["wheel"], inset)
        assert body is None or _is_closed(body)
        return None if body is None else np.ptp(body.vertices, axis=0)

    np.testing.assert_allclose(extents(radius_mm=60, width_mm=15), [100, 15, 100], atol=0.21)
    assert extents(radius_mm=9, width_mm=15) is None
    crowned = dict(radius_mm=60, width_mm=30, crown_radius_mm=40)
    np.testing.assert_allclose(extents(**crowned), [100, 30, 100], atol=0.21)
    profile = [[-15, 4], [0, 3], [15, 4]]
    turned = extents(radius_mm=60, width_mm=30, profile_mm=profile)
    np.testing.assert_allclose(turned, [94, 30, 94], atol=0.21)


def test_an_impossible_crown_is_named_before_the_bodies_are_made():
    wheel = {"radius_mm": 60, "width_mm": 30, "crown_radius_mm": 10}
    with pytest.raises(InputError, match="crown radius of 10.* larger than half the width"):
        beltgrinding.run({**plate_job(), "belt_machine": {"wheel": wheel}})


def _is_closed(mesh):
    edges = np.sort(
        np.concatenate(
            [mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]]
        ),
        axis=1,
    )
    return (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_wrong_bodies_are_refused_by_name(tmp_path):
    def message(*bodies):
        with pytest.raises(InputError) as error:
            beltgrinding.run({**plate_job(), "cell": {"bodies": list(bodies)}})
        return str(error.value)

    shape = brep([0, 0, 0], [1, 1, 1])
    assert "exactly one of 'file' or 'brep'" in message({"name": "clamp"})
    assert "'wheel' is taken" in message({"name": "wheel", "brep": shape})
    twice = {"name": "clamp", "brep": shape}
    assert "'clamp' is taken" in message(twice, twice)
    assert "missing.step" in message({"name": "clamp", "file": str(tmp_path / "missing.step")})
    bad = {"name": "clamp", "brep": shape, "placement": {"quaternion_wxyz": [2, 0, 0, 0]}}
    assert "cell.bodies.0.placement.quaternion_wxyz.0" in message(bad)
    bad["placement"] = {"quaternion_wxyz": [1, 1, 0, 0]}
    assert "clamp: placement" in message(bad)


def test_a_real_program_over_a_real_part():
    """The robot program of a sanded aircraft skin over its mesh, with a gantry's post in the way."""
    part = SHARED / "data" / "mesh" / "crs_part_5.stl"
    program = SHARED / "data" / "programs" / "same_path_crs_part5" / "crs_part5.src"
    if not part.exists():
        pytest.skip(f"no shared data: {part}")
    arrays = poses.program_arrays({"file": str(program)}, "crs", [])
    path = core.ToolPath(**arrays)
    skin = core.read_mesh(str(part), 1000.0)
    places = arrays["frames"][:, :3, 3]
    middle = places[len(places) // 2]
    tool = box([-60, -60, -200], [60, 60, -15])  # behind the tool's point: z goes into the part
    post = box(middle + [-40, -40, -30], middle + [40, 40, 500])
    bodies = [
        {"name": "part", "frame": "part", "mesh": skin},
        {"name": "post", "frame": "base", "mesh": post},
        {"name": "sander", "frame": "tool", "mesh": tool},
    ]
    begin = time.perf_counter()
    found = core.check_collisions(path, bodies, 2.0)
    print(f"\n{len(places)} poses, {time.perf_counter() - begin:.2f} s")
    least = {tuple(pair["bodies"]): pair["distance"] for pair in found["pairs"]}
    assert least["post", "sander"] == 0.0
    hit = next(e for e in found["events"] if e["bodies"] == ["post", "sander"])
    assert hit["kind"] == "collision"
    # Before it, no look at the path between the poses finds the post touched.
    for t in np.linspace(0.0, hit["time"] - 1e-3, 200):
        frame, _ = path.frame_at(t)
        inside = np.linalg.inv(frame) @ np.append(middle, 1.0)
        assert not (np.abs(inside[:2]) < 59).all() or not -200 < inside[2] < -16


@pytest.mark.slow
@pytest.mark.freecad
def test_bodies_of_a_document_are_those_of_its_job():
    write_pass()
    doc = FreeCAD.newDocument("cell")
    job = make(block(doc))
    machine = doc.BeltMachine
    first = doc.addObject("Part::Feature", "First")
    first.Label, first.Shape = "clamp", Part.makeBox(25, 40, 40)
    first.Placement.Base = (95, 0, 60)
    second = doc.addObject("Part::Feature", "Second")
    second.Label, second.Shape = "clamp", Part.makeBox(1, 1, 1)
    third = doc.addObject("Mesh::Feature", "Third")
    third.Label, third.Mesh = "part", Mesh.createBox(10, 10, 10)
    third.Placement.Base = (500, 0, 0)
    machine.BodiesAtPart = [first]
    machine.BodiesInBase = [second, third]
    simulation = beltgrinding.simulate(job)
    hits = [e for e in simulation.Proxy.events(simulation) if e["kind"] == "collision"]
    assert [e["bodies"] for e in hits] == [["clamp", "wheel"]], hits
    assert abs(hits[0]["time"] - (95 - 50 - 10) / 30) < 0.01
    assert not simulation.OutOfDate

    beltgrinding.export_job(job, "job.json")
    given = json.loads(Path("job.json").read_text())["cell"]
    named = {b["name"]: b["frame"] for b in given["bodies"]}
    assert named == {second.Label: "base", "part 2": "base", "clamp": "part"}, named
    assert given["clearance_mm"] == machine.Clearance.Value == 2.0
    result = beltgrinding.run("job.json")
    assert [e["bodies"] for e in result.events if e["kind"] == "collision"] == [["clamp", "wheel"]]

    # Its meshes lie beside it under its name, and replace nothing.
    meshes = lambda: sorted(path.name for path in Path().glob("*.ply"))
    assert meshes() == ["job_body2.ply"]
    first_file = Path("job_body2.ply").read_bytes()
    beltgrinding.export_job(job, "job.json")
    assert meshes() == ["job_body2.ply"]
    Path("body2.ply").write_text("mine")
    Path("next_body2.ply").write_text("mine")
    beltgrinding.export_job(job, "next.json")
    assert meshes() == ["body2.ply", "job_body2.ply", "next_body2.ply", "next_body2_2.ply"]
    assert Path("body2.ply").read_text() == Path("next_body2.ply").read_text() == "mine"
    assert Path("next_body2_2.ply").read_bytes() == Path("job_body2.ply").read_bytes() == first_file
    written = json.loads(Path("next.json").read_text())["cell"]["bodies"]
    assert [b["file"] for b in written if "file" in b] == ["next_body2_2.ply"]

    # The job's file makes the same document.
    other = FreeCAD.newDocument("again")
    again = beltgrinding.open_job(other, "job.json")
    assert len(other.BeltMachine.BodiesInBase) == 2 and len(other.BeltMachine.BodiesAtPart) == 1
    box = other.BeltMachine.BodiesAtPart[0].Shape.BoundBox
    assert abs(box.XMin - 95) < 1e-6 and abs(box.ZMax - 100) < 1e-6, box
    mesh = other.BeltMachine.BodiesInBase[1].Mesh
    assert abs(mesh.BoundBox.XMin - 495) < 1e-3 and mesh.CountFacets == 12
    second_run = beltgrinding.simulate(again)
    kinds = [e["kind"] for e in second_run.Proxy.events(second_run)]
    assert kinds.count("collision") == 1

    # A body that moves makes the result out of date.
    first.Placement.Base = (300, 0, 60)
    doc.recompute()
    assert simulation.OutOfDate
    assert "collision" not in [e.split(":")[0] for e in beltgrinding.simulate(job).Events]


@pytest.mark.slow
def test_an_invalid_part_is_ground_but_not_checked():
    class Invalid:
        valid = False

    job, warnings = jobs.validate(plate_job()), []
    assert workpiece.read_design(job["design"]).valid
    assert collision.check(job, Invalid(), [], warnings) == []
    assert "not checked" in warnings[0]
    path = SHARED / "data" / "cad_nasty" / "spring_invalid.igs"
    if path.exists():
        assert not core.Shape.read(str(path)).valid


def arm_job(radii=(), base=(-500, 20, -300), holding="tool_in_hand"):
    """The plate, ground by an ABB IRB 1200 with a tool of 250 mm."""
    job = plate_job()
    job["robot"] = {
        "preset": "abb_irb1200_5_90",
        "base_from_robot": {"position_mm": list(base)},
        "flange_from_tcp": {"position_mm": [0, 0, 250]},
        "link_radii_mm": list(radii),
    }
    return job


@pytest.mark.slow
def test_the_robots_arm_takes_part():
    result = beltgrinding.run(arm_job())
    least = {tuple(c["bodies"]): c["distance_mm"] for c in result.summary["clearances"]}
    # What stands still meets all links; the wheel, in the hand, all but the last, which it moves with.
    for name in LINKS:
        assert ("part", name) in least
        assert (("wheel", name) in least) == (name not in LINKS[6:])
    assert not collisions(result) and least["part", "robot foot"] > 300
    # The foot in the plate.
    (event,) = [
        event
        for event in collisions(beltgrinding.run(arm_job(base=(-60, 20, -150))))
        if event["bodies"] == ["part", "robot foot"]
    ]
    assert event["time"] == 0 and event["severity"] == "error"
    # A foot of 0 mm is none.
    thin = beltgrinding.run(arm_job([0, 1, 1, 1, 1, 1, 1], (-60, 20, -150)))
    assert not any("robot foot" in event["bodies"] for event in thin.events)
    off = arm_job(base=(-60, 20, -150))
    off["cell"] = {"check_collisions": False}
    assert not collisions(beltgrinding.run(off))


def test_radii_of_links_are_asked_for_as_seven():
    with pytest.raises(InputError, match="robot.link_radii_mm: 3 radii; give seven"):
        beltgrinding.run(arm_job([1, 2, 3]))
    with pytest.raises(InputError, match="link_radii_mm"):
        beltgrinding.run(arm_job([-1] * 7))


@pytest.mark.slow
@pytest.mark.parametrize("preset", [one["id"] for one in library.robots()])
def test_a_preset_has_the_shape_of_an_arm(preset):
    robot = robots.checked({"preset": preset})
    arm, links = robots.arm_of(robot), robots.links_of(robot)
    assert len(links) == 7
    least = min(float(points[:, 2].min()) for points, _ in links[0] if len(points))
    assert least == pytest.approx(robots.model_of(robot)["floor_mm"], abs=1e-6)
    for parts in links:
        points, faces = robot_shape.body(*parts)
        if not len(faces):
            continue
        edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        _, count = np.unique(edges, axis=0, return_counts=True)
        assert (count == 2).all()  # closed
        a, b, c = points[faces].transpose(1, 0, 2)
        assert np.einsum("ij,ij->", np.cross(a, b), c) > 0  # the right side out
    # Stretched out, the arm reaches from the foot to the flange.
    everything = np.concatenate([robot_shape.body(*parts)[0] for parts in links])
    flange = arm.forward(np.zeros(6))[:3, 3]
    assert np.linalg.norm(everything - flange, axis=1).min() < 0.1 * arm.length
