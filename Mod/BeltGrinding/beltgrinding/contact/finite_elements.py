"""A contact solved again by finite elements: CalculiX, to lay beside the simulator's own solution.

The rim around the contact, neo-Hookean with large displacements, is meshed with linear bricks with
incompatible modes (C3D8I), its surface nodes on the corners of the contact's cells; each has a gap
element (GAPUNI) to a rigid, frictionless workpiece at the contact's own gap. The wheel stands where
the contact has it; the force and the pressure are the answer.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..engine import InputError

MARGIN = 1.5  # rim thicknesses meshed beyond the contact's grid
GROWTH = 1.35  # of the elements away from the contact
PENALTY = 1e4  # N/mm per mm2 of a node: below 0.1 um of penetration at 1 MPa
TIME_LIMIT = 3600  # s

Index: TypeAlias = Any  # int, or an array of such


def solve(contact: Json, rim: Json, keep: Path | str | None = None) -> dict[str, Any]:
    """Solves ``contact`` (as ``contact.run`` gives it) again; ``rim``: dict(radius, thickness,
    youngs_modulus, poissons_ratio), mm and MPa. ``keep``: a folder for the deck and its results.

    Returns dict(force N, pressure (ny, nx) MPa, corner_pressure (ny + 1, nx + 1), nodes, time s).
    Raises InputError if CalculiX is not installed or does not converge.
    """
    beside = contact.get("rows_beside", 0)
    contact = _undeformed(contact)
    program = shutil.which("ccx")
    if program is None:
        raise InputError(
            "contact.no_calculix",
            "CalculiX (ccx) is not installed; Debian's package is calculix-ccx",
        )
    with tempfile.TemporaryDirectory(prefix="beltgrinding-") as scratch:
        folder = Path(keep or scratch)
        folder.mkdir(parents=True, exist_ok=True)
        mesh = _Mesh(contact, rim)
        (folder / "contact.inp").write_text(_deck(mesh, contact, rim))
        start = time.perf_counter()
        try:
            done = subprocess.run(
                [program, "contact"],
                cwd=folder,
                capture_output=True,
                text=True,
                errors="replace",
                timeout=TIME_LIMIT,
            )
        except subprocess.TimeoutExpired:
            raise InputError(
                "contact.calculix_too_slow",
                "CalculiX took more than {limit} s; use coarser cells",
                limit=TIME_LIMIT,
            ) from None
        seconds = time.perf_counter() - start
        forces = _read_forces(folder / "contact.dat", mesh)
        if forces is None:
            tail = " ".join(done.stdout.split()[-30:])
            raise InputError(
                "contact.calculix_failed",
                "CalculiX did not solve the contact: {reason}",
                reason=tail,
            )
    corners = forces / mesh.areas
    return {
        "force": float(forces.sum()),
        "pressure": np.pad(_cells(corners), ((beside, beside), (0, 0))),
        "corner_pressure": corners,
        "nodes": int(mesh.points.shape[0]),
        "time": seconds,
    }


def compare(contact: Json, reference: Json) -> dict[str, Any]:
    """Figures of the difference: force at the same approach; pressure at the same force (L1), on the
    corners of the cells, where the finite elements have their nodes. Both on the undeformed wheel.
    """
    contact = _undeformed(contact)
    ours = _cells(np.pad(contact["coverage"] * contact["pressure"], 1))
    theirs = reference["corner_pressure"] * _cells(np.pad(np.ones_like(contact["pressure"]), 1))
    scaled = theirs * ours.sum() / max(theirs.sum(), 1e-300)
    return {
        "reference_force_N": reference["force"],
        "force_difference": contact["force"] / reference["force"] - 1.0,
        "pressure_difference_L1": float(np.abs(ours - scaled).sum() / ours.sum()),
        "reference_nodes": reference["nodes"],
        "reference_time_s": reference["time"],
    }


def _undeformed(contact: Json) -> dict[str, Any]:
    """The contact on the cells of the undeformed wheel."""
    return {**contact, **contact.get("undeformed", {})}


def _graded(first: float, length: float) -> Floats:
    """Places from 0 to ``length``, steps growing from ``first``."""
    steps = [first]
    while sum(steps) < length:
        steps.append(steps[-1] * GROWTH)
    places = np.concatenate([[0.0], np.cumsum(steps)])
    return places * length / places[-1]


class _Mesh:
    """Nodes on lines in arc length, axis and radius; node (i, j, l) has the number
    (l * ny + j) * nx + i + 1, l = 0 on the surface."""

    def __init__(self, contact: Json, rim: Json) -> None:
        x, y = contact["x"], contact["y"]
        ds, dy = x[1] - x[0], (y[1] - y[0] if len(y) > 1 else contact["cell_area"] / (x[1] - x[0]))
        inside = np.concatenate([x - 0.5 * ds, [x[-1] + 0.5 * ds]])
        outside = _graded(ds * GROWTH, MARGIN * rim["thickness"])[1:]
        self.s = np.concatenate([inside[0] - outside[::-1], inside, inside[-1] + outside])
        self.y = np.concatenate([y - 0.5 * dy, [y[-1] + 0.5 * dy]])
        self.depth = _graded(min(ds, dy), rim["thickness"])
        self.first = len(outside)  # of the nodes on the contact's grid
        self.shape = (len(x) + 1, len(y) + 1)
        angle, radius = self.s / rim["radius"], rim["radius"] - self.depth
        r, j, t = np.meshgrid(radius, self.y, angle, indexing="ij")
        self.points = np.stack([r * np.sin(t), j, r * np.cos(t)], axis=-1).reshape(-1, 3)
        weights = [np.full(n, step) for n, step in zip(self.shape, (ds, dy))]
        for weight in weights:
            weight[[0, -1]] *= 0.5
        self.areas = np.outer(weights[1], weights[0])  # (y, s), mm2
        self.normals = np.stack([np.sin(angle), 0.0 * angle, np.cos(angle)], axis=-1)

    def node(self, i: Index, j: Index, layer: Index) -> Index:
        return (layer * len(self.y) + j) * len(self.s) + i + 1

    def bricks(self) -> Array:
        """(n, 8) node numbers."""
        i, j, l = np.meshgrid(
            np.arange(len(self.s) - 1),
            np.arange(len(self.y) - 1),
            np.arange(len(self.depth) - 1),
            indexing="ij",
        )
        i, j, l = i.ravel(), j.ravel(), l.ravel()
        low = [
            self.node(i, j, l + 1),
            self.node(i + 1, j, l + 1),
            self.node(i + 1, j + 1, l + 1),
            self.node(i, j + 1, l + 1),
        ]
        high = [
            self.node(i, j, l),
            self.node(i + 1, j, l),
            self.node(i + 1, j + 1, l),
            self.node(i, j + 1, l),
        ]
        return np.stack([*low, *high], axis=1)


def _corner_gaps(contact: Json) -> Floats:
    """Gap at the corners of the cells: the mean of the cells around that the workpiece covers."""
    gap = np.where(contact["coverage"] > 0, contact["gap"], np.inf)
    known = np.isfinite(gap)
    padded = np.pad(np.where(known, gap, 0.0), 1)
    count = np.pad(known.astype(float), 1)

    def around(a: Floats) -> Floats:
        return a[:-1, :-1] + a[1:, :-1] + a[:-1, 1:] + a[1:, 1:]

    total = around(count)
    return np.where(total > 0, around(padded) / np.maximum(total, 1), np.inf)


def _cells(corners: Floats) -> Floats:
    return 0.25 * (corners[:-1, :-1] + corners[1:, :-1] + corners[:-1, 1:] + corners[1:, 1:])


def _deck(mesh: _Mesh, contact: Json, rim: Json) -> str:
    nu = rim["poissons_ratio"]
    gaps = _corner_gaps(contact)
    lines = ["*NODE, NSET=RIM"]
    lines += [f"{n},{x:.9g},{y:.9g},{z:.9g}" for n, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
    lines.append("*ELEMENT, TYPE=C3D8I, ELSET=RUBBER")
    bricks = mesh.bricks()
    lines += [f"{e},{','.join(map(str, row))}" for e, row in enumerate(bricks.tolist(), 1)]
    count, element = len(mesh.points), len(bricks)
    grounds: list[str] = []
    gap_cards: list[str] = []
    boundary: list[str] = []
    for j in range(mesh.shape[1]):
        for i in range(mesh.shape[0]):
            number = j * mesh.shape[0] + i
            ground = count + number + 1
            rubber = mesh.node(mesh.first + i, j, 0)
            point, normal = mesh.points[rubber - 1], mesh.normals[mesh.first + i]
            clearance = gaps[j, i] if np.isfinite(gaps[j, i]) else 1e3
            grounds.append(f"{ground},{','.join(f'{v:.9g}' for v in point + normal)}")
            name = f"G{number}"
            gap_cards += [
                f"*ELEMENT, TYPE=GAPUNI, ELSET={name}",
                f"{element + number + 1},{rubber},{ground}",
                f"*GAP, ELSET={name}",
                f"{clearance:.9g},{','.join(f'{v:.9g}' for v in normal)},,"
                f"{PENALTY * mesh.areas[j, i]:.6g},1e-6",
            ]
            # The wheel is pressed on the workpiece by moving the workpiece towards the wheel.
            way = -contact["beyond_placed"] * normal
            boundary += [f"{ground},{k + 1},{k + 1},{way[k]:.9g}" for k in range(3)]
    lines += ["*NODE, NSET=GROUND", *grounds, *gap_cards]
    core = [
        mesh.node(i, j, len(mesh.depth) - 1) for j in range(len(mesh.y)) for i in range(len(mesh.s))
    ]
    ends = [
        mesh.node(i, j, l)
        for i in (0, len(mesh.s) - 1)
        for j in range(len(mesh.y))
        for l in range(len(mesh.depth) - 1)
    ]
    lines += ["*NSET, NSET=HELD", *(f"{n}," for n in core + ends)]
    lines += [
        "*MATERIAL, NAME=RUBBER",
        "*HYPERELASTIC, NEO HOOKE",
        f"{rim['youngs_modulus'] / (4 * (1 + nu)):.9g},{6 * (1 - 2 * nu) / rim['youngs_modulus']:.9g}",
        "*SOLID SECTION, ELSET=RUBBER, MATERIAL=RUBBER",
        "*STEP, NLGEOM, INC=200",
        "*STATIC",
        "1.,1.",
        "*BOUNDARY",
        "HELD,1,3",
        *boundary,
        "*NODE PRINT, NSET=GROUND",
        "RF",
        "*END STEP",
        "",
    ]
    return "\n".join(lines)


def _read_forces(path: Path, mesh: _Mesh) -> Floats | None:
    """Pressing force of every surface node, (y, s), N, at the end of the step; None if it was not
    reached. CalculiX prints every increment that it took.
    """
    count, forces, numbers, at = len(mesh.points), np.zeros(mesh.shape[::-1]), 0, 0.0
    if not path.is_file():
        return None
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if "time" in words:
            numbers, at = 0, float(words[-1])
        if len(words) != 4 or not words[0].isdigit():
            continue
        number = int(words[0]) - count - 1
        j, i = divmod(number, mesh.shape[0])
        forces[j, i] = -np.dot(list(map(float, words[1:])), mesh.normals[mesh.first + i])
        numbers += 1
    return forces if numbers == forces.size and at > 0.999 else None
