"""What a recording costs, and how fast it answers: a plate of a million samples, 10,000 steps.

    PYTHONPATH=Mod/BeltGrinding:build/release/python python3 tests/benchmark/recording_bench.py
"""

import time

import numpy as np

from beltgrinding.engine import core
from beltgrinding.job import engine_input, load

SIDE, SPACING = 500.0, 0.5  # mm
LANES, TRAVEL = 20, 1.0  # passes over the plate; mm a step
JUMPS = 100
JOB = {
    "design": {"file": "plate"},
    "belt_machine": {
        "wheel": {"width_mm": 40.0},
        "compliance": {"model": "elastic_foundation"},
        "force_N": 60.0,
    },
    "law": {"coefficient_mm2_per_N": 1e-4},
    "simulation": {"max_travel_mm": TRAVEL},
    "programs": [{"poses": []}],
}


def plate():
    corners = np.array([[0, 0, 0], [SIDE, 0, 0], [SIDE, SIDE, 0], [0, SIDE, 0]], np.float32)
    mesh = core.TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    field, _ = core.sample_faces(core.shape_from_mesh(mesh), [0], SPACING)
    core.apply_allowance(field, 0.5)
    return field


def lanes():
    frames = []
    for k in range(LANES):
        y = SIDE * (k + 0.5) / LANES
        for x in (5.0, SIDE - 5.0)[:: 1 if k % 2 == 0 else -1]:
            frame = np.diag([1.0, -1.0, -1.0, 1.0])
            frame[:3, 3] = x, y, 0.5
            frames.append(frame)
    n = len(frames)
    return core.ToolPath(
        np.array(frames), np.full(n, 50.0), np.full(n, -1.0), np.zeros(n, bool), np.zeros(n, int)
    )


def grind(recording):
    field = plate()
    begin = time.perf_counter()
    core.simulate(
        field,
        lanes(),
        engine_input.of(load.validate(JOB)),
        recording=recording,
    )
    return field, time.perf_counter() - begin


def main():
    _, plain = grind(None)
    recording = core.Recording()
    field, recorded = grind(recording)
    print(f"{field.size} samples, {recording.steps()[-1]} steps: {plain:.1f} s, ", end="")
    print(f"recorded {recorded:.1f} s")
    print(
        f"{recording.changes} changes, {recording.bytes / 1e6:.0f} MB, "
        f"{recording.bytes / recording.steps()[-1]:.0f} bytes a step, "
        f"{recording.bytes / max(recording.changes, 1):.2f} bytes a change, "
        f"{recording.steps_per_frame} steps a frame, {recording.key_frames} key frames"
    )
    at, random, advance, whole = 0, np.random.default_rng(1), [], []
    for _ in range(JUMPS):
        to = int(random.integers(recording.last + 1))
        begin = time.perf_counter()
        recording.advance(at, to)
        advance.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        recording.heights_at(to)
        whole.append(time.perf_counter() - begin)
        at = to
    for name, times in (("advance", advance), ("heights_at", whole)):
        print(f"{name}: mean {1e3 * np.mean(times):.1f} ms, largest {1e3 * np.max(times):.1f} ms")


main()
