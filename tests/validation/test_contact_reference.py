"""The wheel's rim against finite elements (CalculiX, neo-Hookean, large displacements)."""

import re

import numpy as np
import pytest
from support.freecad import SHARED

from beltgrinding.contact import single_contact as contact
from beltgrinding.presets import rubber

REFERENCE = SHARED / "reference"
WIDTH = 50  # mm
# File, error allowed of the approach, of the pressure field (L1 at equal force). On the plane at
# 50 N the contact ends after 4.2 mm; the reference has pressure up to 5 mm, by interpolation.
CASES = (
    ("fem_cyl_nu0.45_neo_F49.9.csv", 0.03, 0.04),
    ("fem_cyl_nu0.45_neo_F102.2.csv", 0.03, 0.04),
    ("fem_flat_nu0.45_neo_F50.6.csv", 0.03, 0.05),
    ("fem_flat_nu0.45_neo_F101.1.csv", 0.03, 0.04),
    ("fem_cyl_nu0.49_lin_F99.6.csv", 0.03, 0.04),
    ("fem_flat_nu0.49_lin_F98.8.csv", 0.03, 0.04),
)


def read(path):
    """(approach mm, force N, pressure MPa on 1 mm cells of a quarter, [y, x])."""
    head, *lines = [line for line in path.read_text().splitlines() if line]
    approach = float(re.search(r"delta=([\d.]+)", lines[0]).group(1))
    force = float(re.search(r"F=([\d.]+) N", lines[0]).group(1))
    field = np.zeros((WIDTH // 2, 60))
    for line in lines:
        if line[0].isdigit():
            x, y, pressure = map(float, line.split(",")[:3])
            if y < WIDTH / 2:  # the rubber that bulges beyond the wheel is not on our grid
                field[int(y), int(x)] = pressure
    return approach, force, field


def solve(shape, nu, force, model="wheel_rim"):
    workpiece = {"shape": "plane"}
    if shape == "cyl":
        workpiece = {"shape": "cylinder", "radius_mm": 50.0}
    wheel = {"outer_radius_mm": 100, "width_mm": WIDTH, "rim_thickness_mm": 15}
    wheel.update(youngs_modulus_MPa=5, poissons_ratio=nu)
    job = {"wheel": wheel, "workpiece": workpiece, "force_N": force, "model": model}
    return contact.run(contact.validate(job))


def quarter(result):
    """Means over 1 mm cells of the quarter, MPa."""
    x, y = np.meshgrid(np.abs(result["x"]), np.abs(result["y"]))
    forces, _, _ = np.histogram2d(
        y.ravel(),
        x.ravel(),
        bins=[np.arange(WIDTH // 2 + 1), np.arange(61)],
        weights=result["pressure"].ravel() * result["cell_area"],
    )
    return forces / 4.0


@pytest.mark.skipif(not REFERENCE.is_dir(), reason=f"no reference at {REFERENCE}")
@pytest.mark.parametrize("name, approach_error, field_error", CASES)
def test_wheel_rim_against_finite_elements(name, approach_error, field_error):
    shape, nu = re.match(r"fem_(\w+)_nu([\d.]+)_", name).groups()
    approach, force, truth = read(REFERENCE / name)
    result = solve(shape, float(nu), force)
    assert result["converged"]
    assert result["approach"] == pytest.approx(approach, rel=approach_error)
    ours = quarter(result)
    error = np.abs(ours - truth * ours.sum() / truth.sum()).sum() / ours.sum()
    assert error < field_error


@pytest.mark.skipif(not REFERENCE.is_dir(), reason=f"no reference at {REFERENCE}")
def test_the_other_models_are_as_wrong_as_the_literature_says():
    """Should one of them come near the truth on a flat part, the test above has lost its meaning."""
    approach, force, truth = read(REFERENCE / "fem_flat_nu0.45_neo_F101.1.csv")
    for model in ("half_space", "bonded_layer"):
        result = solve("flat", 0.45, force, model)
        assert abs(result["approach"] / approach - 1.0) > 0.1
    foundation = solve("flat", 0.45, force, "elastic_foundation")
    rim = solve("flat", 0.45, force)
    assert foundation["approach"] == pytest.approx(rim["approach"], rel=0.02)


def test_wrong_contacts_name_the_culprit():
    good = {"workpiece": {"shape": "plane"}, "force_N": 50}
    contact.validate(good)
    for change, culprit in (
        ({"force_N": None}, "force_N"),
        ({"approach_mm": 1.0}, "exactly one"),
        ({"workpiece": {"shape": "cube"}}, "cube"),
        ({"workpiece": {"shape": "sphere"}}, "radius_mm"),
        ({"workpiece": {"shape": "strip"}}, "width_mm"),
        ({"wheel": {"radius": 3}}, "radius"),
        ({"wheel": {"shore_a": 60, "youngs_modulus_MPa": 5}}, "not both"),
        ({"wheel": {"poissons_ratio": 0.5}}, "poissons_ratio"),
        ({"model": "magic"}, "magic"),
    ):
        with pytest.raises(contact.InputError, match=culprit):
            contact.validate({**good, **change})
    with pytest.raises(contact.InputError, match="leave no core"):
        wheel = {"outer_radius_mm": 10, "width_mm": 10}
        contact.run(contact.validate({**good, "wheel": wheel}))


def test_shore_a_becomes_a_modulus():
    assert rubber.modulus(40) == pytest.approx(1.7, abs=0.05)
    assert rubber.modulus(60) == pytest.approx(3.6, abs=0.05)
    assert rubber.modulus(80) == pytest.approx(9.4, abs=0.05)
