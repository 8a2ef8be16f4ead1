"""The planner's solver on a problem of optics: how long an ion beam should dwell where, so that a mirror gets flat.

tools/bench dwell; `python dwell_bench.py [--step N] [--json FILE]` does the same. The map is that of RIFTA (Wang et
al., Sci. Rep. 10, 8135, 2020): 81 x 580 pixels of 0.3615 mm, of which its script flattens 43 x 527; the beam removes
10 nm/s at its middle, a Gaussian of 1 mm, cut at 5 mm. Dwell is planned on every N-th pixel, of the aperture and half a
beam around, as RIFTA's is on every one; the piston is free. Printed: residual RMS, nm; the sum of all dwell, s; seconds
and iterations; beside what RIFTA reaches, and the plain way: least squares, what comes out below zero cut off.
"""

import argparse
import json
import os
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]

from beltgrinding.engine import core

DATA = (
    Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
    / "data"
    / "dwell"
    / "sim_surf_with_slopes.mat"
)
PIXEL, REACH, SIGMA, RATE = 0.3615, 5.0, 1.0, 10.0  # mm, mm, mm, nm/s
ROWS, COLUMNS = slice(19, 62), slice(31, 558)
AROUND = 14  # pixels around the aperture, half a beam
MOST = 200.0  # s at a place
RIFTA = {"rms_nm": 0.0938, "dwell_s": 62_818.0}  # on this map, as its own code gives it
TIME_COST = 1e-8  # nm2 a second: of all that flatten as well, the shortest


def surface():
    """(43, 527) nm above its mean."""
    import scipy.io

    heights = 1e9 * scipy.io.loadmat(DATA)["Zf"][ROWS, COLUMNS]
    return heights - heights.mean()


def columns(shape, step):
    """(first, sample, depth): what a second of dwell at every place removes where, nm, place by place."""
    rows, width = shape
    first, samples, depths, reach = [0], [], [], int(REACH / PIXEL)
    for y in range(-AROUND, rows + AROUND, step):
        for x in range(-AROUND, width + AROUND, step):
            j, i = np.mgrid[
                max(0, y - reach) : min(rows, y + reach + 1),
                max(0, x - reach) : min(width, x + reach + 1),
            ]
            squares = ((j - y) ** 2 + (i - x) ** 2) * PIXEL**2
            under = squares <= REACH**2
            samples.append((j * width + i)[under])
            depths.append(RATE * np.exp(-0.5 * squares[under] / SIGMA**2))
            first.append(first[-1] + int(under.sum()))
    return np.array(first), np.concatenate(samples), np.concatenate(depths)


def solve(heights, step):
    """dict(dwell (places,) s, residual (samples,) nm, rms_nm, dwell_s, kkt, iterations, seconds)."""
    first, sample, depth = columns(heights.shape, step)
    count, places = heights.size, len(first) - 1
    # The last motion lifts all alike: the piston.
    influence = core.Influence(
        np.append(first, first[-1] + count).astype(np.uint64),
        np.append(sample, np.arange(count)).astype(np.uint32),
        np.append(depth, np.full(count, -1.0)).astype(np.float32),
    )
    once = np.bincount(sample, depth.astype(np.float32), count) - 1.0
    upper, cost = np.full(places + 1, MOST), np.full(places + 1, TIME_COST)
    upper[-1], cost[-1] = 1e4, 0.0
    begun = time.perf_counter()
    found = core.plan_dwell(
        influence,
        heights.ravel() - once,
        np.full(count, 1e4),  # no band: plain squares
        np.ones(count),
        np.zeros(places + 1),
        upper,
        np.zeros(places + 1),
        {"inner_share": 1.0, "inner_cost": 1.0, "smoothing": 0.0, "reweightings": 0},
        None,
        cost,
    )
    seconds = time.perf_counter() - begun
    dwell = np.asarray(found["factor"])[:-1]
    left = heights.ravel() - np.bincount(sample, depth * dwell[_owner(first)], count)
    return {
        "dwell": dwell,
        "residual": left - left.mean(),
        "rms_nm": float(left.std()),
        "dwell_s": float(dwell.sum()),
        "kkt": found["residual"],
        "iterations": found["iterations"],
        "seconds": seconds,
    }


def plain(heights, step):
    """(rms nm, dwell s) of least squares without limits, what is below zero cut off; the piston such that the least
    height is nothing."""
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import lsqr

    first, sample, depth = columns(heights.shape, step)
    matrix = csc_matrix((depth, sample, first), (heights.size, len(first) - 1))
    wanted = heights.ravel() - heights.min()
    dwell = np.maximum(lsqr(matrix, wanted, iter_lim=300)[0], 0.0)
    left = wanted - matrix @ dwell
    return float(left.std()), float(dwell.sum())


def _owner(first):
    return np.repeat(np.arange(len(first) - 1), np.diff(first))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--step", type=int, default=3, help="pixels between places of dwell")
    parser.add_argument("--json", help="file for Google Benchmark's JSON")
    arguments = parser.parse_args()
    if not DATA.is_file():
        print(f"dwell: no data at {DATA}")
        return
    heights = surface()
    print(f"dwell: {heights.std():.2f} nm RMS before")
    print(f"dwell: RIFTA {RIFTA['rms_nm']} nm, {RIFTA['dwell_s']:.0f} s of dwell")
    rms, total = plain(heights, arguments.step)
    print(f"dwell: least squares cut off at zero {rms:.4f} nm, {total:.0f} s of dwell")
    found = solve(heights, arguments.step)
    print(
        f"dwell: {found['rms_nm']:.4f} nm, {found['dwell_s']:.0f} s of dwell; {len(found['dwell'])} places, "
        f"{found['iterations']} iterations, {found['seconds']:.1f} s, KKT {found['kkt']:.1e}"
    )
    if arguments.json:
        row = {"name": f"dwell/{arguments.step}", "real_time": found["seconds"], "time_unit": "s"}
        row.update(rms_nm=found["rms_nm"], dwell_s=found["dwell_s"])
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": [row]}))


if __name__ == "__main__":
    main()
