"""Programs for the whole robot on real parts of shared/data/cad, looked at by another chain: KDL's kinematics, and FCL at single places.

tools/bench robot [NAME]; `python robot_program_bench.py [NAME] [--only ROBOT] [--json FILE]` does the same. Eight parts, three robots,
the tool in the robot's hand and the part in it. Coarse passes on the face that tools/bench grind has; the robot stands
where `reach --place` puts it, and the third has an external axis: with the tool in hand a positioner under the part,
with the part in hand a track. Joints and places are taken at every 0.1 mm, 0.1 degrees of what the program does; the
planner looks at 1 mm. Columns:

passes   in the program, and how often one is cut
poses    of the program
s        to place the robot, to plan
margin   of the joints from their limits, degrees, the least
clear    mm that the links keep
kdl      mm and degrees between a pose and KDL's forward kinematics of its joints, the most
places   that were looked at
met      of them, where two bodies cross
beyond   of them, where a joint is beyond its limit
speed    of the joints on path motions, % of their greatest, the most
"""

import argparse
import json
import math
import time
from pathlib import Path

import numpy as np
import PyKDL

from beltgrinding.base import frames, records
from beltgrinding.cell import placing
from beltgrinding.engine import InputError, core
from beltgrinding.geometry.body_names import FOOT
from beltgrinding.job import load as jobs, poses, robot_time, workpiece
from beltgrinding.job.typed import typed
from beltgrinding.presets import robot as robots
from beltgrinding.raster import raster_path
from beltgrinding.robot_program import scenes, write as writing
from beltgrinding.cell import tool_path as tool_paths
from grind_bench import PARTS, SETS, UNITS

NAMES = (
    "ball_valve_lever", "blade_airfoil_periodic", "blade_marine_upper", "crank_arm",
    "hammer_claw", "housing_with_spout", "propeller_3blade", "pump_cover",
)  # fmt: skip
ROBOTS = {
    "kuka_kr16_2": [[0, -90, 90, 0, 60, 0], [0, -100, 120, 0, 70, 0]],
    "ur10e": [[0, -90, -90, -90, 90, 0], [0, -110, -110, -50, 90, 0]],
    "abb_irb4600_60_205": [[0, 0, 0, 0, 60, 0], [0, -30, 30, 0, 60, 0]],
}
WITH_AXIS = "abb_irb4600_60_205"
PLANS = 2  # with different homes, where the first has a problem
TURNS = (0, 60, -60, 100, -100, 150, -150, 30, -30)  # degrees of joint 1, that are tried for a home
WHEEL = {"radius_mm": 25, "width_mm": 20, "crown_radius_mm": 80}
TOOL = 180.0  # mm from flange to contact, or from it to the part's middle less its own size
PASSES = 6  # on the face, about
STEP, ANGLE = 0.1, math.radians(0.1)  # mm, rad between places
MOST = 30_000  # places of a program, that are looked at; its motions are shared out
AT_FLANGE = 5  # links from this one on are not looked at against what is at the flange
HOLDING = ("tool_in_hand", "part_in_hand")
HEAD = ("passes", "poses", "s", "margin", "clear", "kdl", "places", "met", "beyond", "speed")


def job_of(name, holding):
    """A job with coarse passes on the part's face, without its robot."""
    file = next(one for one in PARTS.iterdir() if one.stem == name)
    design = {"file": str(file), "faces": dict(SETS)[name], "unit_mm": UNITS.get(name, 1.0)}
    shape = workpiece.read_design(design)
    area = sum(shape.face_area(face - 1) for face in design["faces"])
    low, high = map(np.array, shape.extents())
    mesh = core.triangulate(shape, max(0.1, 1e-3 * float(np.linalg.norm(high - low))))
    given = {
        "design": design,
        "sampling": {"spacing_mm": max(0.3, math.sqrt(area / 4000))},
        "belt_machine": {"wheel": WHEEL, "force_N": 30},
        "programs": [{"poses": []}],
        "cell": {"holding": holding, "wheel_inset_mm": 3.0, "bodies": []},
    }
    bare = jobs.validate({**given, "cell": {"check_collisions": False}})
    field = workpiece.make_field(bare, shape, [], None)
    outward = np.asarray(field.normals, dtype=float).mean(axis=0)
    if holding == "part_in_hand":
        given["cell"] |= held(mesh, outward / np.linalg.norm(outward))
    job = jobs.validate(given)
    settings = {"along": "v", "step_over_mm": max(2.0, math.sqrt(area) / PASSES), "feed_mm_s": 30}
    laid = raster_path.raster(job, raster_path.validate(settings))
    return jobs.validate({**given, "programs": [{"poses": poses.list_poses(laid)}]})


