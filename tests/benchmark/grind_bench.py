"""What `beltgrind grind` makes of faces of the real parts of shared/data/cad: by rules, and by its search, against what is reachable.

tools/bench grind [NAME] [--uneven] [--budget S] [--random N]; `python grind_bench.py` with the same, and [--json FILE], does it, too. The first
settings are those of `grind` for a part's file; the stock is 0.3 mm, or with --uneven 0.3 mm +- 0.15 mm in waves of 40 to 90 mm; the tolerance
+-0.05 mm; the robot's time. Nothing is checked at half the spacing. Columns:

wheel       radius x width of the first settings, mm
reachable   of the area, by geometry, %: that wheel, its belt in any direction, leaned by up to 15 degrees
any wheel   the same, by any of the series and the presets
rules       of the area in tolerance, %, with the first settings and the rules (`--budget 0`)
rules s     seconds that took
search      the same by the search with the job's wheel (`--wheels own`)
search s    seconds that took
way         what the search chose: along and belt angle, degrees
of it       search, of what is reachable, %
random      with --random N: the best of N random settings, by rough plans as the search has them, then planned with all samples, %
random s    seconds that took
"""

import argparse
import json
import os
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

import numpy as np

from beltgrinding.base.crew import Call, Crew, End
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs, workpiece
from beltgrinding.job.typed import typed
from beltgrinding.planning import grinding, rough, rounds, search, tasks, wheels
from beltgrinding.raster import proposal, raster_path, reach_map
from plan_bench import STOCK, uneven

PARTS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "cad"
SETS = (
    ("ball_valve_lever", [132]),
    ("blade_airfoil_periodic", [1]),
    ("blade_marine_lower", [1]),
    ("blade_marine_root", [1]),
    ("blade_marine_solid_derived", [1]),
    ("blade_marine_tip", [1]),
    ("blade_marine_upper", [1]),
    ("casting_3flange_open_shell", [9]),
    ("crank_arm", [2]),
    ("hammer_claw", [28]),
    ("housing_with_spout", [93]),
    ("impeller_kj66", [91]),
    ("key_k1_alias", [16]),
    ("propeller_3blade", [38]),
    ("pump_cover", [6]),
)
UNITS = {"hammer_claw": 0.001}  # mm, as parts_bench has it
QUICK = {"check": False}
HEAD = ("wheel", "reachable", "any wheel", "rules", "rules s", "search", "search s", "way", "of it")


def job_of(file, faces, allowance, folder, waves):
    """(validated job as `grind` makes it of a part's file, first settings of its raster)."""
    design = {"file": str(file), "faces": faces, "unit_mm": UNITS.get(file.stem, 1.0)}
    given = {"design": design, "stock": {"allowance_mm": allowance}, "programs": [{"poses": []}]}
    job = jobs.validate(given)
    seen = proposal.propose(job)
    if waves:
        shape = workpiece.read_design(job["design"])
        given["stock"] = {"kind": "mesh", "file": str(uneven(shape, faces, folder))}
    given["sampling"] = {"spacing_mm": seen["spacing_mm"]}
    given["belt_machine"] = {
        "wheel": {"radius_mm": seen["wheel_radius_mm"], "width_mm": seen["wheel_width_mm"]},
        "compliance": {"rim_thickness_mm": seen["rim_thickness_mm"]},
        "force_N": seen["force_N"],
    }
    first = {name: seen[name] for name in proposal.OF_PASSES}
    return jobs.validate(given), {"along": "direction", **first}


def measure(job, first, budget):
    """The figures of HEAD."""
    own = wheels.own(job)
    begun = time.perf_counter()
    ruled = grinding.grind(job, first, QUICK)
    between = time.perf_counter()
    further = wheels.mounted(job, [*wheels.series(own), *wheels.of_presets()])
    wanted = search.Search(budget, further=further)
    found = grinding.grind(job, first, QUICK, search=wanted)
    end = time.perf_counter()
    report, settings = found.search, found.settings
    rules, best = (one.plan.after.summary["in_tolerance_area_share"] for one in (ruled, found))
    return {
        "wheel": f"{own.radius:g} x {own.width:g}",
        "reachable": 100.0 * report["reachable"],
        "any wheel": 100.0 * report["reachable_by_any"],
        "rules": 100.0 * rules,
        "rules s": between - begun,
        "search": 100.0 * best,
        "search s": end - between,
        "way": f"{settings['along']}, {settings['belt_angle_deg']:g}",
        "of it": 100.0 * best / max(report["reachable"], 1e-9),
        "wheels": report["wheels"],
        "tried": report["tried"],
    }


