"""What is kept from run to run, and that no run ever takes a stage of other inputs: every key of a job is changed,
and the run that may take kept stages is compared with one that has none, to the last bit."""

import copy
import json
import os
import threading
from functools import lru_cache

import numpy as np
import pytest

from beltgrinding.base import kept
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.job.workpiece import OwnBrep
from beltgrinding.presets import library
from beltgrinding.simulation import run as runs
from support import synthetic_finish
from test_job import DOWN

HEAT = {"conductivity_W_mK": 15.0, "heat_capacity_J_kgK": 500.0, "density_kg_m3": 7900.0}
HEAT |= {"friction": [0.3, 0.6], "partition": [0.5, 0.8]}
FINISH = {"grit": 120, "initial_Ra_um": 3.2, "model": synthetic_finish.model()}
ROBOT, DH_ROBOT = (library.find("robots", name)["model"] for name in ("kuka_kr16_2", "ur10e"))


def thick():
    """A solid stock around the part."""
    return box(20.0, 12.0, 7.0)


@lru_cache(maxsize=None)
def box(length=20.0, width=12.0, height=5.0):
    """(B-rep's text of a solid below z = 0, the number of its face on top)."""
    corners = np.array(np.meshgrid([0, length], [0, width], [-height, 0])).T.reshape(-1, 3)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [[q[0], q[k], q[k + 1]] for q in quads for k in (1, 2)]
    mesh = core.TriangleMesh(corners.astype(np.float32), np.array(faces, np.uint32))
    shape = core.shape_from_mesh(mesh)
    for face in range(shape.face_count):
        if core.sample_faces(shape, [face], 4.0)[0].normals[0][2] > 0.9:
            return shape.write_brep(), face + 1
    raise AssertionError("no face on top")


def write_slab(path, height, length=24.0, width=16.0):
    """A mesh of stock over the part, higher at one end, as a PLY."""
    corners = [(-2, -2, height), (length, -2, height), (length, width, height + 0.1)]
    corners.append((-2, width, height))
    head = ["ply", "format ascii 1.0", "element vertex 4"]
    head += [f"property float {axis}" for axis in "xyz"]
    head += ["element face 2", "property list uchar int vertex_indices", "end_header"]
    rows = [" ".join(map(str, corner)) for corner in corners]
    path.write_text("\n".join([*head, *rows, "3 0 1 2", "3 0 2 3", ""]))


AXES = "UNITS/MM\nGOTO/4,6,0.1,0,0,1\nGOTO/10,6,0.1,0,0,1\nGOTO/16,6,0.1,0,0,1\nFINI\n"


def table(depth):
    rows = ["x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"]
    rows += [f"{x},6,{depth},0,1,0,0,40" for x in (4, 10, 16)]
    return "\n".join(rows) + "\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Files of all kinds that jobs read."""
    found = tmp_path_factory.mktemp("kept")
    for name, size in (("plate", (20.0, 12.0)), ("other", (20.0, 13.0)), ("body", (3.0, 3.0))):
        (found / f"{name}.brep").write_text(box(*size)[0])
    for name, height in (("stock", 0.15), ("thick", 0.25)):
        write_slab(found / f"{name}.ply", height)
    (found / "axes.apt").write_text(AXES)
    (found / "pass.csv").write_text(table(0.1))
    (found / "deep.csv").write_text(table(-0.1))
    return found


def own_part():
    return {"brep": OwnBrep(box()[0]), "faces": [box()[1]]}


def pose(x, z=0.1, **more):
    return {"x_mm": x, "y_mm": 6, "z_mm": z, **DOWN, "feed_mm_s": 40, **more}


def allowance_job(folder):
    """A part on the table, a tool in the robot's hand; feeds and forces pose by pose, and a body nearby."""
    body = {"name": "post", "brep": OwnBrep(box(3.0, 3.0)[0]), "frame": "part"}
    return {
        "design": own_part(),
        "sampling": {"spacing_mm": 1.0},
        "stock": {"allowance_mm": 0.2},
        "belt_machine": {
            "wheel": {"radius_mm": 30, "width_mm": 8},
            "force_N": 20,
            "compliance": {"model": "elastic_foundation"},
        },
        "cell": {
            "bodies": [{**body, "placement": {"position_mm": [21, 5, 2]}}],
            "base_from_work": {"position_mm": [0, 0, 0]},
            "check_collisions": False,
        },
        "programs": [
            {"poses": [pose(2, 3, rapid=True), pose(5), pose(10, force_N=15), pose(16)]},
            {"file": str(folder / "pass.csv")},
        ],
        "inspection": {
            "zones": [{"name": "rim", "faces": [box()[1]], "tolerance_mm": [-0.1, 0.1]}],
            "sections": [{"name": "middle", "point_mm": [1, 2, 0], "normal": [1, 0, 0]}],
        },
    }


