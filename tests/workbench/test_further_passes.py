"""Groups of passes that follow the first ones with another way or belt angle: as one path, and as a search finds them."""

import numpy as np
import pytest

from beltgrinding.engine import InputError, core
from beltgrinding.planning import by_rules, grinding, search
from beltgrinding.planning.search import Search
from beltgrinding.raster import joined, raster_path, reachable
from test_job import plate
from test_search import job_of as job_with

ALONG_X = {"along": "direction", "direction": [1.0, 0.0, 0.0], "step_over_mm": 5.0}
ACROSS = {"direction": [0.0, 1.0, 0.0], "belt_angle_deg": 0.0}


def troughs(radius=14.0, length=20.0, half=30.0, count=8, apart=30.0):
    """Two faceted troughs, one along x, one beside it along y: a wheel that is larger than they are gets into each only with its belt along
    it."""
    angles = np.radians(np.linspace(-half, half, count + 1))
    rim = np.column_stack([radius * np.sin(angles), radius - radius * np.cos(angles)])
    one = np.array([[x, y, z] for x in (0.0, length) for y, z in rim])
    other = np.column_stack([one[:, 1] + apart, one[:, 0] - 0.5 * length, one[:, 2]])
    n, triangles = count + 1, []
    for k in range(count):
        triangles += [[k, n + k, n + k + 1], [k, n + k + 1, k + 1]]
    flipped = [[a + 2 * n, c + 2 * n, b + 2 * n] for a, b, c in triangles]
    mesh = core.TriangleMesh(
        np.vstack([one, other]).astype(np.float32), np.array([*triangles, *flipped], np.uint32)
    )
    return core.shape_from_mesh(mesh)


def test_groups_follow_each_other_in_one_path():
    job = job_with(plate())
    first = raster_path.raster(job, ALONG_X)
    second = raster_path.raster(job, {**ALONG_X, **ACROSS, "step_over_mm": 8.0})
    both = raster_path.raster(
        job, {**ALONG_X, "further_passes": [{**ACROSS, "step_over_mm": 8.0}], "repeats": 2}
    )
    once = len(first["frames"]) + len(second["frames"])
    for name in ("frames", "contacts", "feeds", "forces", "rapid", "contact", "zones", "fit"):
        assert len(both[name]) == 2 * once, name
        assert np.array_equal(both[name], np.concatenate([first[name], second[name]] * 2)), name
    assert len(both["passes"]) == 2 * (len(first["passes"]) + len(second["passes"]))
    ends = [(one["first"], one["last"]) for one in both["passes"]]
    assert ends == sorted(ends) and ends[-1][1] < 2 * once
    for one in both["passes"]:
        assert both["contact"][one["first"] : one["last"] + 1].any()
    assert both["along"] == "direction" and both["direction"] == [1.0, 0.0, 0.0]
    assert both["check"]["poses"] == once  # of what is run through twice


def test_what_a_group_has_not_is_the_first_passes_own():
    settings = raster_path.validate({**ALONG_X, "max_tilt_deg": 3.0, "further_passes": [ACROSS]})
    first, second = joined.groups(settings)
    assert not first["further_passes"] and not second["further_passes"]
    assert second == {**first, **ACROSS}


def test_a_group_keeps_to_its_region():
    job = job_with(plate())
    points = [[x, y, 0.0] for x in (30.0, 34.0) for y in (10.0, 14.0)]
    settings = {
        **ALONG_X,
        "further_passes": [{**ACROSS, "region_points": points, "region_mm": 4.0}],
    }
    first, both = (raster_path.raster(job, one) for one in (ALONG_X, settings))
    added = both["contacts"][len(first["contacts"]) :][both["contact"][len(first["contacts"]) :]]
    assert len(added)
    far = reachable.nearest_distance(added[:, :3, 3], np.array(points))
    assert far.max() < 4.0 + both["contact_length_mm"]


def test_places_are_ground_by_the_group_that_gets_there():
    job = job_with(troughs())
    settings = {**ALONG_X, "max_tilt_deg": 0.0, "step_over_mm": 2.0}
    one = raster_path.raster(job, settings)
    both = raster_path.raster(job, {**settings, "further_passes": [ACROSS]})
    assert one["reachable"]["share"] < 0.7, one["reachable"]
    assert both["reachable"]["share"] > 0.85, both["reachable"]
    assert both["reachable"]["left_out"] < 0.05
    codes = [warning.code for warning in both["warnings"]]
    assert len(codes) == len(set(codes)), codes  # of both groups once


@pytest.mark.parametrize(
    ("group", "text"),
    [
        ({"feed_mm_s": 20.0}, "feed_mm_s"),
        ({"along": "auto"}, "along"),
        ({"region_points": [[0.0, 0.0, 900.0]]}, r"further_passes\[0\]: .*off the faces"),
        ({"further_passes": []}, "further_passes"),
    ],
)
def test_a_group_that_cannot_be_laid_is_refused(group, text):
    with pytest.raises(InputError, match=text):
        raster_path.raster(job_with(plate()), {**ALONG_X, "further_passes": [group]})


def test_a_group_without_room_is_refused_and_named():
    bottom = [[x, 0.0, 0.0] for x in (8.0, 10.0, 12.0)]  # of the first trough, which lies along x
    across = {**ACROSS, "region_points": bottom, "region_mm": 3.0}
    settings = {**ALONG_X, "max_tilt_deg": 0.0, "step_over_mm": 2.0}
    with pytest.raises(InputError, match=r"further_passes\[0\]: the wheel fits nowhere there"):
        raster_path.raster(job_with(troughs()), {**settings, "further_passes": [across]})


def test_too_many_poses_are_refused(monkeypatch):
    fine = {**ALONG_X, "max_distance_mm": 2.0}
    alone = len(raster_path.raster(job_with(plate()), fine)["frames"])
    monkeypatch.setattr(joined, "MOST_POSES", alone + 10)
    with pytest.raises(InputError, match="further_passes: all passes together have"):
        raster_path.raster(job_with(plate()), {**fine, "further_passes": [ACROSS]})


@pytest.mark.slow
def test_a_search_adds_a_group_where_one_way_does_not_do(monkeypatch):
    for name, count in {"LEADERS": 1, "FINALS": 2, "OF_A_GROUP": 3, "PATIENCE": 2}.items():
        monkeypatch.setattr(search, name, count)
    monkeypatch.setattr(by_rules, "TRIES", 1)
    job = job_with(troughs())
    given = {**ALONG_X, "max_tilt_deg": 0.0, "step_over_mm": 3.0}
    way = ("along", "direction")  # u and v of each face would be along both
    found = grinding.grind(
        job, given, {"rounds": 1, "check": False}, search=Search(float("inf"), fixed=way)
    )
    rows = [one for one in found.tried if one["change"] != "full"]
    one_way = max(one["in_tolerance"] for one in rows if not one["further_passes"])
    after = found.plan.after.summary["in_tolerance_area_share"]
    assert after > one_way + 0.2, (one_way, after)
    group = found.settings["further_passes"][0]
    assert group["region_points"] and group["belt_angle_deg"] != found.settings["belt_angle_deg"]
    row = next(one for one in rows if one["further_passes"])
    assert set(row["further_passes"][0]) == {"along", "direction", "belt_angle_deg"}
