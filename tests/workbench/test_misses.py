"""A wheel that misses the part, or seems to: of two programs one, an edge far from the middle, a rib far thinner than a cell."""

import copy
import json

import pytest
from support.freecad import SHARED
from test_job import plate, plate_job

import beltgrinding
from beltgrinding.contact import single_contact
from beltgrinding.engine import InputError
from beltgrinding.job import load

EDGE = {
    "wheel": {
        "outer_radius_mm": 100,
        "width_mm": 30,
        "rim_thickness_mm": 15,
        "youngs_modulus_MPa": 5,
        "poissons_ratio": 0.45,
    },
    "workpiece": {"shape": "edge", "edge_mm": -10, "axis_angle_deg": 90},
    "force_N": 28.28,
    "model": "wheel_rim",
}
FAULTS = SHARED / "faults"


def missing(job):
    """A program of the job's that passes beside the part."""
    beside = copy.deepcopy(job["programs"][0])
    for pose in beside["poses"]:
        pose["y_mm"] = 300
    return beside


@pytest.mark.parametrize("first", (True, False))
def test_of_two_programs_the_one_that_meets_the_part_grinds(first):
    alone = beltgrinding.run(plate_job())
    job = plate_job()
    job["programs"].insert(0 if first else 1, missing(job))
    both = beltgrinding.run(job)
    assert both.summary["removed_volume_mm3"] == alone.summary["removed_volume_mm3"]
    told = [one for one in both.summary["warnings"] if "never touches" in one]
    assert len(told) == 1 and f"programs[{0 if first else 1}]" in told[0]
    assert not [one for one in alone.summary["warnings"] if "never touches" in one]


def test_a_job_whose_programs_all_miss_is_refused():
    job = plate_job()
    job["programs"] = [missing(job), missing(job)]
    with pytest.raises(InputError, match="never touches") as error:
        beltgrinding.run(job)
    assert error.value.code == "simulation.never_touches"


def test_an_edge_beyond_the_first_grid_is_found_at_every_spacing():
    def pressed(spacing):
        return single_contact.run(single_contact.validate({**EDGE, "spacing_mm": spacing}))

    coarse = pressed(0.5)
    for spacing in (0.39, 0.25):
        fine = pressed(spacing)
        assert fine["approach"] == pytest.approx(coarse["approach"], rel=0.02)
        assert fine["force"] == pytest.approx(28.28, rel=1e-3)
    if FAULTS.is_dir():
        given = json.loads((FAULTS / "edge10_fine.json").read_text())
        found = single_contact.run(single_contact.validate(given))
        assert found["approach"] == pytest.approx(coarse["approach"], rel=0.02)
    with pytest.raises(InputError, match="meets the workpiece nowhere"):
        far = {**EDGE, "workpiece": {**EDGE["workpiece"], "edge_mm": -150}}
        single_contact.run(single_contact.validate({**far, "spacing_mm": 0.5}))


def rib(width):
    """A job that grinds a rib of that width along its middle."""
    job = plate_job()
    job["design"] = {"brep": plate(60.0, width).write_brep()}
    for pose in job["programs"][0]["poses"]:
        pose["y_mm"] = width / 2
    job["belt_machine"]["force_N"] = 0.3
    job["law"] = {"coefficient_mm2_per_N": 1e-8}
    return job


def test_a_rib_far_thinner_than_cells_is_ground():
    wide, thin = (beltgrinding.run(rib(width)).summary for width in (3.0, 0.04))
    assert thin["removed_volume_mm3"] == pytest.approx(wide["removed_volume_mm3"], rel=0.01)


def test_a_rib_that_no_cell_shows_is_blamed_on_the_cells():
    with pytest.raises(InputError, match="0.004 mm wide, less than cells of 1 mm show") as error:
        beltgrinding.run(rib(0.004))
    assert error.value.arguments["wanted"] == pytest.approx(0.016, rel=1e-3)


@pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no faults at {FAULTS}")
@pytest.mark.parametrize("spacing", (1.0, 0.5, 0.4, 0.36))
def test_a_leading_edge_keeps_the_volume_at_every_spacing(spacing):
    job = json.loads((FAULTS / "le_job.json").read_text())
    job["sampling"]["spacing_mm"] = spacing
    job["design"]["file"] = str(FAULTS / "le.brep")
    for coefficient in (1e-6, 5e-6):
        job["law"]["coefficient_mm2_per_N"] = coefficient
        result = beltgrinding.run(load.validate(job))
        law = coefficient * 20e3 * 10 * 24 / 20  # K V_b F t
        assert result.summary["removed_volume_mm3"] == pytest.approx(law, rel=0.01)
        crown = result.field.normals[:, 2] > 0.985  # within 10 degrees
        assert crown.sum() > 60 / spacing  # a row on the nose, 60 mm long
