"""Our deviation against CloudCompare's and FreeCAD's Inspection, at the same points, in one run.

    BELTGRINDING_RESULT=out BELTGRINDING_BENCH_OUT=bench.json freecadcmd deviation_bench.py

``out`` is the folder of a result (``beltgrind run``). Its closed ground mesh is compared with the
CAD, both ways round: we cast rays from the design's samples to the mesh; CloudCompare measures
from the mesh's vertices to a fine mesh of the CAD (cloud to mesh), Inspection from some of them to
the CAD itself. What all three should find is the deviation that the mesh's vertices carry.

Smooth are the vertices inside of a ground face, farther from its border than ``BORDER`` times the
greatest deviation, and not where a triangle was turned over: elsewhere the nearest point of the
CAD is not the foot of the normal.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "Mod" / "BeltGrinding"))

import beltgrinding  # noqa: E402
from beltgrinding import closed_mesh, core, job as jobs  # noqa: E402
from beltgrinding.result import Result  # noqa: E402

BORDER = 3.0  # of the greatest deviation
CAD_DEFLECTION = float(os.environ.get("BELTGRINDING_CAD_DEFLECTION", "0.001"))  # mm
INSPECTED = int(os.environ.get("BELTGRINDING_INSPECTED", "2000"))  # points: it takes 2 ms for each
CLOUDCOMPARE = shutil.which("cloudcompare.CloudCompare") or shutil.which("CloudCompare")


def smooth_vertices(result, mesh):
    """Numbers of the vertices that lie in smooth areas."""
    field = result.field
    greatest = float(np.abs(field.height).max())
    ground = mesh.standing == closed_mesh.STANDING.index("ground")
    # Borders: vertices of edges whose triangles belong to different faces, or to one only.
    t, face = mesh.triangles.astype(np.int64), mesh.faces
    edges = np.sort(t[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.repeat(face, 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    same = (edges[1:] == edges[:-1]).all(axis=1)
    inner = np.zeros(len(edges), bool)
    inner[1:] |= same & (owner[1:] == owner[:-1])
    inner[:-1] |= same & (owner[1:] == owner[:-1])
    border = np.unique(edges[~inner])
    far = np.flatnonzero(ground)
    reach = max(BORDER * greatest, 2 * field.spacing)
    for some in np.array_split(border, max(1, len(border) // 64)):
        centre = mesh.vertices[some]
        low, high = centre.min(axis=0) - reach, centre.max(axis=0) + reach
        near = ((mesh.vertices[far] > low) & (mesh.vertices[far] < high)).all(axis=1)
        points = mesh.vertices[far[near]]
        distance = np.full(len(points), np.inf)
        for c in centre:
            distance = np.minimum(distance, ((points - c) ** 2).sum(axis=1))
        keep = np.ones(len(far), bool)
        keep[np.flatnonzero(near)[distance < reach**2]] = False
        far = far[keep]
    return far


def ours(result, mesh):
    """(seconds, deviation at the design's samples) by rays from the design to the ground mesh."""
    start = time.perf_counter()
    job = result.job
    field = jobs.make_field(job, jobs.read_design(job["design"]), [], core.RunContext())
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


def cad_mesh(shape, path):
    """Seconds for a fine mesh of the CAD by FreeCAD, as an STL file; and its facets."""
    import MeshPart

    start = time.perf_counter()
    mesh = MeshPart.meshFromShape(
        Shape=shape, LinearDeflection=CAD_DEFLECTION, AngularDeflection=0.05, Relative=False
    )
    seconds = time.perf_counter() - start
    mesh.write(str(path))
    return seconds, mesh.CountFacets


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
    shape.importBrepFromString(jobs.read_design(result.job["design"]).write_brep())
    smooth = smooth_vertices(result, mesh)
    ground = np.flatnonzero(mesh.standing == closed_mesh.STANDING.index("ground"))
    figures = {
        "result": Path(folder).name,
        "ground_vertices": len(ground),
        "smooth_vertices": len(smooth),
        "turned_triangles": mesh.report()["flipped"],
        "ground_mesh_s": mesh_seconds,
    }
    seconds, rays = ours(result, mesh)
    inside = (np.asarray(result.field.flags) & (core.ON_BOUNDARY | core.MISSED)) == 0
    figures["ours"] = {
        **difference(rays[inside], result.field.height[inside]),
        "seconds": seconds,
        "seconds_per_million": 1e6 * seconds / len(rays),
    }
    truth = mesh.deviation.astype(float)
    with tempfile.TemporaryDirectory() as place:
        place = Path(place)
        if CLOUDCOMPARE:
            meshing, facets = cad_mesh(shape, place / "cad.stl")
            seconds, told = cloudcompare(mesh.vertices[smooth], place / "cad.stl", place)
            figures["cloudcompare"] = {
                **difference(told, truth[smooth]),
                "seconds": seconds + meshing,
                "of_which_meshing_s": meshing,
                "cad_facets": facets,
                "seconds_per_million": 1e6 * (seconds + meshing) / len(smooth),
            }
    some = np.sort(np.random.default_rng(7).permutation(smooth)[:INSPECTED])
    seconds, told = inspection(mesh.vertices[some], shape)
    told[np.abs(told) > 1e6] = np.nan  # outside of the search radius
    figures["inspection"] = {
        **difference(told, truth[some]),
        "seconds": seconds,
        "seconds_per_million": 1e6 * seconds / len(some),
    }
    base = figures["ours"]["seconds_per_million"]
    for name in ("cloudcompare", "inspection"):
        if name in figures:
            figures[name]["times_ours"] = figures[name]["seconds_per_million"] / base
    return figures


def main():
    found = [compare(folder) for folder in os.environ["BELTGRINDING_RESULT"].split(os.pathsep)]
    if not CLOUDCOMPARE:
        print("deviation/ CloudCompare is not installed (apt install cloudcompare): left out")
    for figures in found:
        for name in ("ours", "cloudcompare", "inspection"):
            if name in figures:
                f = figures[name]
                print(
                    f"deviation/{figures['result']}/{name}: {f['points']} points, "
                    f"rms {f['rms_mm']:.5f} mm, p99 {f['p99_mm']:.5f} mm, max {f['max_mm']:.4f} mm, "
                    f"{f['seconds_per_million']:.1f} s per million "
                    f"({f.get('times_ours', 1.0):.1f} times ours)"
                )
    if "BELTGRINDING_BENCH_OUT" in os.environ:
        Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(json.dumps(found, indent=1))


if "BELTGRINDING_RESULT" in os.environ:
    main()
