"""What the robot's time costs a plan, on four faces of the real parts of shared/data/cad.

tools/bench plan_time [NAME]; passes, wheel and stock (even) as plan_bench.py has them, forces of 1.5 to 30 N, no controller named.
Columns, of the area in tolerance, %:

constant        planned at constant feed
in time         that plan as the robot runs it: its accelerations, corners, cycles
robot           planned in the robot's time
s               of the process at constant feed, and as planned in the robot's time
"""

import argparse

from beltgrinding import planning
from beltgrinding.job.robot_time import timed
from beltgrinding.simulation import run as runs
from plan_bench import PARTS, STOCK, job_of

SETS = (
    ("pump_cover", [6]),
    ("blade_marine_upper", [1]),
    ("propeller_3blade", [38]),
    ("casting_3flange_open_shell", [9]),
)
FORCES = {"force_min_N": 1.5, "force_max_N": 30.0, "check": False}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", nargs="?", default="", help="only parts whose name has this in it")
    arguments = parser.parse_args()
    print("| part | face | constant | in time | robot | s |\n| --- | --- | --- | --- | --- | --- |")
    for name, faces in SETS:
        file = next(iter(sorted(PARTS.glob(f"{name}.*"))), None)
        if arguments.name not in name or file is None:
            continue
        job = job_of(file, faces, {"allowance_mm": STOCK})
        constant = planning.plan(job, {**FORCES, "timing": "job"})
        robot = planning.plan(job, {**FORCES, "timing": "robot"})
        results = constant.after, runs.run(timed(constant.job)), robot.after
        shares = [100.0 * one.summary["in_tolerance_area_share"] for one in results]
        cells = " | ".join(f"{share:.1f}" for share in shares)
        seconds = [one.summary["process_time_s"] for one in (results[0], results[2])]
        print(
            f"| {name} | {faces[0]} | {cells} | {seconds[0]:.0f} → {seconds[1]:.0f} |", flush=True
        )


if __name__ == "__main__":
    main()