def robot_job(folder):
    """The same with a robot, whose arm is followed, and files."""
    job = allowance_job(folder)
    del job["programs"][1:]
    job["robot"] = {"model": copy.deepcopy(ROBOT)}
    job["robot"]["base_from_robot"] = {"position_mm": [-900, 0, -600]}
    track = {"kind": "linear", "carries": "robot", "axis": [0, 1, 0], "lower": -300, "upper": 300}
    job["robot"]["external_axes"] = [{**track, "position": 20}]
    job["design"] = {"file": str(folder / "plate.brep"), "faces": [box()[1]]}
    job["cell"]["check_collisions"] = True
    body = job["cell"]["bodies"][0]
    del body["brep"]
    body["file"] = str(folder / "body.brep")
    return job


def mesh_job(folder):
    """The part in the robot's hand, with stock from a mesh, and belts that wear and load."""
    half = {"position_mm": [500, 0, 400], "quaternion_wxyz": [0, 1, 0, 0]}
    poses = []
    for x in (4, 9, 15):
        poses.append({"x_mm": 500 - x, "y_mm": -6.0, "z_mm": 400 - 0.1})
        poses[-1].update({"qw": 1, "qx": 0, "qy": 0, "qz": 0, "feed_mm_s": 30, "zone_mm": 0.5})
    return {
        "design": own_part(),
        "sampling": {"spacing_mm": 1.0, "precision_mm": 0.2, "edge_spacing_mm": 0.5},
        "stock": {
            "kind": "mesh",
            "file": str(folder / "stock.ply"),
            "placement": {"position_mm": [0, 0, 0]},
        },
        "belt_machine": {
            "wheel": {"radius_mm": 30, "width_mm": 8},
            "control": "position",
            "robot_stiffness_N_per_mm": 100.0,
            "compliance": {
                "model": "elastic_foundation",
                "layers": [
                    {"thickness_mm": 5, "youngs_modulus_MPa": 4, "poissons_ratio": 0.4},
                ],
            },
        },
        "law": {
            "model": "local",
            "wear": {"model": "exponential", "scale": 5000.0, "loading_share": 0.3},
        },
        "cell": {
            "holding": "part_in_hand",
            "base_from_contact": half,
            "check_collisions": False,
        },
        "programs": [{"poses": poses}],
        "simulation": {"timing": "trapezoidal"},
    }


BASES = {"allowance": allowance_job, "mesh": mesh_job, "robot": robot_job}
SLOW = "robot"  # where bodies are followed: only for keys that begin so
FOLLOWED = ("robot.", "cell.bodies", "cell.c", "cell.w")

