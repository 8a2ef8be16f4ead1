"""The law's coefficient from a scan of the ground part and a simulation of its job."""

from __future__ import annotations

import contextlib
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.kinds import Array, Floats
from ..engine import InputError, core
from ..job import sizes, workpiece
from ..simulation.result import Result
from .learning import refuse_stages

CAUCHY = 2.385  # 95 % efficient under normal scatter
ITERATIONS = 100
LEAST_SAMPLES = 10
LEAST_DEPTH = 0.05  # of the greatest: samples ground less say nothing of the coefficient


def calibrate_from_scan(
    measured_deviation: Floats,
    simulated_deviation: Floats,
    removed: Floats,
    coefficient: float,
    points: Floats | None = None,
    block_mm: float = 10.0,
    offset: bool = False,
) -> dict[str, Any]:
    """The coefficient with which the simulated job would have given the measured surface.

    measured_deviation, simulated_deviation (n,): mm above the design, nan where there is no scan
    (of the scan: core.apply_mesh on a fresh field); removed (n,): depth in mm that the simulation
    took off with ``coefficient`` (mm2/N). Depth is proportional to the coefficient under a given
    force, so that (simulated + removed - measured) = scale removed - offset; a Cauchy-weighted
    regression finds the scale, and with ``offset`` by how many mm the scan lies too high on the
    whole part. Neighbouring samples err together: the interval is that of whole blocks of
    ``block_mm`` of ``points`` (n, 3), mm (without points: of runs of samples), Student's t by a cluster-robust
    sandwich (Liang and Zeger, Biometrika 73, 1986). Where the scale is far from 1, simulate with
    the new coefficient and repeat. Returns dict(coefficient, interval (2,) of 95 %, scale,
    ln_scale, ln_deviation, freedom (of Student's t, whose scale that is), offset_mm, offset_interval_mm, scatter_mm, samples). Raises InputError.
    """
    measured, simulated, removed = (
        np.asarray(values, dtype=float).ravel()
        for values in (measured_deviation, simulated_deviation, removed)
    )
    if not measured.size == simulated.size == removed.size:
        raise InputError(
            "calibration.scan_lengths",
            "scan: measured, simulated and removed are of different samples",
        )
    if not (math.isfinite(coefficient) and coefficient > 0):
        raise InputError(
            "calibration.scan_coefficient",
            "scan: the simulation's coefficient must be positive",
        )
    good = np.isfinite(measured) & np.isfinite(simulated) & np.isfinite(removed)
    ground = good & (removed > LEAST_DEPTH * np.max(removed, where=good, initial=0.0))
    if ground.sum() < LEAST_SAMPLES:
        raise InputError(
            "calibration.scan_too_few",
            "scan: {count} samples are both ground and scanned; at least {least} are needed. "
            "Do scan, design and job lie in the same place?",
            count=int(ground.sum()),
            least=LEAST_SAMPLES,
        )
    used = good if offset else ground
    blocks = _blocks(points, used, block_mm)
    depth = (simulated + removed - measured)[used]
    columns = [removed[used]] + ([-np.ones(used.sum())] if offset else [])
    design = np.column_stack(columns)
    found, scatter, weights = _robust(design, depth)
    residual = depth - design @ found
    inverse = np.linalg.pinv(design.T @ (design * _curvature(residual, scatter)[:, None]))
    scores = np.zeros((blocks.max() + 1, design.shape[1]))
    np.add.at(scores, blocks, design * (weights * residual)[:, None])
    count = max(len(scores), 2)
    covariance = count / (count - 1) * inverse @ scores.T @ scores @ inverse
    scale = float(found[0])
    if scale <= 0:
        raise InputError(
            "calibration.scan_without_removal",
            "scan: where the simulation grinds, the scan shows no removal; look at its place "
            "and at the stock",
        )
    error = math.sqrt(covariance[0, 0]) / scale
    shift = float(found[1]) if offset else 0.0
    freedom = max(count - design.shape[1], 1)
    quantile = float(core.student_quantile(0.975, freedom))
    half = quantile * math.sqrt(covariance[1, 1]) if offset else 0.0
    return {
        "coefficient": coefficient * scale,
        "interval": [coefficient * scale * math.exp(f * quantile * error) for f in (-1.0, 1.0)],
        "scale": scale,
        "ln_scale": math.log(scale),
        "ln_deviation": error,
        "freedom": freedom,
        "offset_mm": shift,
        "offset_interval_mm": [shift - half, shift + half],
        "scatter_mm": float(scatter),
        "samples": int(used.sum()),
    }