def drawn(data, first, count):
    """Random settings as ``rough.Move``s: all ways that the search looks at, all belt angles and leans,
    step-overs and run-outs around the usual ones, forces from 1 N to twice the first."""
    rng = np.random.default_rng(count)
    ways = reach_map.ways(data, first, core.RunContext())
    force = data["belt_machine"]["force_N"]
    moves = []
    for _ in range(count):
        settings = {
            **first,
            **ways[rng.integers(len(ways))],
            "belt_angle_deg": float(rng.integers(-8, 9) * 11.25),
            "step_over_share": float(rng.uniform(0.2, 0.9)),
            "step_over_mm": 0.0,
            "run_out_mm": float(rng.normal(0.0, 2.0)),
            "max_tilt_deg": float(rng.uniform(0.0, 15.0)),
        }
        pressed = {
            **data["belt_machine"],
            "force_N": float(np.exp(rng.uniform(0.0, np.log(2.0 * force)))),
        }
        moves.append(("random", pressed, settings))
    return moves


def by_chance(job, first, count):
    """(of the area, in tolerance by a plan with all samples, with the best of ``count`` random settings; seconds)."""
    begun = time.perf_counter()
    settings = grinding.with_forces(typed(job), rounds.validate(QUICK))
    data, settings = rounds.in_time(job, settings)
    data = rounds.settled(data, core.RunContext())
    with Crew() as crew:
        moves, never = drawn(data, raster_path.validate(first), count), End(float("inf"))
        calls = [Call(tasks.alone, (tasks.begun, data, never, move, settings)) for move in moves]
        found = [one.value for one in crew.run(calls) if one is not None and one.value is not None]
    if not found:  # on none of them passes can be laid
        return 0.0, time.perf_counter() - begun
    best = max(found, key=lambda one: one.in_tolerance)
    data = rough.with_machine(data, best.machine, best.wanted, settings)
    laid = rough.lay(data, best.wanted, settings, core.RunContext())
    plan = rounds.plan(rough.with_path(data, laid), settings, start=best.start)
    return plan.after.summary["in_tolerance_area_share"], time.perf_counter() - begun


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("part", nargs="?", default="", help="only this one")
    parser.add_argument("--uneven", action="store_true", help="stock in waves")
    parser.add_argument("--budget", type=float, default=search.BUDGET_S, metavar="S")
    parser.add_argument("--random", type=int, default=0, metavar="N", help="settings by chance")
    parser.add_argument("--json", metavar="FILE")
    arguments = parser.parse_args()
    rows = []
    head = (*HEAD, "random", "random s") if arguments.random else HEAD
    print("| part | faces | stock | " + " | ".join(head) + " |")
    print("| --- " * (3 + len(head)) + "|", flush=True)
    for name, faces in SETS:
        if arguments.part not in name:
            continue
        file = next(iter(sorted(PARTS.glob(f"{name}.*"))), None)
        if file is None:
            print(f"{name}: not there")
            continue
        stock = "uneven" if arguments.uneven else "even"
        with tempfile.TemporaryDirectory() as folder:
            try:
                given = job_of(file, faces, STOCK, folder, arguments.uneven)
                row = measure(*given, arguments.budget)
                if arguments.random:
                    share, seconds = by_chance(*given, arguments.random)
                    row.update({"random": 100.0 * share, "random s": seconds})
            except InputError as error:
                print(f"| {name} | {faces} | {stock} | {error} |", flush=True)
                continue
        rows.append({"part": name, "faces": faces, "stock": stock, **row})
        cells = [row[k] if isinstance(row[k], str) else f"{row[k]:.1f}" for k in head]
        told = ", ".join(map(str, faces))
        print(f"| {name} | {told} | {stock} | " + " | ".join(cells) + " |", flush=True)
    if arguments.json:
        Path(arguments.json).parent.mkdir(parents=True, exist_ok=True)
        Path(arguments.json).write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
