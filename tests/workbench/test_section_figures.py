"""Chord, thickness and edge radii of sections whose answer is known."""

import math

import numpy as np
import pytest

from beltgrinding.inspection import section_figures

NOSES = (0.2, 0.15)  # mm
FLANK = math.radians(10.0)
BETWEEN, ARC = 39.6, 60.0  # mm: the noses' centres, the radius between the flanks
CHORD = BETWEEN + sum(NOSES)


def turned(angles):
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def belly():
    """The centre of the upper arc, tangent to a flank of each nose."""
    lines = np.array([[-math.sin(FLANK), math.cos(FLANK)], [math.sin(FLANK), math.cos(FLANK)]])
    return np.linalg.solve(lines, [NOSES[0] - ARC, NOSES[1] - ARC + BETWEEN * math.sin(FLANK)])


THICKNESS = 2.0 * (belly()[1] + ARC)


def aerofoil(step=0.02):
    """(points, normals), (n, 2) each, counter-clockwise: two noses, flanks of 10 degrees, and arcs between."""
    right = math.pi / 2
    arcs = []
    for angles, centre, radius in (
        ((right + FLANK, 3 * right - FLANK), (0.0, 0.0), NOSES[0]),
        ((-right - FLANK, -right + FLANK), belly() * (1, -1), ARC),
        ((-right + FLANK, right - FLANK), (BETWEEN, 0.0), NOSES[1]),
        ((right - FLANK, right + FLANK), belly(), ARC),
    ):
        count = max(int(abs(angles[1] - angles[0]) * radius / (step if radius < 1.0 else 0.2)), 12)
        normals = turned(np.linspace(*angles, count + 1))
        arcs.append((np.asarray(centre) + radius * normals, normals))
    points, normals = [], []
    for (p, n), (after, _) in zip(arcs, [*arcs[1:], arcs[0]]):
        way = after[0] - p[-1]
        count = max(int(np.linalg.norm(way) / (10 * step)), 1)
        line = p[-1] + np.linspace(0, 1, count + 1)[1:-1, None] * way
        points += [p, line]
        normals += [n, np.tile(n[-1], (len(line), 1))]
    return np.concatenate(points), np.concatenate(normals)


def section(points, normals, height=0.0, stock=0.0, closed=True, frame=np.eye(3)):
    """A section of one piece in the plane of a frame's first two columns."""
    if closed:
        points, normals = (np.concatenate([a, a[:1]]) for a in (points, normals))
    height, stock = (np.asarray(h, dtype=float) + np.zeros(len(points)) for h in (height, stock))
    p, n = (a @ frame[:, :2].T for a in (points, normals))
    way = np.linalg.norm(np.diff(p, axis=0), axis=1)
    piece = {"face": 0, "closed": closed, "s": np.concatenate([[0.0], np.cumsum(way)])}
    piece |= {"point": p, "normal": n, "ray": n, "height": height, "stock_height": stock}
    return {"point": [0, 0, 0], "normal": frame[:, 2], "pieces": [piece]}


def told(found, **given):
    return section_figures.of_section(found, (0, 0, 0), **given)


def thick_at(radius, distance):
    """Of a nose with flanks of 10 degrees, ``distance`` from its tip."""
    return 2.0 * (radius / math.cos(FLANK) + (distance - radius) * math.tan(FLANK))


@pytest.mark.parametrize("left", (0.0, 0.05, -0.06))
def test_an_even_removal_changes_all_by_what_it_takes(left):
    found = told(section(*aerofoil(), left, 0.3), distances=(0.5, 2.0))
    for name, added in (("design", 0.0), ("stock", 0.3), ("ground", left)):
        one = found[name]
        assert one["chord_mm"] == pytest.approx(CHORD + 2 * added, abs=1e-5)
        assert one["thickness_mm"] == pytest.approx(THICKNESS + 2 * added, abs=2e-5)
        for edge, radius in zip(("leading", "trailing"), NOSES):
            assert one[edge]["state"] == "round"
            assert one[edge]["radius_mm"] == pytest.approx(radius + added, abs=1e-6)
            expected = [thick_at(radius + added, d) for d in (0.5, 2.0)]
            if 0.5 > (radius + added) * (1 + math.sin(FLANK)):  # else still on the arc
                assert one[edge]["thicknesses_mm"] == pytest.approx(expected, abs=1e-4)


def test_a_mirrored_and_a_turned_part_give_the_same():
    points, normals = aerofoil()
    height = 0.02 * points[:, 0] / CHORD
    height = np.append(height, height[0])
    first = told(section(points, normals, height), distances=(1.0,))
    mirror = np.array([-1.0, 1.0])
    other = told(
        section(points[::-1] * mirror, normals[::-1] * mirror, height_of(points, True)),
        distances=(1.0,),
    )
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    third = told(section(points, normals, height, frame=turn), distances=(1.0,))
    for again in (other, third):
        for name in ("design", "ground"):
            for key in ("chord_mm", "thickness_mm"):
                assert again[name][key] == pytest.approx(first[name][key], abs=1e-9)
            for edge in ("leading", "trailing"):
                for key in ("radius_mm", "thicknesses_mm"):
                    assert again[name][edge][key] == pytest.approx(first[name][edge][key], abs=1e-8)


def height_of(points, mirrored):
    height = 0.02 * points[:, 0] / CHORD
    height = height[::-1] if mirrored else height
    return np.append(height, height[0])


