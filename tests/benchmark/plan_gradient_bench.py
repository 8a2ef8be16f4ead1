"""How true the planner's gradients are: against central differences of whole simulations, on a real blade.

tools/bench plan_gradient; `python plan_gradient_bench.py [--motions N]` does the same. For some motions of the marine
blade's raster, feed and force are changed by 3 % both ways and the job simulated anew; what that changes, sample by
sample where the motion removes most, is compared with what the planner takes it for: A for the time, the
simulation's own influence of the force, both as later motions leave them; `alone` is what the motion does itself. Printed:
the error's median and 95th percentile, and that of all a motion removes together.
"""

import argparse

import numpy as np


import plan_bench
from beltgrinding.planning import rounds
from beltgrinding.planning.commands import Commands
from beltgrinding.simulation import run as runs

CHANGE = 0.03
LEAST = 50  # samples under a motion
PER_MOTION = 9  # samples that are compared


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--motions", type=int, default=12)
    arguments = parser.parse_args()
    if not plan_bench.PARTS.is_dir():
        print(f"plan_gradient: no data at {plan_bench.PARTS}")
        return
    file = plan_bench.PARTS / "blade_marine_upper.iges"
    job = plan_bench.job_of(file, [1], {"allowance_mm": plan_bench.STOCK})
    commands = Commands(job, rounds.validate({"force_max_N": 60.0, "timing": "job"}))
    feeds, ones = commands.feed(), np.ones(len(commands))
    run = runs.run(job, influence=True, forces=True)
    groups, areas = (commands.group, len(commands)), np.asarray(run.field.areas)
    both = {"feed": run.influence, "force": run.force_influence}
    told = {what: one.in_the_end(run.influence, areas, *groups) for what, one in both.items()}
    alone = {what: one.grouped(*groups) for what, one in both.items()}
    random = np.random.default_rng(0)
    busy = np.flatnonzero(np.diff(told["feed"].first.astype(int)) > LEAST)

    def height(feeds, factors):
        return np.asarray(runs.run(commands.with_feeds(feeds, factors)).field.height, dtype=float)

    errors = {"feed": ([], []), "force": ([], [])}
    before = {"feed": ([], []), "force": ([], [])}
    for k in random.choice(busy, min(arguments.motions, len(busy)), replace=False):
        for what, (single, whole) in errors.items():
            first = told[what].first.astype(int)
            mine = slice(first[k], first[k + 1])
            samples, taken = told[what].sample[mine], told[what].depth[mine].astype(float)
            most = np.argsort(-taken)[: max(20, len(taken) // 3)]
            some = random.choice(most, PER_MOTION, replace=False)
            ends = []
            for change in (1.0 + CHANGE, 1.0 - CHANGE):
                other = (feeds if what == "feed" else ones).copy()
                other[k] = other[k] / change if what == "feed" else other[k] * change
                ends.append(height(other, ones) if what == "feed" else height(feeds, other))
            found = (ends[1] - ends[0]) / (2.0 * CHANGE)
            single += (found[samples[some]] / taken[some] - 1.0).tolist()
            whole.append(found[samples].sum() / taken.sum() - 1.0)
            column = np.zeros(len(found))
            first = alone[what].first.astype(int)
            mine = slice(first[k], first[k + 1])
            column[alone[what].sample[mine]] = alone[what].depth[mine]
            own = samples[some][column[samples[some]] > 0.0]
            before[what][0].extend((found[own] / column[own] - 1.0).tolist())
            before[what][1].append(found[column != 0.0].sum() / column.sum() - 1.0)
    rows = [(what, *one) for what, one in errors.items()]
    rows += [(f"{what} alone", *one) for what, one in before.items()]
    for what, single, whole in rows:
        away = np.abs(single)
        print(
            f"plan_gradient: {what}: {len(single)} entries off by {100 * np.median(away):.0f} % (median), "
            f"{100 * np.percentile(away, 95):.0f} % (95th percentile); all of a motion by "
            f"{100 * np.median(np.abs(whole)):.0f} %"
        )


if __name__ == "__main__":
    main()
