"""The simulation of written programs against a controller of our own (``controller_model``), which executes their text."""

import math

import numpy as np
import pytest
from controller_model import Run, runs
from controller_text import blocks_of

from beltgrinding.base import frames
from beltgrinding.cell.tool_path import tool_path
from beltgrinding.job import load as jobs, robot_time
from beltgrinding.programs.program import Motion
from beltgrinding.programs.writers.writer import write_program

PLACE, FEED, FORCE = 0.02, 0.02, 2.0  # mm, of the feed, N
SHORT = 1.0  # mm: a feed is compared over so long a way at least
CONTROLLERS = {
    ".src": ("krc4", "krc2"),
    ".mod": ("irc5",),
    ".script": ("ur_e",),
    ".ls": ("r30ib",),
    ".jbi": ("yrc1000",),
}
CASES = [(suffix, one) for suffix, names in CONTROLLERS.items() for one in names]
# N of the number in the force device's statement, scale_per_N 0.01.
SCALE = 0.01
NAME = {".mod": {"name": "aoForce"}}


def device(suffix):
    return {
        "kind": "analog",
        "output": 1,
        "scale_per_N": SCALE,
        "greatest_N": 90,
        **NAME.get(suffix, {}),
    }


def newton(value):
    return value / SCALE


def pose(x, y, z, a=0.0, b=0.0, c=0.0):
    return frames.from_abc((x, y, z), (a, b, c))


def passes(places, feeds, force=lambda k: 30.0):
    """Motions: by PTP to the first place, then straight; ``feeds`` a value a place."""
    return [
        Motion("LIN" if k else "PTP", at, 0, "", feed if k else None, force(k))
        for k, (at, feed) in enumerate(zip(places, feeds))
    ]


def over_a_cylinder(step=2.5):
    """A pass round a cylinder of 60 mm, the tool turning with it, feeds and forces that go up and down."""
    angles = np.arange(-40.0, 40.01, math.degrees(step / 60.0))
    at = [
        pose(60 * math.sin(t), 5.0, 60 * math.cos(t), 0, math.degrees(t))
        for t in np.radians(angles)
    ]
    feeds = [round(35.0 + 25.0 * math.sin(0.4 * k), 1) for k in range(len(at))]
    return passes(at, feeds, lambda k: round(30.0 + 15.0 * math.sin(0.3 * k), 1))


def zigzag(feed):
    """Passes of 30 mm with 6 mm between them: corners of 90 degrees, at which short and long blocks meet."""
    at = [(0, 0), (15, 0), (30, 0), (30, 6), (20, 6), (0, 6), (0, 12), (12, 13), (30, 12)]
    return passes([pose(x, y, 0) for x, y in at], [feed] * len(at))


def short_blocks():
    """Blocks of 0.6 to 3 mm on a wave, at the feeds that three cycles of 12 ms let them have."""
    x, at, feeds = 0.0, [pose(0, 0, 0)], [10.0]
    for k in range(50):
        step = 0.6 + 2.4 * abs(math.sin(0.21 * k))
        x += step
        at.append(pose(x, 0, 2.0 * math.sin(x / 25.0), 0, 8.0 * math.cos(x / 25.0)))
        feeds.append(round(min(60.0, step / 0.036), 1))
    return passes(at, feeds, lambda k: 20.0 + 0.5 * k)


def turning():
    """A tool that turns by 50 degrees over 8 mm between straight pieces."""
    turns = [0, 0, 0, 10, 25, 40, 50, 50, 50]
    ways = [0, 20, 30, 32, 34, 36, 38, 48, 70]
    return passes([pose(x, 0, 0, a) for x, a in zip(ways, turns)], [60.0] * len(ways))


PROGRAMS = {
    "cylinder": over_a_cylinder,
    "zigzag": lambda: zigzag(50.0),
    "fast zigzag": lambda: zigzag(120.0),
    "short blocks": short_blocks,
    "turning": turning,
}


