"""The last half millimetre at a part's border: default cells against cells and samples of a third. Pressure at a sharp
edge is singular until the edge is worn round, which cells of 1 mm do not show."""

import numpy as np
import pytest
from support.reference_cases import slab
from test_mirror import SMALL, WIDE, pose

from beltgrinding.job import load
from beltgrinding.simulation import run as runs


def profile(places, width, wheel, force, turn, coefficient, cell, spacing, side):
    """(mm from the border (n,), mm removed (n,)) in the middle of a pass along x: from the side at +y, or the end."""
    poses = [pose(x, y, turn, 0.0) for x, y in places]
    job = {
        "design": {"brep": slab(40.0, width, 8.0), "faces": [2]},
        "sampling": {"spacing_mm": spacing},
        "stock": {"allowance_mm": 0.2},
        "belt_machine": {"wheel": wheel, "force_N": force, "contact_spacing_mm": cell},
        "law": {"coefficient_mm2_per_N": coefficient},
        "simulation": {"max_travel_mm": 0.5},
        "cell": {"check_collisions": False},
        "programs": [{"poses": poses}],
    }
    field = runs.run(load.validate(job), resume=False).field
    x, y = np.asarray(field.points, dtype=float)[:, :2].T
    away = width / 2 - y if side else 40.0 - x
    taken = (abs(x - 20.0) < 3.0) if side else (abs(y) < 1.0)
    places, which = np.unique(np.round(away[taken], 6), return_inverse=True)
    removed = (np.asarray(field.stock_height) - np.asarray(field.height))[taken]
    return places, np.bincount(which, weights=removed) / np.bincount(which)


BESIDE = (((10, 4.3), (30, 4.3)), 20.0, WIDE, 60.0)
BETWEEN = (((10, 4.7), (30, 4.7)), 20.0, WIDE, 60.0)  # the border lies elsewhere in its cell
NARROW = (((10, 0), (30, 0)), 10.0, SMALL, 30.0)
OVER = (((20, 0), (45, 0)), 10.0, SMALL, 30.0)


@pytest.mark.parametrize(
    "job, turn, coefficient, side",
    (
        (BESIDE, 0.0, 1.25e-5, True),
        (BETWEEN, 0.0, 1.25e-5, True),
        (BESIDE, 0.3, 1.25e-5, True),
        (BESIDE, 0.0, 1e-7, True),  # the edge stays sharp
        (NARROW, 0.0, 1.25e-5, True),
        (OVER, 0.0, 1.25e-5, False),
        (OVER, 0.3, 1.25e-5, False),
    ),
)
def test_the_last_half_millimetre_is_as_with_fine_cells(job, turn, coefficient, side):
    def halves(cell, spacing):
        at, removed = profile(*job, turn, coefficient, cell, spacing, side)
        return [np.interp(np.linspace(low, low + 0.5, 101), at, removed).mean() for low in (0, 0.5)]

    default, fine = halves(1.0, 0.5), halves(0.33, 0.22)
    print([f"{1000 * a:.2f} / {1000 * b:.2f} um ({a / b - 1:+.1%})" for a, b in zip(default, fine)])
    assert fine[0] > 1.1 * fine[1]
    assert default[0] == pytest.approx(fine[0], rel=0.1)
    assert default[1] == pytest.approx(fine[1], rel=0.1)