# Values of keys that no rule makes; functions of the folder of files. What changes with them: ALONG.
BELT = {  # a machine for which the keys of a free belt and a platen count
    "kind": "platen",
    "force_N": 20,
    "force_travel_mm": 8,
    "free_run": {"width_mm": 8, "length_mm": 90},
    "platen": {
        "length_mm": 50,
        "layers": [{"thickness_mm": 4, "youngs_modulus_MPa": 3, "poissons_ratio": 0.4}],
    },
    "frame": {"length_mm": 80, "arm_thickness_mm": 4},
}
MACHINE = jobs.schema()["properties"]["belt_machine"]["properties"]
BELT_KEYS = [
    *(f"free_run.{name}" for name in MACHINE["free_run"]["properties"]),
    *(f"platen.{name}" for name in MACHINE["platen"]["properties"] if name != "layers"),
    *(
        f"platen.layers.0.{name}"
        for name in MACHINE["platen"]["properties"]["layers"]["items"]["properties"]
    ),
    *(f"frame.{name}" for name in MACHINE["frame"]["properties"]),
]
VALUES = {
    "design.file": lambda folder: str(folder / "other.brep"),
    "design.brep": lambda _: OwnBrep(box(20.0, 13.0)[0]),
    "design.faces": lambda _: [],
    "design.flip_faces": lambda _: [1],
    "stock.file": lambda folder: str(folder / "thick.ply"),
    "stock.brep": lambda _: OwnBrep(thick()[0]),
    "stock.kind": lambda _: "mesh",
    "stock.left_by": lambda folder: str(folder / "none.h5"),
    "belt_machine.platen.length_mm": lambda _: 12.0,
    "belt_machine.platen.radius_mm": lambda _: 40.0,
    "belt_machine.frame.length_mm": lambda _: 60.0,
    "belt_machine.compliance.surrogate_file": lambda folder: str(folder / "none.npz"),
    "belt_machine.wheel.crown_radius_mm": lambda _: 60.0,
    "belt_machine.force_device.name": lambda _: "aoForce",
    "belt_machine.force_device.template": lambda _: "FORCE({newton:.1f})",
    "programs.0.poses.0.qw": lambda _: 0.99874922,
    "programs.0.poses.0.qx": lambda _: 0.05,
    "programs.0.poses.0.qy": lambda _: 0.05,
    "programs.0.poses.0.qz": lambda _: 0.05,
    "programs.0.roll": lambda _: "along",
    "robot.model.urdf": lambda folder: str(folder / "none.urdf"),
    "robot.model.base_link": lambda _: "base",
    "robot.model.tip_link": lambda _: "tip",
    "robot.packages": lambda folder: [str(folder)],
    "robot.load.inertia_kg_m2": lambda _: [0.1, 0.1, 0.1],
    "law.calibration.parameters": lambda _: ["coefficient"],
    "law.calibration.covariance": lambda _: [[1e-12]],
    "law.calibration.widening": lambda _: 1.5,
    "law.calibration.fit": lambda _: {"grinds": 7},
    "heat.material": lambda _: "another",
    "heat.density_kg_m3": lambda _: 9000.0,
    "heat.friction": lambda _: [0.2, 0.5],
    "heat.partition": lambda _: [0.4, 0.9],
    "heat.burn_source": lambda _: "another",
    "heat.burn_temperature_C": lambda _: 25.0,
    "finish.grit": lambda _: 100.0,
    "finish.crossing_angle_deg": lambda _: 35.0,
    "finish.rest_per_pass": lambda _: 0.2,
    "finish.model.rest_per_pass": lambda _: 0.2,
    "finish.model.source": lambda _: "another",
    "finish.model.calibration": lambda _: {"measurements": 7},
    "finish.model.ranges.grit": lambda _: [50.0, 500.0],
    "finish.model.ranges.pressure_MPa": lambda _: [0.0, 9.0],
    "finish.model.ranges.belt_speed_m_s": lambda _: [11.0, 35.0],
    "finish.model.ranges.feed_mm_s": lambda _: [16.0, 120.0],
    "finish.model.ranges.remaining_cut": lambda _: [0.3, 1.0],
    "inspection.zones.0.finish.Ra_max_um": lambda _: 2.5,
    "inspection.zones.0.finish.lay_direction": lambda _: [0.0, 1.0, 0.0],
    "inspection.zones.0.finish.lay": lambda _: "X",
    "robot.program.home_joints_deg": lambda _: [0.0, -90.0, 90.0, 0.0, 60.0, 0.0],
    "robot.program.safe_joints_deg": lambda _: [[0.0, -90.0, 90.0, 0.0, 60.0, 0.0]],
    "robot.program.joint_acceleration_deg_s2": lambda _: [500.0] * 6,
    "robot.program.joint_jerk_deg_s3": lambda _: [5000.0] * 6,
    "robot.program.base": lambda _: "FIXTURE",
    "cell.bodies.0.name": lambda _: "pillar",
    "cell.bodies.0.file": lambda folder: str(folder / "other.brep"),
    "cell.bodies.0.brep": lambda _: OwnBrep(box(4.0, 4.0)[0]),
    "robot.controller": lambda _: "krc4",
    "robot.preset": lambda _: "kuka_kr16_2",
    "robot.start_joints_deg": lambda _: [0.0, -80.0, 90.0, 0.0, 40.0, 0.0],
    "robot.link_radii_mm": lambda _: [90.0] * 7,
    "programs.0.file": lambda folder: str(folder / "deep.csv"),
    "programs.0.name": lambda _: "another",
    "programs.0.values": lambda _: {},
    "inspection.zones.0.name": lambda _: "another",
    "inspection.zones.0.faces": lambda _: [],
    "inspection.sections.0.name": lambda _: "another",
    "inspection.sections.0.point_mm": lambda _: [1.0, 2.0, 3.0],
    "inspection.sections.0.normal": lambda _: [0.0, 1.0, 0.0],
    "inspection.sections.0.leading": lambda _: [1.0, 0.0, 0.0],
    "inspection.sections.0.edge_distances_mm": lambda _: [0.5, 1.0],
}
NUMBERS = {  # of arrays
    "quaternion_wxyz": [0.99875026, 0.0, 0.0, 0.04997917],
    "profile_mm": [[-4.0, 0.2], [0.0, 0.0], [4.0, 0.1]],
    "curve": [[0.1, 1.0], [1.0, 0.5]],
}
ALONG = {  # keys that must come or go with a key
    "design.file": {"design.brep": None},
    "design.brep": {"design.file": None},
    "stock.kind": {"stock.file": "thick.ply"},
    "stock.brep": {"stock.kind": "solid", "stock.file": None, "stock.placement": None},
    "stock.file": {"stock.kind": "mesh"},
    "cell.bodies.0.brep": {"cell.bodies.0.file": None},
    "cell.bodies.0.file": {"cell.bodies.0.brep": None},
    **{
        f"heat.{name}": {"heat": HEAT} for name in jobs.schema()["properties"]["heat"]["properties"]
    },
    **{f"belt_machine.{key}": {"belt_machine": copy.deepcopy(BELT)} for key in BELT_KEYS},
    **{
        f"belt_machine.fork.{name}": {"belt_machine.kind": "small_wheel"}
        for name in MACHINE["fork"]["properties"]
    },
    "robot.preset": {"robot.model": {}},
    "programs.0.file": {"programs.0.poses": None},
    "programs.0.values": {"programs.0.poses": None, "programs.0.file": "pass.csv"},
    "programs.0.roll": {"programs.0.poses": None, "programs.0.file": "axes.apt"},
    "programs.0.roll_direction": {
        "programs.0.poses": None,
        "programs.0.file": "axes.apt",
        "programs.0.roll": "fixed",
    },
    **{
        f"programs.0.poses.0.{name}": {"programs.0.poses.0.qw": 0.99874922}
        for name in ("qx", "qy", "qz")
    },
    "programs.0.poses.0.qw": {"programs.0.poses.0.qx": 0.05},
    **{
        f"robot.model.joints.0.{name}": {"robot.model": DH_ROBOT}
        for name in ("a_mm", "alpha_deg", "d_mm", "theta_deg", "direction")
    },
    "law.calibration.parameters": {"law.calibration.covariance": [[1e-12]]},
    "law.calibration.covariance": {"law.calibration.parameters": ["coefficient"]},
}


