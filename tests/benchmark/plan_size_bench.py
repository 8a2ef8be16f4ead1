"""How long the planner's solver takes on a large plan: 10,000 motions, 1,000,000 samples.

tools/bench plan_size; `python plan_size_bench.py [--motions N] [--samples N] [--json FILE]` does the same. A raster over a
square plate: every motion removes under a round contact that some 24 samples of it lie in, so that each sample is
ground by several passes, and A has about 24 entries a sample; the stock is uneven by half. Printed: seconds, iterations,
greatest memory of the process, KKT residual, and whether one thread gives the same bits as all.
"""

import argparse
import json
import math
import resource
import time
from pathlib import Path

import numpy as np


from beltgrinding.engine import core

PER_SAMPLE = 24.5  # motions that grind a sample
DEPTH = 0.3  # mm that all motions take from a sample together


def problem(motions, samples):
    """(Influence, excess (samples,) mm)."""
    passes = int(round(math.sqrt(motions)))
    side = int(round(math.sqrt(samples)))
    reach = math.sqrt(PER_SAMPLE / math.pi) * side / passes  # samples, of a contact's radius
    random = np.random.default_rng(1)
    first, index, depth = [0], [], []
    for j in range(passes):
        y = (j + 0.5) * side / passes
        for i in range(passes):
            x = (i + 0.5) * side / passes
            rows = np.arange(max(0, int(y - reach)), min(side, int(y + reach) + 1))
            columns = np.arange(max(0, int(x - reach)), min(side, int(x + reach) + 1))
            share = 1.0 - ((rows[:, None] - y) ** 2 + (columns[None] - x) ** 2) / reach**2
            under = share > 0.0
            index.append((rows[:, None] * side + columns[None])[under].astype(np.uint32))
            depth.append((2.0 * DEPTH / PER_SAMPLE * share[under]).astype(np.float32))
            first.append(first[-1] + len(index[-1]))
    influence = core.Influence(
        np.array(first, dtype=np.uint64), np.concatenate(index), np.concatenate(depth)
    )
    rows, columns = np.mgrid[:side, :side] / side
    waves = np.sin(9.0 * rows + 5.0 * columns) * np.sin(13.0 * columns - 4.0 * rows)
    return influence, (0.5 * DEPTH * waves + 0.01 * random.standard_normal(waves.shape)).ravel()


def solve(influence, excess):
    """(what ``core.plan_dwell`` finds, seconds)."""
    motions, samples = len(influence), len(excess)
    begun = time.perf_counter()
    found = core.plan_dwell(
        influence,
        excess,
        np.full(samples, 0.05),
        np.ones(samples),
        np.full(motions, 1.0 / 3.0),
        np.full(motions, 3.0),
        np.full(motions, 0.02),
    )
    return found, time.perf_counter() - begun


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--motions", type=int, default=10_000)
    parser.add_argument("--samples", type=int, default=1_000_000)
    parser.add_argument("--json", help="file for Google Benchmark's JSON")
    arguments = parser.parse_args()
    influence, excess = problem(arguments.motions, arguments.samples)
    found, seconds = solve(influence, excess)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    inside = (np.abs(found["excess"]) <= 0.05).mean()
    print(
        f"plan_size: {len(influence)} motions, {len(excess)} samples, {len(influence.sample) / 1e6:.1f} M entries: "
        f"{seconds:.1f} s, {found['iterations']} iterations, {memory:.2f} GB, KKT {found['residual']:.1e}, "
        f"{100 * (np.abs(excess) <= 0.05).mean():.1f} -> {100 * inside:.1f} % in the band",
        flush=True,
    )
    core.set_threads(1)
    alone, slower = solve(influence, excess)
    same = np.array_equal(found["factor"], alone["factor"])
    print(f"plan_size: one thread {slower:.1f} s, {'the same bits' if same else 'OTHER BITS'}")
    if arguments.json:
        row = {"name": "plan_size/10000/1000000", "real_time": seconds, "time_unit": "s"}
        row.update(memory_GB=memory, same_bits=same)
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": [row]}))


if __name__ == "__main__":
    main()
