"""Our deviation against CloudCompare's and FreeCAD's Inspection, at the same points, in one run.

    tools/bench deviation
    BELTGRINDING_RESULT=out:out2 tools/bench deviation

for the example blade, or for results (folders that ``beltgrind run`` wrote). A result's closed ground mesh is compared with the
CAD, both ways round: we cast rays from the design's samples to the mesh; CloudCompare measures
from the mesh's vertices to a fine mesh of the CAD (cloud to mesh), Inspection from some of them to
the CAD itself. What all three should find is the deviation that the mesh's vertices carry. The
fine mesh has its vertices on the CAD's own surface, ``CAD_SPACING`` apart, so that its facets are
off by spacing^2 / (8 R) at most; it is told twice, also at double the spacing, for what is the
facets' part.

Smooth are the vertices inside of a ground face, farther from its border than ``BORDER`` times the
greatest deviation, and not where a triangle was turned over: elsewhere the nearest point of the
CAD is not the foot of the normal.
"""

import json
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np


import beltgrinding
from beltgrinding.inspection import closed_mesh
from beltgrinding.engine import core
from beltgrinding.job import workpiece, load as jobs
from beltgrinding.simulation import run as runs
from beltgrinding.simulation.result import Result

BORDER = 3.0  # of the greatest deviation
CAD_SPACING = float(os.environ.get("BELTGRINDING_CAD_SPACING", "0.2"))  # mm
INSPECTED = int(os.environ.get("BELTGRINDING_INSPECTED", "300"))  # points: some 50 ms for each
CLOUDCOMPARE = shutil.which("cloudcompare.CloudCompare") or shutil.which("CloudCompare")