def held(mesh, outward):
    """cell keys of a part in the hand: what is ground looks away from the flange, and down at the wheel."""
    points = np.asarray(mesh.vertices, dtype=float)
    x = np.cross(outward, np.eye(3)[np.argmin(np.abs(outward))])
    x /= np.linalg.norm(x)
    turn = np.stack([x, np.cross(outward, x), outward])  # rows: tool from work
    turned = points @ turn.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    at = np.eye(4)
    at[:3, :3] = turn
    at[:3, 3] = -0.5 * (low + high)
    at[2, 3] = -low[2]  # the part begins where the tool frame is
    return {"tcp_from_work": told(at), "base_from_contact": {"position_mm": [0, 0, 0]}}


def told(frame):
    return {"position_mm": frame[:3, 3].tolist(), "abc_deg": list(frames.to_abc(frame))}


def robot_of(name, holding, job):
    """A job's robot, still without its place."""
    axes = []
    if name == WITH_AXIS and holding == "tool_in_hand":
        path = tool_paths.tool_path(job, 0, [])
        middle = tool_paths.motions(path)["frames"][:, :3, 3].mean(axis=0)
        axes = [{"kind": "rotary", "carries": "part", "origin_mm": middle.tolist(), "lower": -180, "upper": 180}]  # fmt: skip
    elif name == WITH_AXIS:
        axes = [{"kind": "linear", "carries": "robot", "axis": [0, 1, 0], "lower": -600, "upper": 600}]  # fmt: skip
    return {"preset": name, "flange_from_tcp": {"position_mm": [0, 0, TOOL]}}, axes


def placed(plain, robot, axes):
    """The job with the robot where it reaches best, its external axes after it."""
    job = jobs.validate({**plain, "robot": robot})
    search = placing.Search(job)
    place, _ = search.run()
    robot = {**robot, **search.made(place.values)}
    if axes:
        job = jobs.validate({**plain, "robot": {**robot, "external_axes": axes}})
        search = placing.Search(job)
        place, _ = search.run()
        robot = {**robot, **search.made(place.values)}
    return robot


def planned(plain, robot, homes):
    """(job, its Whole) with the first home that no body is in."""
    last, plans = None, 0
    for home in homes:
        for turn in TURNS:
            program = {"home_joints_deg": [home[0] + turn, *home[1:]], "order": "least_way"}
            job = jobs.validate({**plain, "robot": {**robot, "program": program}})
            try:
                whole = writing.plan_job(job)
            except InputError as error:
                if error.fact.code not in ("robot_program.place_collides", "robot_program.place_beyond", "posture.home"):  # fmt: skip
                    raise
                last = error
                continue
            plans += 1
            if not whole.problems or plans == PLANS:
                return job, whole
            last = whole
    if isinstance(last, InputError):
        raise last
    return job, last


class Chain:
    """KDL's chain of a robot's model, and the frames of its links that a body at zero angles goes with."""

    def __init__(self, robot):
        model = robots.model_of(robot)
        self.chain, self.zero = PyKDL.Chain(), []
        for joint in _urdf_rows(model):
            turn = PyKDL.Rotation(*joint[:3, :3].ravel().tolist())
            at = PyKDL.Frame(turn, PyKDL.Vector(*joint[:3, 3].tolist()))
            self.chain.addSegment(PyKDL.Segment(PyKDL.Joint(PyKDL.Joint.Fixed), at))
            self.chain.addSegment(PyKDL.Segment(PyKDL.Joint(PyKDL.Joint.RotZ), PyKDL.Frame()))
        self.solver = PyKDL.ChainFkSolverPos_recursive(self.chain)
        self.flange = robots.arm_of(robot).forward(np.zeros(6))
        self.start = [self.at(np.zeros(6), k) for k in range(7)]

    def at(self, q, link):
        angles, found = PyKDL.JntArray(6), PyKDL.Frame()
        for k in range(6):
            angles[k] = float(q[k])
        self.solver.JntToCart(angles, found, 2 * link)
        frame = np.eye(4)
        frame[:3, :3] = [[found.M[i, k] for k in range(3)] for i in range(3)]
        frame[:3, 3] = list(found.p)
        return frame

    def link(self, q, link):
        """robot_from_link, an identity at zero angles."""
        return self.at(q, link) @ np.linalg.inv(self.start[link])


