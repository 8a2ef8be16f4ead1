"""Every contact model on every finite-element reference of a wheel, as docs/contact-accuracy.md shows it:
tools/bench contact_reference. Approach at the reference's force; in brackets L1 of the pressure on cells of
1 mm (flat, cyl), or of the forces of rows of 1 mm.
"""

import os
import re
from pathlib import Path

import numpy as np

from beltgrinding.contact import single_contact as contact

REFERENCE = Path(os.environ["BELTGRINDING_SHARED"]) / "reference"
MODELS = ("wheel_rim", "bonded_layer", "half_space", "elastic_foundation")
WHEEL = {
    "outer_radius_mm": 100,
    "width_mm": 50,
    "rim_thickness_mm": 15,
    "youngs_modulus_MPa": 5,
}
WORKPIECES = {
    "flat": {"shape": "plane"},
    "cyl": {"shape": "cylinder", "radius_mm": 50.0},
    "edgeY": {"shape": "edge"},
    "rib5": {"shape": "strip", "width_mm": 5.0, "axis_angle_deg": 90.0},
    "tilt3f": {"shape": "plane", "tilt_deg": 3.0},
}


def shares(values, weights, edges):
    """Sums of ``weights`` within ``edges``, each spread evenly over a cell round its value."""
    half = 0.5 * (values[1] - values[0])
    inside = np.minimum(values[:, None] + half, edges[1:]) - np.maximum(
        values[:, None] - half, edges[:-1]
    )
    return np.tensordot(np.clip(inside, 0, None) / (2 * half), weights, (0, 0))


def errors(shape, nu, text, model):
    """(approach, L1) of a reference's file, as shares."""
    approach = float(re.search(r"delta=([\d.]+)", text).group(1))
    force = float(re.search(r"F=([\d.]+) N", text).group(1))
    given = {"wheel": {**WHEEL, "poissons_ratio": nu}, "workpiece": WORKPIECES[shape]}
    result = contact.run(contact.validate({**given, "force_N": force, "model": model}))
    loads = result["pressure"] * result["coverage"] * result["cell_area"]
    if rows := re.search(r"row forces.*", text):
        axis = "x" if shape == "rib5" else "y"
        truth = {float(a): float(n) for a, n in re.findall(r"(-?[\d.]+):([\d.]+)", rows.group(0))}
        along = loads.sum(0 if axis == "x" else 1)
        ours = [shares(result[axis], along, np.array([a - 0.5, a + 0.5]))[0] for a in truth]
        off = np.abs(np.array(ours) - np.array(list(truth.values()))).sum()
        total = sum(truth.values())
    else:
        edges = np.arange(-60.0, 61.0)
        ours = shares(result["x"], shares(result["y"], loads, edges).T, edges).T
        ours = (ours + ours[::-1])[60:]
        ours = 0.25 * (ours + ours[:, ::-1])[:, 60:]
        truth = np.zeros_like(ours)
        for line in text.splitlines():
            if line[:1].isdigit():
                x, y, pressure = map(float, line.split(",")[:3])
                truth[int(y), int(x)] = pressure
        half = WHEEL["width_mm"] // 2  # beyond, a pressure is of a part of its cell
        ours, truth = ours[:half], truth[:half]
        off, total = np.abs(ours - truth * ours.sum() / truth.sum()).sum(), ours.sum()
    return result["approach"] / approach - 1.0, off / total


def main():
    print("| reference | " + " | ".join(MODELS) + " |")
    print("| --- |" + " --- |" * len(MODELS))
    for path in sorted(REFERENCE.glob("fem_*_nu*_neo_F*.csv")):
        shape, nu = re.match(r"fem_([^_]+)_nu([\d.]+)_", path.name).groups()
        figures = (errors(shape, float(nu), path.read_text(), model) for model in MODELS)
        cells = [f"{100 * a:+.1f} % ({100 * b:.0f} %)" for a, b in figures]
        name = path.stem.removeprefix("fem_").replace("_", " ")
        print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


main()