def resolved(rule):
    while "$ref" in rule:
        rest = {key: value for key, value in rule.items() if key != "$ref"}
        rule = {**jobs.schema()["definitions"][rule["$ref"].split("/")[-1]], **rest}
    return rule


def leaves(rule, path=()):
    """(key, rule) of all that a job may give."""
    rule = resolved(rule)
    items = resolved(rule.get("items", {}))
    if "properties" in rule:
        for name, inner in rule["properties"].items():
            yield from leaves(inner, (*path, name))
    elif rule.get("type") == "array" and "properties" in items:
        yield from leaves(items, (*path, "0"))
    else:
        yield ".".join(path), rule


REFUSED = {  # the whole run is an error
    "belt_machine.compliance.surrogate_file",  # there is no such file
    "design.flip_faces",  # of a solid
    "stock.left_by",
    "robot.model.urdf",  # beside joints
    "robot.model.base_link",  # without a URDF
    "robot.model.tip_link",
    "robot.packages",
}


LEAVES = dict(leaves(jobs.schema()))
del LEAVES["schema"]  # there is one version
ASKED = {"Ra_max_um": 2.0, "lay": "=", "lay_direction": [1, 0, 0]}  # of the finish, by a zone
for leaf in LEAVES:
    if leaf.startswith("finish."):
        ALONG[leaf] = {"finish": FINISH}
    if leaf.startswith("inspection.zones.0.finish."):
        ALONG[leaf] = {"finish": FINISH, "inspection.zones.0.finish": ASKED}


def put(job, key, value):
    """Sets a key of a job, or takes it away; of a list, in the middle entry."""
    *way, last = key.split(".")
    for name in way:
        if name == "0":
            if not job:
                job.append({})
            job = job[min(2, len(job) - 1)]
        else:
            job = job.setdefault(name, [] if name in LISTS else {})
    if value is None:
        job.pop(last, None)
    else:
        job[last] = value


LISTS = {key.split(".")[i - 1] for key in LEAVES for i, n in enumerate(key.split(".")) if n == "0"}


def look(job, key):
    for name in key.split("."):
        if name == "0":
            job = job[min(2, len(job) - 1)] if job else None
        else:
            job = job.get(name) if job is not None else None
    return job


