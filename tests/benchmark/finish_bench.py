"""How a calibrated roughness tells measurements that were left out, beside one Ra for all and Ra by the grit alone, on
SYNTHETIC tables: tools/bench finish [--tables N] [--json FILE]"""

import argparse
import json
import time
from pathlib import Path


import numpy as np

from beltgrinding.calibration import fit_finish
from support import synthetic_finish

TABLES = ((15, 0.1), (30, 0.1), (30, 0.25), (60, 0.1))  # measurements, scatter of ln Ra


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tables", type=int, default=10, help="of each kind")
    parser.add_argument("--json", help="file for the figures")
    arguments = parser.parse_args()
    print("SYNTHETIC tables: median and 90 % of the relative errors of left-out measurements, %")
    print("rows scatter |    model     |  grit alone  |    one Ra")
    results = []
    for count, scatter in TABLES:
        begin = time.process_time()
        found = {"left_out": [], "grit_only": [], "constant": []}
        for seed in range(arguments.tables):
            table = synthetic_finish.columns(count, scatter, seed, passes=False)
            report = fit_finish(table)["report"]
            found["left_out"].append(report["left_out"])
            for name in ("grit_only", "constant"):
                found[name].append(report["plain"][name])
        figures = {
            f"{name}_{part}": float(np.mean([one[part] for one in errors]))
            for name, errors in found.items()
            for part in ("median", "p90")
        }
        told = [100 * figures[f"{name}_{part}"] for name in found for part in ("median", "p90")]
        print(
            f"{count:4d} {scatter:7.2f} |"
            + " |".join(f" {a:5.1f} {b:6.1f} " for a, b in zip(told[::2], told[1::2]))
        )
        took = (time.process_time() - begin) / arguments.tables
        name = f"finish/{count}/{scatter}"
        results.append({"name": name, "real_time": took, "time_unit": "s", **figures})
    if arguments.json:
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": results}))


if __name__ == "__main__":
    main()
