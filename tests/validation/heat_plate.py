"""A transient case of heat by CalculiX: a band of flux on a thin plate that dwells, runs, and comes back.

    /usr/bin/python3 tests/validation/heat_plate.py

writes tests/core/heat/calculix_plate.inc, which tests/core/heat/plate_test.cpp compares the engine with, and
test_heat_plate.py with what CalculiX gives now.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

TABLE = Path(__file__).resolve().parents[1] / "core" / "heat" / "calculix_plate.inc"
LENGTH, THICKNESS, DEPTH = 60.0, 3.0, 1.0  # mm; depth: of the slice
CELL = 0.5  # mm along
LAYERS = (0.08, 0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.6)  # mm from the heated side
CONDUCTIVITY, CAPACITY, DENSITY = 16.0, 500.0, 8000.0  # W/(m K), J/(kg K), kg/m3
FLUX = 2000.0  # N/(mm s): kW/m2
BAND = 6.0  # mm
DURATION = 0.05  # s, of a step
INCREMENTS = 5


def places():
    """mm: the band's middle in every step."""
    dwell = [15.0] * 10
    there = list(np.arange(15.5, 40.01, 1.0))
    back = list(np.arange(39.5, 24.99, -1.0))
    return dwell + there + back


def deck():
    """The input of CalculiX: N, mm, s, K, t."""
    x = np.arange(0.0, LENGTH + 0.5 * CELL, CELL)
    z = -np.concatenate([[0.0], np.cumsum(LAYERS)])
    assert abs(z[-1] + THICKNESS) < 1e-9
    number = lambda i, j, k: 1 + i + len(x) * (j + 2 * k)
    lines = ["*NODE, NSET=ALL"]
    for k, at in enumerate(z):
        for j in (0, 1):
            lines += [f"{number(i, j, k)}, {x[i]:g}, {j * DEPTH:g}, {at:g}" for i in range(len(x))]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=PLATE")
    columns = len(x) - 1
    for k in range(len(z) - 1):
        for i in range(columns):
            corners = [(i, 0), (i + 1, 0), (i + 1, 1), (i, 1)]
            nodes = [number(a, b, k + 1) for a, b in corners] + [
                number(a, b, k) for a, b in corners
            ]
            lines.append(", ".join(map(str, [1 + i + columns * k, *nodes])))
    top = [number(i, 0, 0) for i in range(len(x))]
    lines.append("*NSET, NSET=TOP")
    lines += [", ".join(map(str, top[n : n + 12])) + "," for n in range(0, len(top), 12)]
    lines += ["*MATERIAL, NAME=STEEL", "*CONDUCTIVITY", f"{CONDUCTIVITY:g}", "*SPECIFIC HEAT"]
    lines += [f"{CAPACITY * 1e6:g}", "*DENSITY", f"{DENSITY * 1e-12:g}"]
    lines += ["*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL"]
    lines += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 0."]
    for middle in places():
        lines += [
            "*STEP, INC=1000",
            "*HEAT TRANSFER, DIRECT",
            f"{DURATION / INCREMENTS:g}, {DURATION:g}",
        ]
        lines.append("*DFLUX, OP=NEW")
        for i in range(columns):
            low, high = max(x[i], middle - BAND / 2), min(x[i + 1], middle + BAND / 2)
            if high > low:
                lines.append(f"{1 + i}, S2, {FLUX * (high - low) / CELL:g}")
        lines += ["*NODE PRINT, NSET=TOP, FREQUENCY=1", "NT", "*END STEP"]
    return x, "\n".join(lines) + "\n"


def solve():
    """(x (n,) mm, temperatures (increments, n) K) on the heated side. Raises CalledProcessError."""
    x, text = deck()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "plate.inp").write_text(text)
        subprocess.run(["ccx", "plate"], cwd=folder, check=True, capture_output=True)
        rows, found = [], []
        for line in (Path(folder) / "plate.dat").read_text().splitlines():
            parts = line.split()
            if line.strip().startswith("temperatures"):
                rows = []
                found.append(rows)
            elif len(parts) == 2 and found:
                rows.append(float(parts[1]))
    return x, np.array(found)


def table():
    """The text of the table: x mm, greatest rise K, rise in the end K."""
    x, found = solve()
    rows = np.column_stack([x, found.max(axis=0), found[-1]])
    lines = ["// x mm, greatest rise K, rise in the end K: by tests/validation/heat_plate.py"]
    return "\n".join(lines + [f"{{{a:.2f}, {b:.2f}, {c:.2f}}}," for a, b, c in rows]) + "\n"


if __name__ == "__main__":
    TABLE.write_text(table())