def others(key, rule, before, folder):
    """Values that differ from that before."""
    if key in VALUES:
        return [VALUES[key](folder)]
    if before is None:
        before = rule.get("default")
    if key == "belt_machine.kind":  # a platen's contacts take long; keys of its own follow it below
        return ["free_belt" if before in (None, "contact_wheel") else "contact_wheel"]
    if "enum" in rule:
        return [value for value in rule["enum"] if value != before]
    kind = rule["type"]
    if kind == "boolean":
        return [not before]
    if kind == "integer":
        return [(before or 0) + 1]
    if kind == "number":
        value = 1.25 * before if before else 0.37
        return [min(value, rule.get("maximum", value)) if value != before else 0.9 * value]
    if kind == "array":
        for name, value in NUMBERS.items():
            if key.endswith(name):
                return [value]
        if resolved(rule["items"])["type"] == "number" and "minItems" in rule:
            before = before or [0.0] * rule["minItems"]
            return [[before[0] - 0.03, *before[1:-1], before[-1] + 0.04]]
    raise AssertionError(f"{key} is new: say in VALUES what else it may be")


HEIGHTS = 2 + 5  # of an outcome


def outcome(job, **options):
    """All that a run gives, as bytes and text; of one that fails its error."""
    recording = core.Recording()
    try:
        job = jobs.validate(job)
        result = runs.run(job, None, recording, influence=True, shifts=True, **options)
    except InputError as error:
        return [error.code, str(error)]
    field = result.field
    arrays = [field.points, field.normals, field.rays, field.areas, field.stock_height]
    arrays += [field.height, field.height_sd, field.faces, field.flags, field.triangles]
    arrays += [field.spacing, field.depth, *field.trace.values(), *result.steps.values()]
    arrays += [*result.motions.values(), result.shifts, *(field.finish or {}).values()]
    arrays += (field.heat or {}).values()
    summary = {key: value for key, value in result.summary.items() if key != "wall_time_s"}
    told = [summary, result.events, result.verdict]
    return [
        json.dumps(told),
        recording.hdf5("{}"),
        *(np.asarray(array).tobytes() for array in arrays),
    ]


@pytest.fixture(scope="module")
def warm(folder):
    """Stages that have run both jobs, by name, and what they gave."""
    stages = kept.Kept()
    with kept.instead(stages):
        found = {name: outcome(make(folder)) for name, make in BASES.items()}
        again = {name: outcome(make(folder)) for name, make in BASES.items()}
    assert all(len(one) > 2 for one in found.values()), found
    assert found == again and set(stages.made) == set(STAGES)
    return stages, found


# What the two jobs together prepare.
STAGES = ("design", "warnings", "look", "contact", "field", "stock", "triangles", "body", "reach")
STAGES += ("collisions", "grinding")


def changed(name, key, value, folder):
    job = BASES[name](folder)
    for other, given in ALONG.get(key, {}).items():
        is_file = other.endswith(".file") and given is not None
        put(job, other, str(folder / given) if is_file else copy.deepcopy(given))
    turn = {"quaternion_wxyz": "abc_deg", "abc_deg": "quaternion_wxyz"}.get(key.split(".")[-1])
    if turn:
        put(job, key.rpartition(".")[0] + "." + turn, None)
    put(job, key, value)
    return job


def keys():
    """All keys; of each part of a job the first alone is quick."""
    seen = set()
    for key in LEAVES:
        part = key.split(".")[0]
        yield pytest.param(key, marks=[pytest.mark.slow] if part in seen else [])
        seen.add(part)


@pytest.mark.slow
@pytest.mark.parametrize("key", keys())
def test_a_changed_key_never_takes_what_was_made_of_the_old_one(key, warm, folder):
    stages, before = warm
    runs_through = 0
    for name, make in BASES.items():
        if name == SLOW and not key.startswith(FOLLOWED):
            continue
        for value in others(key, LEAVES[key], look(make(folder), key), folder):
            job = changed(name, key, value, folder)
            with kept.instead(stages):
                quick = outcome(copy.deepcopy(job))
            with kept.instead(kept.Kept()):
                whole = outcome(job)
            assert quick == whole, (name, key, value)
            runs_through += len(whole) > 2 and whole != before[name]
    assert runs_through or key in REFUSED, f"{key}: no change of it runs"