def test_the_leading_edge_is_the_rounder_one_or_the_one_that_is_named():
    found = section(*aerofoil())
    assert told(found)["design"]["leading"]["radius_mm"] == pytest.approx(0.2, abs=1e-6)
    named = told(found, leading=(1.0, 0.2, 0.0))
    assert named["design"]["leading"]["radius_mm"] == pytest.approx(0.15, abs=1e-6)


def test_noise_and_an_outlier_hardly_move_the_figures():
    points, normals = aerofoil(0.045)
    rng = np.random.default_rng(5)
    radii, chords = [], []
    for _ in range(6):
        height = rng.normal(0.0, 0.0015, len(points))
        crown = np.flatnonzero(points[:, 0] < -0.15)
        height[crown[len(crown) // 3]] += 0.01
        one = told(section(points, normals, np.append(height, height[0])))["ground"]
        assert one["leading"]["state"] == "round"
        assert one["thickness_mm"] == pytest.approx(THICKNESS, abs=0.008)
        radii.append(one["leading"]["radius_mm"])
        chords.append(one["chord_mm"])
    assert np.mean(radii) == pytest.approx(0.2, abs=0.004)
    assert np.abs(np.array(radii) - 0.2).max() < 0.01
    assert np.abs(np.array(chords) - CHORD).max() < 0.006


def plate(step=0.05, thick=0.4, long=20.0, round_end=False):
    """A plate's outline with a square-cut end at x = 0, a sharp one or a half round one at the other."""
    right = np.arange(0.0, long, step)
    up = np.linspace(-0.5 * thick, 0.5 * thick, 13)
    ones = np.ones
    bottom = np.stack([right, -0.5 * thick * ones(len(right))], axis=1)
    top = (bottom * (1, -1))[::-1]
    end = np.stack([0 * up, -up], axis=1)
    arc = turned(np.linspace(-0.5 * math.pi, 0.5 * math.pi, 25))
    far = (long, 0.0) + 0.5 * thick * arc
    points = np.concatenate([bottom, far, top, end])
    normals = np.concatenate(
        [
            np.tile((0.0, -1.0), (len(bottom), 1)),
            arc,
            np.tile((0.0, 1.0), (len(top), 1)),
            np.tile((-1.0, 0.0), (len(end), 1)),
        ]
    )
    return points, normals


def test_a_square_cut_edge_is_not_round():
    one = told(section(*plate()), leading=(-1, 0, 0), distances=(1.0,))["design"]
    assert one["leading"]["state"] == "not_round" and one["leading"]["radius_mm"] is None
    assert one["leading"]["thicknesses_mm"] == pytest.approx([0.4], abs=1e-6)
    assert one["trailing"]["state"] == "round"
    assert one["trailing"]["radius_mm"] == pytest.approx(0.2, abs=1e-6)
    assert one["thickness_mm"] == pytest.approx(0.4, abs=1e-6)
    assert one["chord_mm"] == pytest.approx(math.hypot(20.0, 0.2) + 0.2, abs=1e-6)


def test_an_elliptic_edge_is_not_round():
    angle = np.linspace(0.0, 2.0 * math.pi, 801)[:-1]
    points = turned(angle) * (20.0, 0.4)  # the radius at its ends is 0.008 mm, and grows at once
    normals = turned(angle) * (0.4, 20.0)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    one = told(section(points, normals))["design"]
    assert {one[edge]["state"] for edge in ("leading", "trailing")} <= {"not_round", "few_samples"}
    assert one["thickness_mm"] == pytest.approx(0.8, abs=1e-4)
    assert one["chord_mm"] == pytest.approx(40.0, abs=1e-9)


def test_too_few_samples_and_missed_stock_and_open_outlines_have_no_radius():
    points, normals = aerofoil()
    on_nose = np.flatnonzero(points[:, 0] < -NOSES[0] * math.sin(FLANK) + 1e-9)
    few = np.setdiff1d(np.arange(len(points)), np.setdiff1d(on_nose, on_nose[::8]))
    one = told(section(points[few], normals[few]), leading=(-1, 0, 0))["design"]
    assert one["leading"]["state"] == "few_samples" and one["leading"]["radius_mm"] is None
    assert one["trailing"]["state"] == "round"

    height = np.where(points[:, 0] > 30.0, np.nan, 0.0)
    found = told(section(points, normals, np.append(height, height[0])), distances=(1.0,))
    assert found["ground"]["chord_mm"] is None
    assert found["ground"]["leading"]["state"] == "missed"
    assert found["ground"]["leading"]["thicknesses_mm"] == [None]
    assert found["design"]["chord_mm"] is not None

    start = int(np.argmax(points[:, 0]))
    order = np.roll(np.arange(len(points)), -start)
    order = order[points[order, 0] < 20.0]
    half = told(section(points[order], normals[order], closed=False), distances=(2.0,))["design"]
    assert half["chord_mm"] is None and half["thickness_mm"] is None
    assert half["leading"]["radius_mm"] == pytest.approx(0.2, abs=1e-6)
    assert half["leading"]["thicknesses_mm"] == pytest.approx([thick_at(0.2, 2.0)], abs=1e-5)
    assert half["trailing"]["state"] == "open"

    flank = order[points[order, 1] > 0.3]
    line = told(section(points[flank], normals[flank], closed=False))["design"]
    assert line["leading"]["state"] == line["trailing"]["state"] == "open"