def _urdf_rows(model):
    """parent_from_joint of each joint so that it turns about z."""
    rows = []
    rest = np.eye(4)
    for joint in model["joints"]:
        if model["convention"] == "urdf":
            roll, pitch, yaw = joint["rpy_deg"]
            at = rest @ frames.from_abc(joint["origin_mm"], (yaw, pitch, roll))
            axis = np.array(joint["axis"], dtype=float)
            axis /= np.linalg.norm(axis)
            x = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
            x /= np.linalg.norm(x)
            to_z = np.eye(4)
            to_z[:3, :3] = np.stack([x, np.cross(axis, x), axis], axis=1)
            rows.append(at @ to_z)
            rest = np.linalg.inv(to_z)
        else:
            alpha = frames.from_abc([joint["a_mm"], 0, 0], [0, 0, joint["alpha_deg"]])
            up = frames.from_abc([0, 0, joint["d_mm"]], [0, 0, 0])
            offset = frames.from_abc([0, 0, 0], [joint["theta_deg"], 0, 0])
            modified = model["convention"] == "modified_dh"
            flip = frames.from_abc([0, 0, 0], [0, 0, 180 if joint["direction"] < 0 else 0])
            rows.append(rest @ (alpha if modified else np.eye(4)) @ offset @ flip)
            rest = flip @ up @ (np.eye(4) if modified else alpha)
    return rows


def walked(job, whole):
    """(joints (n, 6) rad, moves' numbers (n,), seconds of the way of each (n,)) at every STEP, ANGLE of a program."""
    robot = records.plain(job.robot)
    arm = robots.arm_of(robot)
    base, tool = robots.robot_frame(robot, robots.BASE), robots.robot_frame(
        robot, "flange_from_tcp"
    )
    turning = math.radians(robot_time.limits(job).rotation_speed_deg_s)
    ways, at, frame = [], None, None
    for number, move in enumerate(whole.moves):
        q = np.radians(move.joints_deg)
        if at is not None and move.kind == "PTP":
            count = max(1, math.ceil(np.abs(q - at).max() / ANGLE))
            ways.append((number, count, at, q, None, None, 0.0))
        elif at is not None:
            way = np.linalg.norm(move.frame[:3, 3] - frame[:3, 3])
            turn = np.linalg.norm(frames.rotation_vectors((frame[:3, :3].T @ move.frame[:3, :3])[None]))  # fmt: skip
            count = max(1, math.ceil(way / STEP), math.ceil(turn / ANGLE))
            ways.append((number, count, at, q, frame, move.frame, max(way / max(move.feed, 1e-9), turn / turning)))  # fmt: skip
        at, frame = q, move.frame
    few = max(1.0, sum(one[1] for one in ways) / MOST)
    rows = []
    for number, count, at, q, begin, end, seconds in ways:
        count = max(1, math.ceil(count / few)) if begin is None else count
        shares = np.linspace(0.0, 1.0, count + 1)[1:]
        if begin is None:
            rows += [(at + s * (q - at), number, 0.0) for s in shares]
            continue
        now = at
        for s in shares:
            target = np.linalg.inv(base) @ between(begin, end, s) @ np.linalg.inv(tool)
            found = arm.inverse(target, now)
            now = found[np.argmin(np.abs(found - now).max(axis=1))] if len(found) else now * np.nan
            rows.append((now, number, seconds / count))
        if not np.abs(now - q).max() < 1e-5:
            raise AssertionError(f"motion {number} ends elsewhere than planned")
    return tuple(np.array(one) for one in zip(*rows))


def between(begin, end, share):
    found = begin.copy()
    vector = frames.rotation_vectors((begin[:3, :3].T @ end[:3, :3])[None])[0]
    angle = float(np.linalg.norm(vector))
    if angle > 1e-12:
        axis = vector / angle
        cross = np.cross(np.eye(3), axis)
        a = share * angle
        turn = np.eye(3) + math.sin(a) * cross + (1 - math.cos(a)) * cross @ cross
        found[:3, :3] = begin[:3, :3] @ turn
    found[:3, 3] += share * (end[:3, 3] - begin[:3, 3])
    return found


def crossings(job, chain, joints, near):
    """How many of the places have two bodies that cross: every pair that can meet, by FCL on KDL's frames."""
    robot = records.plain(job.robot)
    base, tool = robots.robot_frame(robot, robots.BASE), robots.robot_frame(
        robot, "flange_from_tcp"
    )
    cell = job.cell
    in_hand = cell.holding == "tool_in_hand"
    work = workpiece.frame_of(cell.base_from_work if in_hand else cell.tcp_from_work, "cell")
    contact = workpiece.frame_of(
        cell.tcp_from_contact if in_hand else cell.base_from_contact, "cell"
    )
    offset = {"tool": np.eye(4), "wheel": contact, "part": work, "base": np.eye(4)}
    at_flange = {"tool", "wheel"} if in_hand else {"tool", "part"}
    meshes = [core.CollisionMesh(body["mesh"]) for body in near]
    flange = [base @ chain.link(q, 6) @ chain.flange @ tool for q in joints]
    met = np.zeros(len(joints), dtype=bool)
    places = {}
    for k, body in enumerate(near):
        if body["frame"] == "link":
            places[k] = np.stack([base @ chain.link(q, body["link"]) for q in joints])
        elif body["frame"] in at_flange:
            places[k] = np.stack([one @ offset[body["frame"]] for one in flange])
    for k, frames_of in places.items():
        others = []
        for j, other in enumerate(near):
            if j == k or (near[k]["name"] == FOOT and other["frame"] == "base"):
                continue
            if j not in places:
                others.append((j, frames_of, offset[other["frame"]]))
            elif near[k]["frame"] == "link" and near[k]["link"] < AT_FLANGE and other["frame"] != "link":  # fmt: skip
                others.append((j, np.linalg.inv(places[j]) @ frames_of, np.eye(4)))
        for j, relative, at in others:
            relative = np.linalg.inv(at) @ relative
            margin = near[k].get("margin", 0.0) + near[j].get("margin", 0.0)
            met |= core.first_met([meshes[k]], [(meshes[j], margin)], relative) >= 0
    return int(met.sum())