def test_forces_and_feeds_keep_all_that_is_prepared(folder):
    with kept.instead(kept.Kept()) as stages:
        outcome(robot_job(folder))
        del stages.made["grinding"]  # which is no preparation
        made = dict(stages.made)
        job = robot_job(folder)
        job["belt_machine"]["force_N"] = 25
        job["programs"][0]["poses"][2]["force_N"] = 18
        outcome(job)
        del stages.made["grinding"]
        contacts = stages.made["contact"]
        assert contacts > made["contact"]  # which depends on the force
        assert {**stages.made, "contact": 0} == {**made, "contact": 0}
        for one in job["programs"]:
            one["feed_mm_s"] = 33
        outcome(job)
        del stages.made["grinding"]
        assert stages.made["contact"] == contacts
        assert stages.made["reach"] == made["reach"] + 1  # joints turn at other speeds
        assert {**stages.made, "contact": 0, "reach": 0} == {**made, "contact": 0, "reach": 0}
    with kept.instead(kept.Kept()) as stages:  # in rounded corners, speeds decide the way
        job = mesh_job(folder)
        job["cell"]["check_collisions"] = True
        outcome(job)
        made = dict(stages.made)
        job["programs"][0]["feed_mm_s"] = 20
        outcome(job)
        assert stages.made["collisions"] > made["collisions"]
        assert stages.made["stock"] == made["stock"] == 1


def raster_job(folder, control="force"):
    """Passes of two programs over the part, on a belt that wears."""
    job = allowance_job(folder)
    job["cell"]["bodies"] = []
    job["belt_machine"]["control"] = control
    job["law"] = {"model": "local", "wear": {"model": "exponential", "scale": 500.0}}
    ys = (2, 4, 6, 8, 10)
    passes = [[pose(x, y_mm=y) for x in (3, 9, 15)[:: 1 - 2 * (y % 4 == 0)]] for y in ys]
    job["programs"] = [{"poses": sum(passes, [])}, {"poses": copy.deepcopy(sum(passes[1:3], []))}]
    return job


EDITS = {  # of the poses
    "feed": lambda poses, k: poses[k].update(feed_mm_s=27.0),
    "force": lambda poses, k: poses[k].update(force_N=13.0),
    "place": lambda poses, k: poses[k].update(x_mm=poses[k]["x_mm"] + 0.7, z_mm=0.05),
    "rapid": lambda poses, k: poses[k].update(rapid=True),
    "gone": lambda poses, k: poses.pop(k),
    "added": lambda poses, k: poses.insert(k, pose(7.0, y_mm=5)),
}
PLACES = {  # (program, its pose): whether steps before it are taken from the run before
    (0, 0): False,
    (0, 1): False,
    (0, 4): True,
    (0, 8): True,
    (0, 13): True,
    (0, 14): True,
    (1, 0): True,
    (1, 5): True,
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "control, timing", [("force", "constant_feed"), ("position", "trapezoidal")]
)
@pytest.mark.parametrize("edit", EDITS)
def test_an_edited_program_goes_on_from_where_it_is_the_same(edit, control, timing, folder):
    def made(change=lambda job: None):
        job = raster_job(folder, control)
        job["simulation"] = {"timing": timing}
        change(job)
        return job

    with kept.instead(kept.Kept()):
        before = outcome(made())
    for (program, at), goes_on in PLACES.items():
        change = lambda job: EDITS[edit](job["programs"][program]["poses"], at)
        with kept.instead(kept.Kept()) as stages:
            assert outcome(made()) == before
            quick = outcome(made(change))
            # No motion leads to a program's first pose: how it would be made changes nothing.
            idle = at == 0 and edit in ("feed", "force", "rapid")
            assert stages.hits.get("grinding", 0) == (goes_on or idle), (program, at)
            assert outcome(made()) == before  # and back
        with kept.instead(kept.Kept()):
            whole = outcome(made(change))
        assert quick == whole, (program, at)
        # A pose in the middle of a line may go, and under position control forces are not met.
        if edit in ("feed", "place") or (edit, control) == ("force", "force"):
            assert (quick[HEIGHTS] != before[HEIGHTS]) != idle, (program, at)


def half_space(job):
    job["belt_machine"]["compliance"] = {"model": "half_space"}
    job["belt_machine"]["wheel"]["profile_mm"] = [[-4.0, 0.2], [0.0, 0.0], [4.0, 0.1]]


def springy_robot(job):
    machine = job["belt_machine"]
    machine.update(control="position", robot_stiffness_N_per_mm=60.0, wheel_density_kg_m3=1100.0)