def written(folder, suffix, controller, motions):
    """(job of the written file under its controller's time, blocks of its text)."""
    file = folder / f"p{suffix}"
    given = {"design": {"file": "part.step"}, "robot": {"controller": controller}}
    given["belt_machine"] = {"force_device": device(suffix)}
    options, _ = robot_time.written(given, file)
    number = "1" if suffix in (".ls", ".jbi", ".src") else pose(0, 0, 0)
    frames_of = {"bases": number, "tools": number}
    write_program(file, None, motions, force_device=device(suffix), **options, **frames_of)
    job = robot_time.timed(jobs.validate({**given, "programs": [{"file": str(file)}]}, folder))
    found = robot_time.limits(job)
    limits = {
        "acceleration": found.path_acceleration_mm_s2,
        "angular": found.angular_acceleration_deg_s2,
        "turning": found.rotation_speed_deg_s,
        "zone": found.default_zone_mm,
    }
    return job, blocks_of(file, newton, limits), found


def compared(job, blocks, limits):
    """{what: worst difference} of what the controller does and what is simulated."""
    path = tool_path(job, 0, [])
    ends = np.asarray(path.times())
    worst = {"place": 0.0, "feed": 0.0, "force": 0.0, "time": 0.0}
    for first, last in runs(blocks):
        run = Run(blocks, first, last, limits.cycle_s, limits.look_ahead)
        begin, end = ends[first - 1], ends[last]
        times = np.linspace(begin, end, 150 * (last - first + 1) + 1)
        mine = np.array([path.frame_at(t)[0][:3, 3] for t in times])
        way = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(mine, axis=0), axis=1)))
        samples, low, seen = run.samples(), 0, []
        for one in samples:
            near, at = nearest(mine, way, one.place, low)
            low = int(np.searchsorted(way, at, side="right")) - 1
            worst["place"] = max(worst["place"], near)
            seen.append(at)
        its, seen = np.array([one.time for one in samples]), np.array(seen)
        ours = np.interp(seen, way, times - begin)
        worst["time"] = max(worst["time"], abs(run.times[-1] - (end - begin)) / (end - begin))
        k = 0
        for j in range(1, len(samples)):
            if seen[j] - seen[k] < SHORT:
                continue
            a, b = its[j] - its[k], ours[j] - ours[k]
            worst["feed"] = max(worst["feed"], abs(a / b - 1.0))
            k = j
        number = np.minimum(np.searchsorted(ends, begin + ours, side="left"), last)
        forces = forces_of(job)
        for one, n in zip(samples, number):
            beside = forces[max(first, one.block - 1) : min(last, one.block + 1) + 1]
            off = abs(one.force - forces[n])
            worst["force"] = max(
                worst["force"], off if n == one.block else min(off, abs(beside - one.force).min())
            )
    return worst


def forces_of(job):
    from beltgrinding.job import poses
    from beltgrinding.programs.force_device import of_job

    return poses.program_arrays(job["programs"][0], "p", [], force_device=of_job(job))["forces"]


def nearest(points, way, place, low):
    """(mm from ``place`` to the way through ``points``, where along it), at ``low`` or behind it."""
    high = min(len(points) - 1, low + 450)
    a, b = points[low:high], points[low + 1 : high + 1]
    d = b - a
    length = np.maximum((d * d).sum(axis=1), 1e-18)
    t = np.clip(((place - a) * d).sum(axis=1) / length, 0.0, 1.0)
    off = np.linalg.norm(place - a - t[:, None] * d, axis=1)
    best = int(np.argmin(off))
    return float(off[best]), float(way[low + best] + t[best] * math.sqrt(length[best]))


@pytest.mark.parametrize("suffix, controller", CASES)
@pytest.mark.parametrize("name", PROGRAMS)
def test_the_simulation_does_what_a_controller_does(tmp_path, suffix, controller, name):
    job, blocks, limits = written(tmp_path, suffix, controller, PROGRAMS[name]())
    worst = compared(job, blocks, limits)
    assert worst["place"] <= PLACE and worst["feed"] <= FEED and worst["force"] <= FORCE, worst
