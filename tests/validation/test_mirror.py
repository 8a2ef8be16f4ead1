"""A mirrored job grinds the mirrored part: at every sample, borders and corners too."""

import numpy as np
import pytest
from support.reference_cases import slab

from beltgrinding.job import load
from beltgrinding.simulation import run as runs

SMALL = {"radius_mm": 20, "width_mm": 15, "crown_radius_mm": 60}
WIDE = {"radius_mm": 75, "width_mm": 25}
# Slab's width, wheel, force, ends of the pass (x, y), turn about the normal and tilt about the feed (rad), spacing.
PASSES = {
    "beside its side": (20.0, WIDE, 60.0, ((-5, 4.3), (45, 4.3)), 0.0, 0.0, 0.5),
    "askew over its end": (12.0, SMALL, 30.0, ((5, 0.1), (45, 0.1)), 0.5, 0.0, 0.5),
    "tilted": (20.0, WIDE, 60.0, ((5, 2.0), (35, 2.5)), 0.0, 0.03, 0.5),
    "askew over its corners": (20.3, WIDE, 60.0, ((-5, 4.3), (45, 4.3)), 0.1, 0.0, 0.37),
}


def pose(x, y, turn, tilt):
    """A pose that looks down, turned by ``turn`` about z and tilted by ``tilt`` about the feed, rad."""
    flat, round_z = 0.5 * (np.pi + tilt), 0.5 * turn
    parts = np.cos(flat) * np.cos(round_z), np.sin(flat) * np.cos(round_z)
    parts += np.sin(flat) * np.sin(round_z), np.cos(flat) * np.sin(round_z)
    turned = dict(zip(("qw", "qx", "qy", "qz"), map(float, parts)))
    return {"x_mm": x, "y_mm": y, "z_mm": 0.2, "feed_mm_s": 20.0, **turned}


def ground(name, side):
    width, wheel, force, ends, turn, tilt, spacing = PASSES[name]
    poses = [pose(x, side * y, side * turn, side * tilt) for x, y in ends]
    job = {
        "design": {"brep": slab(40.0, width, 8.0), "faces": [2]},
        "sampling": {"spacing_mm": spacing},
        "stock": {"allowance_mm": 0.2},
        "belt_machine": {"wheel": wheel, "force_N": force},
        "law": {"coefficient_mm2_per_N": 1e-5},
        "cell": {"check_collisions": False},
        "programs": [{"poses": poses}],
    }
    return runs.run(load.validate(job), resume=False).field


@pytest.mark.parametrize("name", PASSES)
def test_a_mirrored_job_grinds_the_mirrored_part(name):
    one, other = ground(name, 1), ground(name, -1)
    points, mirrored = np.round(one.points, 6) + 0.0, np.round(other.points * [1, -1, 1], 6) + 0.0
    first, second = np.lexsort(points.T), np.lexsort(mirrored.T)
    np.testing.assert_array_equal(points[first], mirrored[second])
    height = np.asarray(one.height)[first]
    assert height.min() < 0.16  # it grinds
    # To 1e-6; shares of samples in cells are of single precision.
    assert np.abs(height - np.asarray(other.height)[second]).max() < 1.5e-6