def slow_force(job):
    dynamics = {"model": "actuator", "lag_s": 0.05, "moving_mass_kg": 2.0}
    job["belt_machine"]["force_dynamics"] = {**dynamics, "damping_N_s_per_mm": 0.4}


def dense_edges(job):
    job["sampling"].update(precision_mm=0.2, edge_spacing_mm=0.5)
    job["stock"] = {"kind": "mesh", "file": str(job.pop("folder") / "stock.ply")}


def warmth(job):
    job["heat"] = copy.deepcopy(HEAT)


def finish(job):
    job["finish"] = copy.deepcopy(FINISH)


def warmth_and_finish(job):
    slow_force(job)
    warmth(job)
    finish(job)
    job["heat"]["conductivity_W_mK"] = 190.0


VARIANTS = [half_space, springy_robot, slow_force, dense_edges, warmth, finish, warmth_and_finish]


@pytest.mark.slow
@pytest.mark.parametrize("variant", VARIANTS)
def test_any_wheel_robot_and_part_go_on_from_where_the_program_is_the_same(variant, folder):
    def made(at=None):
        job = raster_job(folder)
        if variant is dense_edges:
            job["folder"] = folder
        variant(job)
        if at is not None:
            program, k = at
            job["programs"][program]["poses"][k].update(feed_mm_s=31.0, z_mm=0.06)
        return job

    with kept.instead(kept.Kept()) as stages:
        outcome(made())
        found = {at: outcome(made(at)) for at in ((0, 7), (0, 12), (1, 4))}
        assert stages.hits["grinding"] == len(found)
    for at, quick in found.items():
        with kept.instead(kept.Kept(0)):
            assert outcome(made(at)) == quick, at


HEAT_EDITS = {"conductivity_W_mK": 16.0, "heat_capacity_J_kgK": 490.0, "density_kg_m3": 7800.0}
HEAT_EDITS |= {"friction": [0.3, 0.7], "burn_temperature_C": 21.0}


@pytest.mark.slow
@pytest.mark.parametrize("key", HEAT_EDITS)
def test_another_material_or_friction_takes_no_states(key, folder):
    job = raster_job(folder)
    job["heat"] = {**HEAT, "start_temperature_C": 20.0}
    other = copy.deepcopy(job)
    other["heat"][key] = HEAT_EDITS[key]
    with kept.instead(kept.Kept()) as stages:
        before = outcome(copy.deepcopy(job))
        quick = outcome(copy.deepcopy(other))
        assert "grinding" not in stages.hits
        assert outcome(job) == before
        assert stages.hits["grinding"] == 1
    with kept.instead(kept.Kept(0)):
        assert outcome(other) == quick != before


def test_a_run_that_nothing_follows_keeps_no_states(folder):
    with kept.instead(kept.Kept()) as stages:
        outcome(raster_job(folder), resume=False)
        assert "grinding" not in stages.made and "field" in stages.made
        outcome(raster_job(folder))
        assert stages.made["grinding"] == 1
        outcome(raster_job(folder), resume=False)
        assert "grinding" not in stages.hits


def test_a_program_that_ends_sooner_leaves_another_part_to_the_next(folder):
    job = raster_job(folder)
    del job["programs"][0]["poses"][-3:]
    with kept.instead(kept.Kept()) as stages:
        outcome(raster_job(folder))
        quick = outcome(copy.deepcopy(job))
        assert stages.hits["grinding"] == 1
        assert outcome(copy.deepcopy(job)) == quick
    with kept.instead(kept.Kept(0)) as none:
        assert outcome(job) == quick and none.bytes == 0


