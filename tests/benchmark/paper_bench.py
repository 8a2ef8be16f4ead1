"""The local law against the global one on curved surfaces, as the method's paper compares them: tools/bench paper.

A wheel of 40 mm radius and 20 mm width grinds once, with 40 N at 50 mm/s, over a patch that is flat, or crowned across the pass.
Printed is the removed depth by each law in the middle of the patch, at distances from the pass's middle, um. On the flat patch
both are the same but for the contact's ends; on a crown the global law, which knows one width of contact, does not see that the
pressure falls to its sides. ``--picture FILE`` draws the profiles.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

from beltgrinding.job import load as jobs
from beltgrinding.simulation import run as runs

HALF = 20.0  # mm, of the patch
STEP = 0.5  # mm, of its mesh
CROWNS = (None, 100.0, 40.0)  # mm, radius across the pass
LAWS = {"local": "local_linear", "global": "hammann"}
AT = (0.0, 2.0, 4.0, 6.0, 8.0, 9.5)  # mm from the middle


def patch(file, crown):
    """Writes the patch as an STL file, its normals up."""
    axis = np.arange(-HALF, HALF + 0.5 * STEP, STEP)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    z = np.zeros_like(x) if crown is None else np.sqrt(crown**2 - y**2) - crown
    p = np.stack([x, y, z], axis=-1)
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    corners = np.concatenate(
        [np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))]
    )
    record = np.zeros(len(corners), dtype=[("n", "<3f4"), ("p", "<9f4"), ("a", "<u2")])
    record["p"] = corners.reshape(-1, 9)
    file.write_bytes(b" " * 80 + np.uint32(len(record)).tobytes() + record.tobytes())


def profile(crown, law, folder):
    """(distances from the middle, removed depths) of a slice across the pass, mm."""
    file = Path(folder, "patch.stl")
    patch(file, crown)
    poses = [
        {
            "x_mm": x,
            "y_mm": 0.0,
            "z_mm": 0.3,
            "qw": 0.0,
            "qx": 1.0,
            "qy": 0.0,
            "qz": 0.0,
            "feed_mm_s": 50.0,
        }
        for x in (-14.0, 14.0)
    ]
    job = jobs.validate(
        {
            "design": {"file": str(file)},
            "sampling": {"spacing_mm": 0.5},
            "stock": {"kind": "allowance", "allowance_mm": 0.3},
            "belt_machine": {
                "wheel": {"radius_mm": 40.0, "width_mm": 20.0},
                "belt_speed_m_s": 20.0,
                "force_N": 40.0,
            },
            "law": {"model": law, "coefficient_mm2_per_N": 1.5e-4},
            "programs": [{"poses": poses}],
        },
        folder,
    )
    field = runs.run(job).field
    points, height = np.asarray(field.points), np.asarray(field.height, dtype=float)
    middle = abs(points[:, 0]) < 2.0
    return points[middle, 1], 0.3 - height[middle]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--picture", metavar="FILE")
    arguments = parser.parse_args()
    print("| crown, mm | law | " + " | ".join(f"{at:g} mm" for at in AT) + " |")
    print("| --- " * (2 + len(AT)) + "|")
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for crown in CROWNS:
            for name, law in LAWS.items():
                y, depth = found[crown, name] = profile(crown, law, folder)
                told = [1e3 * depth[abs(abs(y) - at) < 0.4].mean() for at in AT]
                cells = " | ".join(f"{one:.1f}" for one in told)
                print(f"| {crown or 'flat'} | {name} | {cells} |", flush=True)
    if arguments.picture:
        draw(found, arguments.picture)


def draw(found, file):
    """The profiles side by side, a panel each crown."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(1, len(CROWNS), figsize=(9.0, 2.8), sharey=True)
    for panel, crown in zip(panels, CROWNS):
        for name, style in (("local", "-"), ("global", "--")):
            y, depth = found[crown, name]
            rows = np.unique(np.round(y, 3))
            mean = [1e3 * depth[abs(y - one) < 1e-3].mean() for one in rows]
            panel.plot(rows, mean, style, label=f"{name} law")
        panel.set_title("flat" if crown is None else f"crown {crown:g} mm")
        panel.set_xlabel("across the pass, mm")
    panels[0].set_ylabel("removed, µm")
    panels[0].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(file, dpi=110)


if __name__ == "__main__":
    main()
