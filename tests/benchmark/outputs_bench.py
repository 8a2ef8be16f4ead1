"""Run by tools/bench outputs: what is made of a ground field of a million samples, and what that costs.

    PYTHONPATH=Mod/BeltGrinding:build/release/python python3 tests/benchmark/outputs_bench.py [--profile NAME]

Writes JSON in Google Benchmark's form to BELTGRINDING_BENCH_OUT. A plate of 500 x 500 mm, one side of it ground in
20 lanes by a real run, so that motions, trace and time series are there. Figures in s of wall time, the
median of three, ``_cpu`` of processor time:

- verdict: in tolerance or not, worst clusters, waviness (``verdict.of_result``); of it verdict_judge and
  verdict_waviness, which run side by side;
- mesh: the samples as a coloured mesh, PLY (deviation.ply of every result);
- ground_mesh: the whole part as one closed mesh with the deviation's colours, PLY;
- report: the HTML report with its pictures and 3D view, from a result in memory to the file's bytes;
- of it report_pictures, report_view (the 3D view's data, made beside the pictures) and report_page (text, tables,
  charts);
- write, read: all files of the result, and back;
- total: verdict, mesh and report, one after the other.
"""

import argparse
import cProfile
import json
import os
import pstats
import statistics
import tempfile
import time
from pathlib import Path

import beltgrinding
from beltgrinding.engine import core
from beltgrinding.inspection import closed_mesh, verdict
from beltgrinding.job import workpiece
from beltgrinding.job.tolerances import colour_scale
from beltgrinding.reporting import page, pictures, report, view, worst_spots
from beltgrinding.reporting.language import Language
from beltgrinding.simulation.result import Result
from ground_plate import plate_job

TIMES = 3


def works(result, folder):
    """{name: work}"""
    shape = workpiece.read_design(result.job["design"])
    scale = colour_scale(result.job)

    def reported():
        content = report.load(result)
        return report.render(content, Language("en"), still=False)[1].encode()

    def read():
        return Result.read(folder)

    words, content, made = Language("en"), report.load(result), {}
    spots = worst_spots.worst(result.field, scale[:2], content.verdict)

    def drawn():
        made["pictures"] = pictures.draw(result.field, scale, content.shape, spots)

    def turned():
        sides = {name: made["pictures"][name].view for name in ("front", "back")}
        made["view"] = view.view(content, scale, spots, sides, words)

    def paged():
        return page.document(content, words, scale, spots, made["pictures"], made["view"])

    return {
        "verdict": lambda: verdict.of_result(result, shape),
        "verdict_judge": lambda: verdict.judge(result.job, result.field),
        "verdict_waviness": lambda: verdict.waviness(result.field, result.motions),
        "mesh": lambda: core.deviation_ply(result.field, *scale, True, "bench"),
        "ground_mesh": lambda: closed_mesh.ground_mesh(result).ply(scale),
        "report": reported,
        "report_pictures": drawn,
        "report_view": turned,
        "report_page": paged,
        "write": lambda: result.write(folder),
        "read": read,
    }


def timed(work):
    wall, used = [], []
    for _ in range(TIMES):
        start, before = time.perf_counter(), time.process_time()
        work()
        wall.append(time.perf_counter() - start)
        used.append(time.process_time() - before)
    return statistics.median(wall), statistics.median(used)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--samples", type=float, default=1e6)
    parser.add_argument("--profile", help="a figure whose functions are told")
    arguments = parser.parse_args()
    start = time.perf_counter()
    result = beltgrinding.run(plate_job(arguments.samples))
    run = time.perf_counter() - start
    figures = {}
    with tempfile.TemporaryDirectory() as folder:
        made = works(result, Path(folder) / "result")
        if arguments.profile:
            if arguments.profile in ("report_view", "report_page"):
                made["report_pictures"]()
            if arguments.profile == "report_page":
                made["report_view"]()
            with cProfile.Profile() as profile:
                made[arguments.profile]()
            pstats.Stats(profile).sort_stats("cumulative").print_stats(60)
            return
        for name, work in made.items():
            figures[name] = timed(work)
    parts = [figures[name] for name in ("verdict", "mesh", "report")]
    figures["total"] = tuple(sum(part[k] for part in parts) for k in (0, 1))
    print(f"{result.field.size} samples, ground in {run:.1f} s")
    for name, (wall, used) in figures.items():
        print(f"outputs/{name:20} {wall:8.2f} s  {used:8.2f} s of processor")
    if "BELTGRINDING_BENCH_OUT" in os.environ:
        kinds = (("", 0), ("_cpu", 1))
        benchmarks = [
            {"name": f"outputs/{name}{kind}", "real_time": values[k], "time_unit": "s"}
            for name, values in figures.items()
            for kind, k in kinds
        ]
        Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
            json.dumps({"context": {}, "benchmarks": benchmarks})
        )


main()
