"""How the calibrated law predicts measured grinds that it never saw, beside an ordinary regression of the power law:
tools/bench calibration [--repeats N] [--json FILE]"""

import argparse
import json
import time
from pathlib import Path


from support import held_out


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=50, help="random halves, each both ways")
    parser.add_argument("--json", help="file for the figures")
    arguments = parser.parse_args()
    if not held_out.TABLE.is_file():
        print(f"calibration: no measured grinds at {held_out.TABLE}")
        return
    print("median and 90 % of the relative errors on held-out halves, %; in the 95 % intervals, %")
    print(f"{'table':24s} grinds |     law      |  power law   | inside")
    results, inside = [], []
    for name, table in held_out.tables().items():
        begin = time.perf_counter()
        found = held_out.compared(table, arguments.repeats)
        took = time.perf_counter() - begin
        figures = [100 * value for value in (*found["law"], *found["power"], found["inside"])]
        print(
            f"{name:24s} {len(table.force):6d} | {figures[0]:5.1f} {figures[1]:6.1f} | "
            f"{figures[2]:5.1f} {figures[3]:6.1f} | {figures[4]:5.1f}",
            flush=True,
        )
        inside.append(found["inside"])
        results.append(
            {"name": f"calibration/{name}", "real_time": took, "time_unit": "s", **found}
        )
    print("without the tenth of greatest ..., median error on those: law, power law, %")
    for name in ("force", "speed", "time", "wear"):
        for part in ("known areas", "50 mm2"):
            told = held_out.extrapolated(held_out.tables()[part], name)
            print(f"{name:6s} {part:14s} {100 * told[0]:5.1f} {100 * told[1]:5.1f}")
    print(f"inside on average: {100 * sum(inside) / len(inside):.1f} %")
    if arguments.json:
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": results}))


if __name__ == "__main__":
    main()
