"""What a run gives is possible and readable, whatever the job: the files of shared/faults that were not, and
neighbours of theirs."""

import copy
import json

import numpy as np
import pytest

from support.freecad import SHARED

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.simulation import last_door
from beltgrinding.simulation.result import Result

FAULTS = SHARED / "faults"
shared = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {FAULTS}")
TOP = 5.0  # mm, of the box


def box():
    """The core.Shape of a box of 30 x 20 x TOP mm, faceted."""
    corners = np.array([(x, y, z) for z in (0, TOP) for y in (0, 20) for x in (0, 30)], np.float32)
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return core.shape_from_mesh(core.TriangleMesh(corners, np.array(triangles, np.uint32)))


def job(**machine):
    """A pass over the top of the box."""
    pose = {"y_mm": 10.0, "z_mm": TOP, "qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}
    return {
        "design": {"brep": box().write_brep()},
        "sampling": {"spacing_mm": 1.0},
        "stock": {"allowance_mm": 0.3},
        "belt_machine": {"wheel": {"radius_mm": 40.0, "width_mm": 10.0}, **machine},
        "cell": {"check_collisions": False},
        "programs": [{"poses": [{"x_mm": x, "feed_mm_s": 20.0, **pose} for x in (5.0, 12.0)]}],
    }


@pytest.fixture(scope="module")
def ground():
    return beltgrinding.run(job())


@shared
@pytest.mark.parametrize(
    "name",
    [
        "unreadable_result",
        "unreadable_result2",
        "nan_curve",
        pytest.param("belt_stress", marks=pytest.mark.slow),
        "belt_hang",
    ],
)
def test_a_job_that_had_no_result_has_one_that_is_read(name, tmp_path):
    given = json.loads((FAULTS / f"{name}.json").read_text(encoding="utf-8"))
    given["design"]["file"] = str(FAULTS / given["design"]["file"])
    made = beltgrinding.run(given)
    made.write(tmp_path / "out")
    read = Result.read(tmp_path / "out")
    assert read.field.height.tobytes() == made.field.height.tobytes()
    for array in ("first", "last", "dominant", "dominant_depth", "peak_pressure"):
        assert read.field.trace[array].tobytes() == made.field.trace[array].tobytes()
    assert read.field.trace["peak_pressure"].max() < 1e4  # MPa


def test_where_nothing_is_ground_nothing_is_removed():
    """0.3 mm is a little more in single precision: the difference had been told as removed, or as added."""
    for allowance in (0.1, 0.3, 0.7, 1000.1):
        one = job(control="position")
        one["stock"] = {"allowance_mm": allowance}
        for pose in one["programs"][0]["poses"]:
            pose["z_mm"] = TOP + allowance + 50.0
        one["programs"][0]["poses"] += one["programs"][0]["poses"][:1]
        try:
            made = beltgrinding.run(one)
        except InputError as error:
            assert error.code == "simulation.never_touches"
            continue
        assert made.summary["removed_volume_mm3"] == 0.0


def test_what_is_removed_beside_untouched_stock_is_that_of_the_ground_samples(ground):
    field = ground.field
    stock, height = field.stock_height.astype(float), np.asarray(field.height)
    area = field.areas.astype(float)
    gone = np.where(height.astype(np.float32) < field.stock_height, stock - height, 0.0)
    assert ground.summary["removed_volume_mm3"] == pytest.approx((area * gone).sum(), rel=1e-12)
    for face in ground.verdict["faces"]:
        if face["untouched_area_mm2"] == face["area_mm2"]:
            assert face["removed_volume_mm3"] == 0.0


@pytest.mark.parametrize(
    "spoil, told",
    [
        (lambda r: r.summary.update(removed_volume_mm3=-6e-6), "summary: -6e-06 mm3 are removed"),
        (lambda r: r.summary.update(removed_volume_mm3=1e9), "summary: 1000000000.0 mm3"),
        (lambda r: r.summary.update(in_tolerance_area_share=1.0000000000000002), "no share"),
        (lambda r: r.summary["deviation_mm"].update(max=float("nan")), "deviation_mm.max is nan"),
        (lambda r: r.verdict.update(in_share=-1e-17), "verdict.in_share"),
        (lambda r: r.verdict["faces"][0].update(removed_volume_mm3=-1.0), r"verdict.faces\[0\]"),
        (lambda r: r.steps["force"].__setitem__(0, np.inf), "steps: force"),
        (lambda r: r.events.append({"value": float("inf")}), "events"),
    ],
)
def test_a_figure_that_cannot_be_is_a_fault_of_the_program(ground, spoil, told):
    result = copy.copy(ground)
    for name in ("summary", "verdict", "events", "steps"):
        setattr(result, name, copy.deepcopy(getattr(ground, name)))
    last_door.check(result)
    spoil(result)
    with pytest.raises(last_door.Impossible, match=told):
        last_door.check(result)


def test_a_field_that_no_file_can_hold_is_a_fault_of_the_program(ground, tmp_path):
    field = ground.field.copy()
    field.set_height_sd(np.full(field.size, np.nan, dtype=np.float32))
    for write in (
        field.check,
        field.hdf5,
        lambda: field.write_hdf5(str(tmp_path / "a.h5"), "{}"),
    ):
        with pytest.raises(RuntimeError, match="standard deviations"):
            write()
    assert not any(tmp_path.iterdir())


def test_a_result_that_cannot_be_leaves_the_old_one(ground, tmp_path, monkeypatch):
    ground.write(tmp_path / "out")
    before = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    bad = copy.copy(ground)
    bad.field = ground.field.copy()
    bad.field.set_height_sd(np.full(bad.field.size, np.inf, dtype=np.float32))
    with pytest.raises(InputError, match="standard deviations are no lengths"):
        bad.write(tmp_path / "out")
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()} == before


def test_a_wheel_as_large_as_a_country_is_refused():
    with pytest.raises(InputError) as caught:
        beltgrinding.run(job(wheel={"radius_mm": 1e9, "width_mm": 10.0}))
    assert "radius" in str(caught.value)


MODEL = {
    "source": "nobody",
    "coefficient_um": 1.0,
    "reference_grit": 80.0,
    "reference_pressure_MPa": 0.1,
    "reference_belt_speed_m_s": 20.0,
    "reference_feed_mm_s": 50.0,
    "grit_exponent": -0.8,
    "pressure_exponent": 0.3,
    "belt_speed_exponent": 0.0,
    "feed_exponent": 0.0,
    "wear_exponent": 0.0,
    "ranges": {
        "grit": [1.0, 1e4],
        "pressure_MPa": [1e-6, 1e3],
        "belt_speed_m_s": [1.0, 100.0],
        "feed_mm_s": [1.0, 1000.0],
        "remaining_cut": [0.1, 1.0],
    },
}


@pytest.mark.parametrize("key, value", [("grit_exponent", 5000.0), ("ln_deviation", 1000.0)])
def test_a_roughness_beyond_all_numbers_is_refused(key, value):
    one = job()
    one["finish"] = {"grit": 120.0, "model": {**MODEL, key: value}}
    with pytest.raises(InputError) as caught:
        beltgrinding.run(one)
    assert key in str(caught.value)


def test_a_roughness_that_a_pressure_takes_beyond_all_numbers_is_refused():
    one = job()
    one["finish"] = {"grit": 120.0, "model": {**MODEL, "pressure_exponent": -3000.0}}
    with pytest.raises(InputError, match="finish.model.pressure_exponent"):
        beltgrinding.run(one)