FILES = {  # of a job, and another that takes its place under its name
    "plate.brep": ("robot", "other.brep"),
    "body.brep": ("robot", "other.brep"),
    "pass.csv": ("allowance", "deep.csv"),
    "stock.ply": ("mesh", "thick.ply"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_a_file_is_known_by_what_it_holds(name, folder):
    base, other = FILES[name]
    path, text = folder / name, (folder / name).read_bytes()
    status = os.stat(path)
    with kept.instead(kept.Kept()):
        before = outcome(BASES[base](folder))
        try:
            path.write_bytes((folder / other).read_bytes())
            os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
            quick = outcome(BASES[base](folder))
            with kept.instead(kept.Kept()):
                whole = outcome(BASES[base](folder))
        finally:
            path.write_bytes(text)
        assert quick == whole != before
        assert outcome(BASES[base](folder)) == before


def test_the_comparison_sees_a_stage_of_other_inputs(folder, monkeypatch):
    """Were a stage known by its name alone, the changed run would differ from the whole one."""
    monkeypatch.setattr(kept, "digest", lambda *_: "")
    with kept.instead(kept.Kept()):
        outcome(allowance_job(folder))
        job = allowance_job(folder)
        job["sampling"]["depth_mm"] = 1.5
        stale = outcome(copy.deepcopy(job))
        monkeypatch.undo()
    with kept.instead(kept.Kept()):
        assert stale != outcome(job)


def test_a_result_is_the_caller_s_own(folder):
    with kept.instead(kept.Kept()):
        first = runs.run(jobs.validate(mesh_job(folder)))
        before = np.array(first.field.stock_height)
        first.field.set_height(np.full(first.field.size, -1.0))
        first.events.append({})
        again = runs.run(jobs.validate(mesh_job(folder)))
    assert (again.field.stock_height == before).all() and again.field.height.max() > 0
    assert {} not in again.events


def test_what_was_used_longest_ago_goes_first():
    stages = kept.Kept(100)
    made = []

    def value(name, size=25):
        return stages.get("one", lambda: name, lambda: made.append(name) or name, lambda _: size)

    for name in "abcdabcd":
        assert value(name) == name
    assert made == ["a", "b", "c", "d"] and stages.bytes == 100
    value("a")
    value("e")  # drops b
    for name in "acde":
        value(name)
    assert made[4:] == ["e"]
    value("b")  # drops a
    for name in "cdeb":
        value(name)
    assert made[4:] == ["e", "b"] and stages.bytes == 100
    value("a")
    assert made[4:] == ["e", "b", "a"] and stages.bytes == 100
    value("large", 101)
    value("large", 101)
    assert made[-2:] == ["large", "large"] and stages.bytes == 100
    stages.forget()
    assert stages.bytes == 0 and value("a") == "a" and made[-1] == "a"


def test_what_changes_while_it_is_made_and_what_fails_is_not_kept(tmp_path):
    path = tmp_path / "file"
    path.write_text("old")
    stages = kept.Kept()

    def read():
        text = path.read_text()
        path.write_text("new")
        return text

    assert stages.get("file", path.read_bytes, read, len) == "old"
    assert stages.get("file", path.read_bytes, path.read_text, len) == "new"
    path.write_text("old")
    assert stages.get("file", path.read_bytes, path.read_text, len) == "old"
    for _ in range(2):
        with pytest.raises(ZeroDivisionError):
            stages.get("none", lambda: 1, lambda: 1 / 0, lambda _: 1)


def test_what_is_kept_is_copied_for_who_changes_it_and_what_is_not_kept_is_not():
    for most, copies in ((100, 2), (10, 0)):
        stages, copied = kept.Kept(most), []
        for _ in range(2):
            found = stages.get(
                "one", lambda: 1, lambda: [7], lambda _: 5, lambda one: copied.append(1) or [*one]
            )
            assert found == [7]
            found.append(8)
        assert len(copied) == copies


def test_the_environment_limits_what_is_kept(monkeypatch):
    monkeypatch.setenv(kept.LIMIT, "3")
    assert kept.Kept().most == 3e6
    monkeypatch.setenv(kept.LIMIT, "0")
    stages = kept.Kept()
    assert stages.get("one", lambda: 1, lambda: "a", lambda _: 1) == "a" and stages.bytes == 0
    monkeypatch.setenv(kept.LIMIT, "much")
    assert 0 < kept.Kept().most <= kept.MOST


def test_digests_tell_values_apart():
    values = [1, 1.5, "1", [1], [[1]], {"a": 1}, None, True, b"1", np.arange(4), np.arange(4.0)]
    values += [np.arange(4).reshape(2, 2), "", [], {}, [1, 2], ["1", "2"], range(2), range(3), 0.0]
    assert len({kept.digest(value) for value in values}) == len(values)
    assert kept.digest(np.arange(8)[::2]) == kept.digest(np.array([0, 2, 4, 6]))
    with pytest.raises(TypeError):
        kept.digest(object())


def test_threads_share_what_is_kept(folder):
    found = []
    with kept.instead(kept.Kept()):
        threads = [
            threading.Thread(target=lambda: found.append(outcome(mesh_job(folder))))
            for _ in range(3)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert len(found) == 3 and found[0] == found[1] == found[2]


def test_what_is_too_large_is_made_again():
    stages = kept.Kept(1000)
    for taken, made in ((200, 1), (300, 2)):
        values = [stages.get("stage", lambda: [taken], list, lambda _: taken) for _ in range(2)]
        assert (values[0] is values[1]) == (made == 1)
