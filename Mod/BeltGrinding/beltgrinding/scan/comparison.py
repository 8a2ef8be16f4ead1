"""A scan of the part as really ground: aligned with the design and compared with the prediction.

The scan is a triangle mesh (STL, PLY, OBJ, OFF, 3MF) or a point cloud (PLY, OBJ, or text of x y z in
the first three columns: XYZ, ASC, TXT, CSV, PTS). Alignment is by the extension
``beltgrinding_scan``, which is optional when the workbench is built.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.files import json_bytes
from ..base.kinds import Context, Facts, Floats, Json
from ..engine import InputError, core, library
from ..job import workpiece
from . import file as scan_file, sizes, start as scan_start, trust

if TYPE_CHECKING:
    from .file import Scan
    from .kinds import Ground, Kept, Start

FREEDOMS = ("tx", "ty", "tz", "rx", "ry", "rz")  # of the work frame; rotations about the centroid
SHARE = 0.9  # of the pairs of points, the nearest: the rest is trimmed
DATUM_SAMPLES = 60_000  # about; more do not place a part better
SIZE_SAMPLES = 5_000  # of all faces
LEAST_SHARE = 0.02  # of the part's area: less of it that is not ground is no datum
LEAST_COSINE = 0.1  # between a sample's normal and that of the scan's triangle, for a mesh
SEARCH_MARGIN = 1.0  # mm beyond the stock's greatest height
PLAIN_SD = 0.02  # mm at the part's radius: a freedom that is known worse is told


def extension() -> Any:
    """The module ``beltgrinding_scan``. Raises InputError saying what is missing."""
    try:
        return library.extension("beltgrinding_scan")
    except ImportError as error:
        raise InputError(
            "scan.no_module",
            "scans are aligned by the module beltgrinding_scan, which cannot be loaded "
            "({reason}). It is built with the workbench where nanoflann (libnanoflann-dev) "
            "is installed",
            reason=error,
        ) from None


def datum(
    result: Ground, faces: Iterable[int] | None = None, context: Context = None
) -> dict[str, Any]:
    """The surface that a scan is laid on: dict(points (n, 3), normals (n, 3), spacing, faces,
    predicted; whole (m, 3) points of all faces, or None, ground of those that are ground), mm, work frame.

    ``faces``: numbers from 1; None: all that are not ground, or, where these are hardly any, the
    ground ones at their predicted height. Ground faces that are named are taken at their predicted
    height as well.
    """
    design = result.job["design"]
    shape = workpiece.read_design(design, context)
    ground = sorted({int(face) for face in np.unique(result.field.faces)})
    if faces is None:
        others = [i for i in range(shape.face_count) if i not in set(ground)]
        areas = [shape.face_area(i) for i in range(shape.face_count)]
        enough = sum(areas[i] for i in others) > LEAST_SHARE * sum(areas)
        chosen = others if enough else ground
    else:
        chosen = sorted({int(face) - 1 for face in faces})
        for face in chosen:
            if not 0 <= face < shape.face_count:
                raise InputError(
                    "scan.no_such_datum_face",
                    "scan: there is no datum face {face}; the design has {count}",
                    face=face + 1,
                    count=shape.face_count,
                )
        if not chosen:
            raise InputError("scan.no_datum_face", "scan: no datum face is named")
    area = sum(shape.face_area(i) for i in chosen)
    spacing = max(result.field.spacing, math.sqrt(area / DATUM_SAMPLES))
    points, normals = [], []
    fixed = [face for face in chosen if face not in ground]
    if fixed:
        field, _ = core.sample_faces(shape, fixed, spacing)
        points.append(np.array(field.points))
        normals.append(np.array(field.normals, dtype=float))
    predicted = [face for face in chosen if face in ground]
    if predicted:
        field = result.field
        keep = np.isin(field.faces, predicted) & ((np.asarray(field.flags) & core.MISSED) == 0)
        upwards = np.asarray(field.normals, dtype=float)[keep]
        points.append(field.points[keep] + field.height[keep, None] * field.rays[keep])
        normals.append(upwards)
    return {
        "points": np.concatenate(points),
        "normals": np.concatenate(normals),
        "spacing": spacing,
        "whole": _whole(shape, context),
        "ground": np.array(result.field.points),
        "faces": [face + 1 for face in chosen],
        "predicted": bool(predicted),
    }


def _whole(shape: core.Shape, context: Context) -> Floats | None:
    """(n, 3) points of all faces, by which sizes are compared; None where the design cannot be sampled."""
    area = sum(shape.face_area(face) for face in range(shape.face_count))
    try:
        return np.array(
            core.sample_faces(shape, [], math.sqrt(area / SIZE_SAMPLES), context=context)[0].points
        )
    except InputError:
        return None


def align(
    scan: Scan,
    datum: Json,
    start: Start | None = None,
    fixed: Collection[str] = (),
    max_distance_mm: float | None = None,
    share: float = SHARE,
) -> dict[str, Any]:
    """Where the scan lies: dict(work_from_scan (4, 4), rms_mm, used_share, iterations, converged,
    sd (6,) mm and rad, undetermined, warnings; placements, apart_mm, apart_deg: of those that starts
    around it lead to and that fit as well; trusted: nothing speaks against it; turned: it fits only with its
    triangles turned, as ``scan.turned()`` has them).

    scan: ``scan_file.Scan``; datum: as ``datum`` gives it, or a dict of points, normals, spacing.
    start: work_from_scan (4, 4); "principal": by the principal axes of both, all their directions
    tried, for a scan of the whole part without clutter; None: as it lies. fixed: names of
    ``FREEDOMS`` that keep the start. max_distance_mm: scan points farther from the datum are not of
    it (default: a twentieth of the datum's size). Trimmed point-to-plane ICP
    (src/scan, registration.h). Raises InputError.
    """
    module = extension()
    for name in fixed:
        if name not in FREEDOMS:
            raise InputError(
                "scan.no_such_freedom",
                "scan: there is no freedom '{name}'; they are {freedoms}",
                name=name,
                freedoms=", ".join(FREEDOMS),
            )
    size = float(np.linalg.norm(np.ptp(datum["points"], axis=0)))
    reach = size / 20 if max_distance_mm is None else float(max_distance_mm)
    if not (reach > 0 and math.isfinite(reach) and 0 < share <= 1):
        raise InputError(
            "scan.distance_or_share",
            "scan: the greatest distance must be above 0 mm, the share in (0, 1]",
        )

    if isinstance(start, str) and start != "principal":
        raise InputError(
            "scan.no_such_start",
            "scan: there is no start '{start}'; give 'principal' or a matrix",
            start=start,
        )
    given = None
    if not isinstance(start, str):
        given = np.eye(4) if start is None else scan_start.rigid(start, "scan: the start")

    def registering(one: Scan) -> Callable[..., dict[str, Any]]:
        """How a Scan is registered."""
        taken, upwards = one.spread()

        def register(
            matrix: Floats,
            distance: float,
            points: int = scan_file.SPREAD,
            rounds: int = 100,
            share: float = share,
        ) -> dict[str, Any]:
            return module.register_scan(
                taken,
                upwards,
                datum["points"],
                datum["normals"],
                datum["spacing"],
                np.asarray(matrix, dtype=float),
                distance,
                share,
                [name in fixed for name in FREEDOMS],
                rounds,
                points,
            )

        return register

    def begin(one: Scan, told: Facts) -> Floats:
        """Where a Scan starts."""
        if given is not None:
            return given
        taken, _ = one.spread()
        return scan_start.by_principal_axes(taken, datum, registering(one), size, told)

    def fitted(one: Scan) -> dict[str, Any] | None:
        """About how a Scan fits; None where nothing of it is near."""
        try:
            return registering(one)(begin(one, []), reach, trust.POINTS, trust.ROUNDS)
        except InputError:
            return None

    warnings = [*scan.warnings, *sizes.check(scan, datum, fitted)]
    odd = len(warnings) > len(scan.warnings)
    turned = sizes.is_turned(scan, fitted)
    if turned:
        scan = scan.turned()
        warnings.append(
            core.Fact(
                "scan.turned",
                "the scan's triangles look into the part: they are taken the other way round",
            )
        )
    register = registering(scan)
    found = register(begin(scan, warnings), reach)
    motions = [scan_start.motion_words(one) for one in found["undetermined"]]
    radius = float(np.sqrt(((datum["points"] - found["centre"]) ** 2).sum(axis=1).mean()))
    if motions:
        free = motions[0]
        for motion in motions[1:]:
            free = core.Fact("scan.motions", "{one}; {other}", one=free, other=motion)
        warnings.append(
            core.Fact(
                "scan.free_to_move",
                "the datum leaves the scan free to move: {motions}. It stays there as it started; add "
                "datum faces that look another way",
                motions=free,
            )
        )
    around = trust.look_around(
        found,
        lambda matrix, points, rounds: register(matrix, reach, points, rounds),
        datum,
        [bool(motions) or name in fixed for name in FREEDOMS],  # what slides has been told
    )
    warnings += around["warnings"]
    sd = [max(value, around["sd"].get(k, 0.0)) for k, value in enumerate(found["sd"])]
    scale = np.array([1, 1, 1, radius, radius, radius])
    if not motions and not around["warnings"] and np.max(np.array(sd) * scale) > PLAIN_SD:
        worst = int(np.argmax(np.array(sd) * scale))
        warnings.append(
            core.Fact(
                "scan.hardly_determined",
                "the datum hardly determines {freedom}: see sd",
                freedom=FREEDOMS[worst],
            )
        )
    if not found["converged"]:
        warnings.append(
            core.Fact(
                "scan.not_settled",
                "the alignment has not settled after {count} iterations",
                count=found["iterations"],
            )
        )
    return {
        "work_from_scan": np.asarray(found["work_from_scan"]),
        "rms_mm": found["rms"],
        "cut_off_mm": found["distance"],
        "used_points": found["used"],
        "used_share": found["used_share"],
        "iterations": found["iterations"],
        "converged": found["converged"],
        "sd": dict(zip(FREEDOMS, (float(value) for value in sd))),
        "placements": around["placements"],
        "apart_mm": around["apart_mm"],
        "apart_deg": around["apart_deg"],
        "trusted": bool(found["converged"]) and not (motions or around["warnings"] or odd),
        "turned": turned,
        "undetermined": motions,
        "warnings": warnings,
    }


def measure(
    field: core.HeightField, scan: Scan, work_from_scan: Floats, search_mm: float | None = None
) -> Floats:
    """(n,) height of the scan over each sample of a core.HeightField, mm along its normal; NaN where
    the scan has nothing within ``search_mm`` of the design (default: the greatest height and stock,
    and 1 mm). A mesh is met by the normal's ray (not where it only grazes the part's next face), a cloud
    by the plane of the nearest points.
    """
    if search_mm is None:
        greatest = max(np.abs(field.height).max(), np.abs(field.stock_height).max())
        search_mm = float(greatest) + SEARCH_MARGIN
    if not (search_mm > 0 and math.isfinite(search_mm)):
        raise InputError("scan.search", "scan: the search distance must be above 0 mm")
    moved = scan_start.moved(scan.points, work_from_scan)
    if scan.triangles is None:
        return np.asarray(
            extension().measure_cloud(
                moved, field.points, field.rays, np.asarray(field.height), search_mm
            )
        )
    target = field.copy()
    core.apply_mesh(
        target,
        core.TriangleMesh(moved.astype(np.float32), scan.triangles),
        search_mm,
        search_mm,
        least_cosine=LEAST_COSINE,
    )
    missed = (np.asarray(target.flags) & core.MISSED) != 0
    return np.where(missed, math.nan, target.height)


def statistics(
    field: core.HeightField, measured: Floats, tolerance: Sequence[float]
) -> dict[str, Any]:
    """Area-weighted figures of a measurement and of its difference from the prediction, mm."""
    known = np.isfinite(measured) & ((np.asarray(field.flags) & core.MISSED) == 0)
    if not known.any():
        raise InputError(
            "scan.nothing_measured", "scan: no sample has both a measured and a predicted height"
        )
    area = np.asarray(field.areas, dtype=float)
    weight = area[known] / area[known].sum()
    lower, upper = tolerance

    def figures(values: Floats) -> dict[str, float]:
        order = np.argsort(values)
        share = np.cumsum(weight[order])
        mean = float(weight @ values)
        told = {
            "min": float(values.min()),
            "max": float(values.max()),
            "mean": mean,
            "rms": math.sqrt(float(weight @ values**2)),
            "sd": math.sqrt(max(0.0, float(weight @ (values - mean) ** 2))),
        }
        for name, part in (("p05", 0.05), ("p50", 0.5), ("p95", 0.95)):
            told[name] = float(
                values[order][min(int(np.searchsorted(share, part)), len(order) - 1)]
            )
        return told

    found = measured[known]
    predicted = np.asarray(field.height)[known]
    good = (found >= lower) & (found <= upper)
    said = (predicted >= lower) & (predicted <= upper)
    return {
        "measured_area_share": float(area[known].sum() / area.sum()),
        "measured_mm": figures(found),
        "difference_mm": figures(found - predicted),
        "in_tolerance_area_share": float(weight[good].sum()),
        "predicted_in_tolerance_area_share": float(weight[said].sum()),
        "same_verdict_area_share": float(weight[good == said].sum()),
    }


def compare(
    result: Ground,
    path: Path | str,
    unit_mm: float = 1.0,
    start: Start | None = None,
    pairs: ArrayLike | None = None,
    datum_faces: Iterable[int] | None = None,
    fixed: Collection[str] = (),
    max_distance_mm: float | None = None,
    share: float = SHARE,
    search_mm: float | None = None,
    aligned: bool = False,
    context: Context = None,
) -> dict[str, Any]:
    """Reads a scan's file, aligns it (``aligned``: it lies where the design does already), measures
    it at each sample and puts the heights into ``result.field.measured``.

    pairs: (k, 2, 3) of a place on the scan (its unit) and the same place on the design (mm), in
    place of ``start``. Returns the figures that ``write`` keeps. Raises InputError, and Cancelled
    while the design is read; the result is then as it was.
    """
    scan = scan_file.read(path, unit_mm)
    figures: dict[str, Any] = {
        "file": str(path),
        "unit_mm": float(scan.unit_mm),
        "points": len(scan.points),
    }
    figures["kind"] = "cloud" if scan.triangles is None else "mesh"
    if aligned:
        matrix, found = np.eye(4), None
    else:
        surface = datum(result, datum_faces, context)
        if pairs is not None:
            if start is not None:
                raise InputError(
                    "scan.pairs_and_start", "scan: give pairs of points or a start, not both"
                )
            start, figures["pairs_rms_mm"] = scan_start.by_pairs(pairs, scan.unit_mm)
        found = align(scan, surface, start, fixed, max_distance_mm, share)
        matrix = found["work_from_scan"]
        scan = scan.turned() if found["turned"] else scan
        figures["datum_faces"] = face_runs(surface["faces"])
        figures["datum_predicted"] = surface["predicted"]
    measured = measure(result.field, scan, matrix, search_mm)
    tolerance = result.job["inspection"]["tolerance_mm"]
    figures.update(statistics(result.field, measured, tolerance))
    figures["alignment"] = None if found is None else _plain(found)
    figures["warnings"] = scan.warnings if found is None else found["warnings"]
    if found is not None:
        poor = trust.poor_fit(found["rms_mm"], tolerance)
        figures["warnings"] = poor + figures["warnings"]
        figures["alignment"]["trusted"] = found["trusted"] and not poor
    result.field.set_measured(measured)
    return figures


def face_runs(numbers: Iterable[int]) -> list[int | list[int]]:
    """[1, [3, 7]] of [1, 3, 4, 5, 6, 7]: a facetted part has thousands."""
    runs: list[list[int]] = []
    for number in sorted(numbers):
        if runs and runs[-1][1] == number - 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return [first if first == last else [first, last] for first, last in runs]


def write(result: Kept, figures: Json) -> None:
    """Keeps a comparison in the folder that the result was read from: heightfield.h5 (``measured_mm``)
    and scan.json, both or none. Raises InputError.
    """
    run = {key: result.summary[key] for key in ("run_id",) if key in result.summary}
    result.update(measured=True, others={"scan.json": json_bytes({**figures, **run})})


def _plain(found: Json) -> dict[str, Any]:
    """An alignment as JSON has it: infinite standard deviations are None."""
    plain = {name: value for name, value in found.items() if name != "warnings"}
    plain["work_from_scan"] = found["work_from_scan"].tolist()
    plain["sd"] = {
        name: value if math.isfinite(value) else None for name, value in found["sd"].items()
    }
    return plain
