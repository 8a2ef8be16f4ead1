"""Force control that takes time, and rubber at speed, by whole jobs: against closed forms, and as the time step goes."""

from pathlib import Path

import numpy as np
import pytest

import beltgrinding
from beltgrinding import planning, presets
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.job.engine_input import wheel_growth
from beltgrinding.reporting import facts
from beltgrinding.reporting.language import Language
from random_jobs import box

ROBUSTNESS = Path(__file__).resolve().parent.parent / "robustness"

TOP, MIDDLE = 10.0, 15.0  # of the box of 40 x 30 x 10 mm: its upper face, mm
ALLOWANCE = 0.3  # mm
FOUNDATION = {"model": "elastic_foundation", "stiffness_MPa_per_mm": 0.5}


def poses(*places, feed=60.0, z=TOP, **more):
    turn = {"qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}
    at = {"y_mm": MIDDLE, "z_mm": z, "feed_mm_s": feed}
    return [{"x_mm": float(x), **at, **turn, **more} for x in places]


def job(way, dynamics=None, travel=1.0, coefficient=2e-6, **machine):
    return {
        "design": {"brep": box().write_brep(), "faces": [2]},
        "sampling": {"spacing_mm": 0.5},
        "stock": {"allowance_mm": ALLOWANCE},
        "belt_machine": {
            "wheel": {"radius_mm": 40.0, "width_mm": 10.0},
            "force_N": 30.0,
            "compliance": FOUNDATION,
            "force_dynamics": dynamics or {},
            **machine,
        },
        "law": {"coefficient_mm2_per_N": coefficient},
        "simulation": {"max_travel_mm": travel},
        "cell": {"check_collisions": False},
        "programs": [{"poses": way}],
    }


def depths(result):
    """mm, ground along the middle of the pass, by mm of its way."""
    points = np.array(result.field.points, dtype=float)
    ground = ALLOWANCE - np.array(result.field.height)
    near = np.abs(points[:, 1] - MIDDLE) < 2.0
    return np.array([ground[near & (np.abs(points[:, 0] - x) < 0.6)].mean() for x in range(41)])


def kinds(result):
    return {event["kind"] for event in result.events}


def into_and_out(dynamics, travel, **machine):
    """Beyond the box, over it and out."""
    return beltgrinding.run(
        job(poses(-18, 58), dynamics, travel, **{"force_travel_mm": 1.5, **machine})
    )


@pytest.mark.parametrize("name", ["pneumatic_flange", "electric_flange", "robot_admittance"])
def test_the_way_into_an_edge_and_out_of_it_converges(name):
    dynamics = presets.apply({}, actuator=name)["belt_machine"]["force_dynamics"]
    runs = [into_and_out(dynamics, travel) for travel in (2.0, 1.0, 0.5, 0.25)]
    profiles = [depths(run) for run in runs]
    changes = [np.abs(a - b).max() for a, b in zip(profiles, profiles[1:])]
    ideal = depths(into_and_out({}, 0.25))
    print(name, "changes", changes, "entry", profiles[-1][1], "exit", profiles[-1][39], ideal[1])
    assert changes[-1] < 0.02 * profiles[-1].max()
    # It is pushed up at the first edge, and late to come down at the other.
    assert profiles[-1][1] > 1.02 * ideal[1] and profiles[-1][39] < ideal[39]
    forces = [np.max(run.steps["force"]) for run in runs]
    assert forces[-1] == pytest.approx(forces[-2], rel=0.02)


@pytest.fixture(scope="module")
def ribbed(tmp_path_factory):
    """A mesh of stock on the box, with a rib across it that is 5 mm wide and 3 mm high."""
    way = [(-1, 0), (17.45, 0), (17.5, 3), (22.5, 3), (22.55, 0), (41, 0)]
    corners = [(x, y, TOP + ALLOWANCE + z) for x, z in way for y in (-1.0, 31.0)]
    strips = range(0, 2 * len(way) - 2, 2)
    triangles = [t for a in strips for t in ((a, a + 2, a + 3), (a, a + 3, a + 1))]
    rows = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    rows["p"] = np.array(corners)[np.array(triangles)]
    path = tmp_path_factory.mktemp("rib") / "rib.stl"
    path.write_bytes(b"\0" * 80 + np.uint32(len(rows)).tobytes() + rows.tobytes())
    return path


def over_the_rib(path, dynamics, travel):
    """The volume in mm3, and the least and the greatest force of a step in N."""
    rubber = {"model": "wheel_rim"}
    wheel = {"radius_mm": 100.0, "width_mm": 20.0}
    one = job(poses(3, 37), dynamics, travel, force_N=50.0, compliance=rubber, wheel=wheel)
    one["stock"] = {"kind": "mesh", "file": str(path)}
    result = beltgrinding.run(one)
    force = np.array(result.steps["force"])
    return result.summary["removed_volume_mm3"], force.min(), force.max()


@pytest.mark.parametrize(
    "name, least, most",
    [
        ("pneumatic_flange", 43.3, 58.0),
        ("electric_flange", 32.5, 66.5),
        ("robot_admittance", 17, 83),
    ],
)
def test_the_way_over_a_rib(ribbed, name, least, most):
    dynamics = presets.apply({}, actuator=name)["belt_machine"]["force_dynamics"]
    coarse, *_ = over_the_rib(ribbed, dynamics, 0.5)
    volume, *forces = over_the_rib(ribbed, dynamics, 0.25)
    assert forces == pytest.approx([least, most], abs=1.5)  # as docs/force-method.md has them
    assert coarse == pytest.approx(volume, rel=0.01)


def test_a_heavy_one_overshoots_and_it_is_told():
    heavy = {"model": "actuator", "moving_mass_kg": 5.0, "damping_N_s_per_mm": 5.0}
    result = into_and_out(heavy, 0.5)
    event = next(e for e in result.events if e["kind"] == "force_overshoot")
    assert event["value"] > 1.25 * 30.0 and event["limit"] == pytest.approx(1.25 * 30.0)
    assert "in place of 30 N" in event["message"]
    quiet = into_and_out({**heavy, "overshoot_limit": 0.0}, 0.5)
    assert "force_overshoot" not in kinds(quiet)
    np.testing.assert_array_equal(quiet.field.height, result.field.height)


def test_a_light_one_is_ideal():
    ideal = into_and_out({}, 0.125)
    light = {"model": "actuator", "moving_mass_kg": 1e-3, "damping_N_s_per_mm": 0.002}
    result = into_and_out(light, 0.125)
    assert np.abs(depths(result) - depths(ideal)).max() < 0.005 * depths(ideal).max()
    volume = ideal.summary["removed_volume_mm3"]
    assert result.summary["removed_volume_mm3"] == pytest.approx(volume, rel=0.005)


def test_a_force_that_lags_is_the_closed_form():
    way = [*poses(8, 20, force_N=20.0), *poses(32, force_N=40.0)]
    result = beltgrinding.run(job(way, {"model": "lag", "lag_s": 0.05}))
    time, duration, force = (
        np.array(result.steps[k], float) for k in ("time", "duration", "force")
    )
    begin = np.maximum(time - duration / 2 - 0.2, 0.0)
    end = np.maximum(time + duration / 2 - 0.2, 0.0)
    after = begin > 0.0
    decay = 0.05 * (np.exp(-begin / 0.05) - np.exp(-end / 0.05)) / duration
    assert after.sum() > 10
    assert np.abs(force - (40.0 - 20.0 * decay))[after].max() < 0.02 * 20.0


def test_it_does_not_depend_on_the_threads():
    heights = []
    for threads in (1, 2):
        core.set_threads(threads)
        try:
            heights.append(np.array(into_and_out({"model": "actuator"}, 1.0).field.height))
        finally:
            core.set_threads(0)
    np.testing.assert_array_equal(*heights)


@pytest.mark.parametrize(
    "dynamics, said",
    [
        ({"model": "spring"}, "belt_machine.force_dynamics.model"),
        ({"lag_s": -1.0}, "belt_machine.force_dynamics.lag_s"),
        ({"moving_mass_kg": "heavy"}, "belt_machine.force_dynamics.moving_mass_kg"),
        ({"mass": 3.0}, "unknown key 'mass'"),
        (
            {"model": "actuator", "moving_mass_kg": 0, "damping_N_s_per_mm": 0},
            "needs a moving mass or a damping",
        ),
    ],
)
def test_nonsense_is_refused(dynamics, said):
    with pytest.raises(InputError, match=said):
        beltgrinding.run(job(poses(8, 32), dynamics))


@pytest.mark.parametrize(
    "code, said",
    [
        ("en", ("lags by 0.05 s", "moves 5 kg", "1.3 times as stiff", "grown by 0.0261 mm")),
        ("de", ("um 0,05 s nach", "bewegt 5 kg", "1,3-mal so steif", "um 0,0261 mm aufgeweitet")),
    ],
)
def test_the_report_says_it(code, said):
    stiff = {**FOUNDATION, "dynamic_modulus_factor": 1.3}
    told = ""
    for dynamics, machine in (
        ({"model": "lag", "lag_s": 0.05}, {}),
        ({"model": "actuator"}, {"compliance": stiff}),
        ({}, {"control": "position"}),
    ):
        one = jobs.validate(job(poses(8, 32), dynamics, **machine))
        summary = {"wheel_growth_mm": 0.0261} if machine.get("control") else {}
        told += " ".join(text for _, text in facts.process(one, summary, Language(code)))
    for one in said:
        assert one in told


def test_a_job_with_it_is_planned():
    one = jobs.validate(job(poses(-10, 10, 30, 50), {"model": "actuator"}))
    found = planning.plan(one, {"check": False, "rounds": 1})
    assert found is not None


def test_the_rim_grows_by_its_rotation():
    machine = jobs.validate(
        job(
            poses(8, 32, z=TOP - 0.05),
            control="position",
            wheel_density_kg_m3=1100.0,
            wheel={"radius_mm": 100.0, "width_mm": 10.0},
        )
    )["belt_machine"]
    # rho V_b^2 h^2 / (2 R M), M = E (1 - nu) / ((1 + nu) (1 - 2 nu)): E 5 MPa, nu 0.45, h 15 mm
    modulus = 5.0 * 0.55 / (1.45 * 0.1)
    assert wheel_growth(machine) == pytest.approx(
        1100e-12 * 20000.0**2 * 15.0**2 / (2 * 100.0 * modulus)
    )
    assert wheel_growth(machine) == pytest.approx(0.026, abs=5e-4)
    half = {"thickness_mm": 7.5, "youngs_modulus_MPa": 5.0, "poissons_ratio": 0.45}
    layers = {**machine, "compliance": {**machine["compliance"], "layers": [half, half]}}
    assert wheel_growth(layers) == pytest.approx(wheel_growth(machine))
    # The equation of motion itself, solved by finite differences for a stiff rubber on a soft one.
    soft = {**half, "youngs_modulus_MPa": 2.0, "thickness_mm": 10.0}
    layers["compliance"]["layers"] = [soft, half]
    x = np.linspace(0.0, 17.5, 20001)
    factor = 0.55 / (1.45 * 0.1)
    stiff = np.where(x < 10.0, 2.0, 5.0) * factor
    stress = 1100e-12 * 20000.0**2 / 100.0 * (17.5 - x)
    grown = np.sum(0.5 * (stress / stiff)[1:] + 0.5 * (stress / stiff)[:-1]) * x[1]
    assert wheel_growth(layers) == pytest.approx(grown, rel=1e-3)
    assert wheel_growth({**machine, "control": "force"}) == 0.0
    assert wheel_growth({**machine, "wheel_density_kg_m3": 0.0}) == 0.0


def test_growth_and_the_dynamic_modulus_raise_the_force_and_are_told():
    way = poses(8, 32, z=TOP + ALLOWANCE - 0.2)

    def force(**machine):
        result = beltgrinding.run(job(way, control="position", coefficient=1e-12, **machine))
        return float(np.array(result.steps["force"]).mean()), result.summary

    plain, summary = force()
    assert "wheel_growth_mm" not in summary and "dynamic_modulus_factor" not in summary
    stiff = {**FOUNDATION, "dynamic_modulus_factor": 1.5}
    stiffer, summary = force(compliance=stiff)
    assert stiffer == pytest.approx(1.5 * plain, rel=2e-3)
    assert summary["dynamic_modulus_factor"] == 1.5
    grown, summary = force(wheel_density_kg_m3=1100.0)
    assert summary["wheel_growth_mm"] == pytest.approx(0.0654, abs=2e-3)
    lower = poses(8, 32, z=TOP + ALLOWANCE - 0.2 - summary["wheel_growth_mm"])
    result = beltgrinding.run(job(lower, control="position", coefficient=1e-12))
    assert grown == pytest.approx(float(np.array(result.steps["force"]).mean()), rel=2e-3)
    assert grown > 1.2 * plain