def measured_heights(
    result: Result,
    scan: Path | str | None = None,
    unit_mm: float = 1.0,
    placement: ArrayLike | None = None,
) -> Floats:
    """(samples,) mm above the design of a ``Result``, as ``from_files`` takes them; NaN where there are none. Raises
    InputError."""
    field = result.field
    unmeasured = (np.asarray(field.flags) & core.MISSED) != 0
    if scan is None:
        if not len(field.measured):
            raise InputError(
                "calibration.no_measured_heights",
                "the result has no measured heights: give a scan that lies where the design "
                "does, or align one first by 'beltgrind scan'",
            )
        measured = np.array(field.measured, dtype=float)
    else:
        scanned = field.copy()
        stock = result.job["stock"]
        report, design = {}, None
        placement = np.eye(4) if placement is None else placement
        mesh = core.read_mesh(str(scan), unit_mm, placement, report=report)
        with contextlib.suppress(InputError):  # a design that is there no more
            design = workpiece.read_design(result.job["design"])
        if design is not None:
            sizes.check_box(mesh.vertices, design, report["unit_mm"], stock["search_above_mm"])
        core.apply_mesh(scanned, mesh, stock["search_above_mm"], stock["search_below_mm"])
        unmeasured |= (np.asarray(scanned.flags) & core.MISSED) != 0
        measured = np.array(scanned.height)
    measured[unmeasured] = math.nan
    return measured


def from_files(
    result: Path | str,
    scan: Path | str | None = None,
    unit_mm: float = 1.0,
    placement: ArrayLike | None = None,
    offset: bool = False,
) -> tuple[dict[str, Any], dict[str, Any]]:
    """``calibrate_from_scan`` for a result's folder (as ``beltgrind run`` writes it) and a scan of the
    ground part, a mesh's file in the job's coordinates; ``unit_mm``: mm of the file's 1; placement:
    where the mesh lies, a 4 x 4 matrix. Without a scan: the one that was aligned and measured for
    the result (``scan.compare``, ``beltgrind scan``). Returns (law with the new coefficient, figures). Raises
    InputError.
    """
    result = Result.read(result)
    field, law = result.field, result.job["law"]
    refuse_stages(result.job)
    measured = measured_heights(result, scan, unit_mm, placement)
    removed = np.asarray(field.stock_height, dtype=float) - field.height
    figures = calibrate_from_scan(
        measured,
        field.height,
        removed,
        law["coefficient_mm2_per_N"],
        field.points,
        offset=offset,
    )
    law = {
        **law,
        "coefficient_mm2_per_N": figures["coefficient"],
        "calibration": {
            "parameters": ["coefficient"],
            "covariance": [[figures["ln_deviation"] ** 2]],
            "scatter": 0.0,
            "freedom": figures["freedom"],
        },
    }
    return law, figures


def _blocks(points: Floats, used: Array, size: float) -> Array:
    """Number of the block of each used sample."""
    count = int(used.sum())
    if points is None:
        return np.arange(count) // max(1, math.isqrt(count))
    places = np.asarray(points, dtype=float)
    if places.shape != (used.size, 3) or not size > 0:
        raise InputError(
            "calibration.scan_points",
            "scan: points must be (n, 3) mm, and the blocks' size positive",
        )
    cells = np.floor(np.nan_to_num(places[used]) / size)
    return np.unique(cells, axis=0, return_inverse=True)[1].ravel()


def _robust(design: Floats, depth: Floats) -> tuple[Floats, float, Floats]:
    """(parameters, scatter, weights) by iteratively reweighted least squares, from the median."""
    found = np.zeros(design.shape[1])
    steep = design[:, 0] > LEAST_DEPTH * design[:, 0].max()
    found[0] = np.median(depth[steep] / design[steep, 0])
    weights = np.ones(len(depth))
    for _ in range(ITERATIONS):
        residual = depth - design @ found
        scatter = max(1.4826 * float(np.median(np.abs(residual))), 1e-9)
        weights = 1.0 / (1.0 + (residual / (CAUCHY * scatter)) ** 2)
        root = np.sqrt(weights)
        before = found
        found = np.linalg.lstsq(design * root[:, None], depth * root, rcond=None)[0]
        if np.abs(found - before).max() < 1e-10 * np.abs(found).max():
            break
    return found, scatter, weights


def _curvature(residual: Floats, scatter: float) -> Floats:
    """Of Cauchy's loss; the sum over the samples is positive where the fit is a minimum."""
    square = (residual / (CAUCHY * scatter)) ** 2
    return (1.0 - square) / (1.0 + square) ** 2