def measure(plain, name, holding):
    """The figures of HEAD; without those of the proof where the program has problems."""
    start = time.perf_counter()
    robot, axes = robot_of(name, holding, plain)
    robot = placed(plain, robot, axes)
    middle = time.perf_counter()
    job, whole = planned(plain, robot, ROBOTS[name])
    figures = whole.figures
    found = {
        "problems": [str(one) for one in whole.problems],
        "robot": robot,
        "s": (middle - start, time.perf_counter() - middle),
        "passes": f"{figures['passes']}, {figures['cuts']}",
        "poses": figures["motions"],
        "margin": figures["least_limit_margin_deg"],
        "clear": figures["link_clearance_mm"],
    }
    return found if whole.problems else {**found, **proved(typed(job), whole)}


def proved(job, whole):
    """What KDL and FCL find of a planned program of a job: kdl, places, met, beyond, speed."""
    robot = records.plain(job.robot)
    chain, arm = Chain(robot), robots.arm_of(robot)
    tool, base = (robots.robot_frame(robot, key) for key in ("flange_from_tcp", robots.BASE))
    apart = 0.0
    for move in whole.moves:
        if move.kind == "LIN":
            pose = base @ chain.link(np.radians(move.joints_deg), 6) @ chain.flange @ tool
            apart = max(apart, float(np.abs(pose - move.frame).max()))
    joints, numbers, times = walked(job, whole)
    path = tool_paths.tool_path(job, 0, [])
    of = scenes.of_job(job, workpiece.read_design(job.design), path, [], None)
    linear = np.array([whole.moves[n].kind == "LIN" for n in numbers])
    met = crossings(job, chain, joints[linear], of.bodies_of_passes)
    met += crossings(job, chain, joints[~linear], of.bodies)
    beyond = ((joints < arm.lower - 1e-9) | (joints > arm.upper + 1e-9)).any(axis=1).sum()
    turned = np.abs(np.diff(joints, axis=0, prepend=joints[:1]))
    known = (times > 0) & (np.diff(numbers, prepend=-1) == 0)
    speed = (turned[known] / times[known, None] / arm.max_speed).max() if known.any() else 0.0
    return {
        "kdl": apart,
        "places": len(joints),
        "met": met,
        "beyond": int(beyond),
        "speed": 100.0 * float(speed),
    }


def shown(one, key):
    value = one[key]
    if key == "s":
        return " + ".join(f"{v:.1f}" for v in value)
    if key == "kdl":
        return f"{value:.1e}"
    return f"{value:.1f}" if isinstance(value, float) else str(value)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name", nargs="?", default="", help="only parts whose name has this in it")
    parser.add_argument("--only", default="", help="only robots whose name has this in it")
    parser.add_argument("--json", help="file for the figures")
    arguments = parser.parse_args()
    if not PARTS.is_dir():
        print(f"robot: no data at {PARTS}")
        return
    print(
        f"| part | robot | holds | {' | '.join(HEAD)} |\n|{' --- |' * (len(HEAD) + 3)}", flush=True
    )
    rows = []
    for part in (one for one in NAMES if arguments.name in one):
        for holding in HOLDING:
            plain = job_of(part, holding)
            for robot in (one for one in ROBOTS if arguments.only in one):
                try:
                    one = measure(plain, robot, holding)
                except InputError as error:
                    one = {"problems": [str(error)]}
                rows.append({"part": part, "robot": robot, "holding": holding, **one})
                cells = (
                    [shown(one, key) for key in HEAD] if "met" in one else [*one["problems"][:1]]
                )
                print(f"| {part} | {robot} | {holding[:4]} | {' | '.join(cells)} |", flush=True)
                if arguments.json:
                    Path(arguments.json).write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