def border_vertices(mesh):
    """Numbers of the vertices on the borders of faces."""
    t = mesh.triangles.astype(np.int64)
    edges = np.sort(t[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.repeat(mesh.faces, 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    same = (edges[1:] == edges[:-1]).all(axis=1) & (owner[1:] == owner[:-1])
    inner = np.zeros(len(edges), bool)
    inner[1:] |= same
    inner[:-1] |= same
    return np.unique(edges[~inner])


def smooth(result, mesh, points, numbers):
    """Those of ``numbers`` of ``points`` that lie in smooth areas."""
    reach = max(BORDER * float(np.abs(result.field.height).max()), 2 * result.field.spacing)
    border = border_vertices(mesh)
    for some in np.array_split(border, max(1, len(border) // 64)):
        centre = mesh.vertices[some]
        low, high = centre.min(axis=0) - reach, centre.max(axis=0) + reach
        near = ((points[numbers] > low) & (points[numbers] < high)).all(axis=1)
        close = points[numbers[near]]
        distance = np.full(len(close), np.inf)
        for c in centre:
            distance = np.minimum(distance, ((close - c) ** 2).sum(axis=1))
        keep = np.ones(len(numbers), bool)
        keep[np.flatnonzero(near)[distance < reach**2]] = False
        numbers = numbers[keep]
    return numbers


def ours(result, mesh):
    """(seconds, deviation at the design's samples) by rays from the design to the ground mesh."""
    start = time.perf_counter()
    job = result.job
    field = workpiece.make_field(job, workpiece.read_design(job["design"]), [], core.RunContext())
    mesh = core.TriangleMesh(mesh.vertices.astype(np.float32), mesh.triangles)
    stock = job["stock"]
    core.apply_mesh(field, mesh, stock["search_above_mm"], stock["search_below_mm"])
    missed = (np.asarray(field.flags) & core.MISSED) != 0
    return time.perf_counter() - start, np.where(missed, np.nan, field.height)


def cloudcompare(points, cad, folder):
    """(seconds, signed distance of each point) by CloudCompare, from the command line."""
    cloud, told = folder / "points.xyz", folder / "told.asc"
    np.savetxt(cloud, points, "%.9g")
    command = [CLOUDCOMPARE, "-SILENT", "-AUTO_SAVE", "OFF", "-C_EXPORT_FMT", "ASC"]
    command += ["-PREC", "9", "-O", str(cloud), "-O", str(cad), "-C2M_DIST"]
    command += ["-SAVE_CLOUDS", "FILE", str(told)]
    if shutil.which("xvfb-run"):
        command = ["xvfb-run", "-a", *command]
    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder)
    seconds = time.perf_counter() - start
    if not told.exists():
        raise RuntimeError(f"CloudCompare wrote nothing: {done.stdout[-2000:]}{done.stderr[-500:]}")
    rows = np.loadtxt(told, comments="/")
    if len(rows) != len(points):
        raise RuntimeError(f"CloudCompare wrote {len(rows)} points of {len(points)}")
    return seconds, rows[:, -1]


def inspection(points, shape):
    """(seconds, signed distance of each point) by FreeCAD's Inspection."""
    import FreeCAD
    import Inspection  # noqa: F401: registers Inspection::Feature
    import Points

    document = FreeCAD.newDocument("Inspection", hidden=True)
    part = document.addObject("Part::Feature", "Part")
    part.Shape = shape
    cloud = document.addObject("Points::Feature", "Cloud")
    cloud.Points = Points.Points([FreeCAD.Vector(*map(float, point)) for point in points])
    feature = document.addObject("Inspection::Feature", "Inspection")
    feature.Actual, feature.Nominals = cloud, [part]
    feature.SearchRadius = feature.Thickness = 5.0
    start = time.perf_counter()
    document.recompute()
    seconds = time.perf_counter() - start
    found = np.array(feature.Distances)
    FreeCAD.closeDocument(document.Name)
    return seconds, found


def cad_mesh(result, spacing, path):
    """Seconds for a fine mesh of the CAD, as a binary STL file; and its facets."""
    start = time.perf_counter()
    shape = workpiece.read_design(result.job["design"])
    mesh = core.ground_mesh(shape, result.field, False, spacing / 20, spacing)
    path.write_bytes(mesh.stl())
    return time.perf_counter() - start, len(mesh.triangles)


def difference(found, truth):
    """Figures of found - truth, mm."""
    off = (found - truth)[np.isfinite(found)]
    return {
        "points": len(off),
        "lost": int(len(found) - len(off)),
        "rms_mm": float(np.sqrt((off**2).mean())),
        "p99_mm": float(np.percentile(np.abs(off), 99)),
        "max_mm": float(np.abs(off).max()),
    }


def compare(folder):
    """All figures for the result in ``folder``."""
    import Part

    result = Result.read(folder)
    start = time.perf_counter()
    mesh = beltgrinding.ground_mesh(result)
    mesh_seconds = time.perf_counter() - start
    shape = Part.Shape()
    shape.importBrepFromString(workpiece.read_design(result.job["design"]).write_brep())
    ground = np.flatnonzero(mesh.standing == closed_mesh.STANDING.index("ground"))
    chosen = smooth(result, mesh, mesh.vertices, ground)
    figures = {
        "result": Path(folder).name,
        "ground_vertices": len(ground),
        "smooth_vertices": len(chosen),
        "turned_triangles": mesh.report()["flipped"],
        "ground_mesh_s": mesh_seconds,
    }
    seconds, rays = ours(result, mesh)
    inside = smooth(result, mesh, result.field.points, np.arange(len(rays)))
    figures["ours"] = {
        **difference(rays[inside], result.field.height[inside]),
        "seconds": seconds,
        "seconds_per_million": 1e6 * seconds / len(rays),
    }
    truth = mesh.deviation.astype(float)
    with tempfile.TemporaryDirectory() as place:
        place = Path(place)
        for name, spacing in (("cloudcompare", CAD_SPACING), ("coarser", 2 * CAD_SPACING)):
            if not CLOUDCOMPARE:
                break
            meshing, facets = cad_mesh(result, spacing, place / "cad.stl")
            seconds, told = cloudcompare(mesh.vertices[chosen], place / "cad.stl", place)
            figures[name] = {
                **difference(told, truth[chosen]),
                "seconds": seconds + meshing,
                "of_which_meshing_s": meshing,
                "cad_facets": facets,
                "seconds_per_million": 1e6 * (seconds + meshing) / len(chosen),
            }
    some = np.sort(np.random.default_rng(7).permutation(chosen)[:INSPECTED])
    seconds, told = inspection(mesh.vertices[some], shape)
    told[np.abs(told) > 1e6] = np.nan  # outside of the search radius
    figures["inspection"] = {
        **difference(told, truth[some]),
        "seconds": seconds,
        "seconds_per_million": 1e6 * seconds / len(some),
    }
    base = figures["ours"]["seconds_per_million"]
    for name in ("cloudcompare", "coarser", "inspection"):
        if name in figures:
            figures[name]["times_ours"] = figures[name]["seconds_per_million"] / base
    return figures


def example(folder):
    """The example blade, ground, in a folder of its own."""
    from beltgrinding.examples import blade

    blade.make(str(folder))
    runs.run(jobs.load(folder / "job.json")).write(folder / "example_blade")
    return str(folder / "example_blade")


def main(folder):
    given = os.environ.get("BELTGRINDING_RESULT")
    found = [compare(one) for one in (given.split(os.pathsep) if given else [example(folder)])]
    if not CLOUDCOMPARE:
        print("deviation/ CloudCompare is not installed (apt install cloudcompare): left out")
    benchmarks = []
    for figures in found:
        for name in ("ours", "cloudcompare", "coarser", "inspection"):
            if name not in figures:
                continue
            f = figures[name]
            whole = f"deviation/{figures['result']}/{name}"
            print(
                f"{whole:40} {f['points']:7} points, rms {f['rms_mm']:.5f} mm, "
                f"p99 {f['p99_mm']:.5f} mm, max {f['max_mm']:.4f} mm, "
                f"{f['seconds_per_million']:.1f} s per million points "
                f"({f.get('times_ours', 1.0):.1f} times ours)"
            )
            microseconds = f["seconds_per_million"]
            benchmarks.append(
                {"name": whole, "real_time": microseconds, "time_unit": "us", "figures": f}
            )
    Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
        json.dumps({"context": {}, "benchmarks": benchmarks}, indent=1)
    )


if "BELTGRINDING_BENCH_OUT" in os.environ:
    with tempfile.TemporaryDirectory() as place_of_example:
        main(Path(place_of_example))
