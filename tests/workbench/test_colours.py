"""Colours of single values, as the live view asks for them, beside those of a height field."""

import numpy as np
import pytest

from beltgrinding.engine import InputError, core
from beltgrinding.planning import pictures

SCALE = (-0.05, 0.05, 0.5)
HEIGHTS = np.array([-0.6, -0.2, -0.05, 0.0, 0.05, 0.2, 0.6])
SOUND = np.zeros(len(HEIGHTS), np.uint8)


def test_heights_have_the_colours_of_the_legend():
    colours = core.height_colours(HEIGHTS, SOUND, *SCALE)
    assert colours.tolist() == core.colour_scale(*SCALE, HEIGHTS).tolist()
    assert len(set(colours[2:5].tolist())) == 1  # one colour in the band
    assert len(set(colours.tolist())) == 5


def test_magnitudes_darken_up_to_the_limit():
    values = np.linspace(0.0, 3.0, 7)
    colours = core.magnitude_colours(values, np.zeros(7, np.uint8), 2.0)
    light = [sum(int(c) >> shift & 255 for shift in (24, 16, 8)) for c in colours]
    assert all(a > b for a, b in zip(light[:4], light[1:5]))
    assert colours[4] == colours[5] == colours[6]  # at the limit and beyond


def test_missed_samples_have_their_own_grey():
    flags = SOUND.copy()
    flags[3] = core.MISSED
    grey = core.height_colours(HEIGHTS, flags, *SCALE)[3]
    assert grey == core.magnitude_colours(HEIGHTS, flags, 1.0)[3]
    assert grey not in core.height_colours(HEIGHTS, SOUND, *SCALE)


def test_faces_differ_from_their_neighbours():
    colours = core.face_colours(np.arange(12, dtype=np.uint32))
    assert len(set(colours.tolist())) == 12
    again = core.face_colours(np.array([3, 3, 0], np.uint32))
    assert again.tolist() == [colours[3], colours[3], colours[0]]


def test_wrong_lengths_are_refused():
    with pytest.raises(InputError, match="7 values for 6 samples"):
        core.height_colours(HEIGHTS, SOUND[1:], *SCALE)
    with pytest.raises(InputError, match="7 values for 6 samples"):
        core.magnitude_colours(HEIGHTS, SOUND[1:], 1.0)


# What is seen of linear red, green, blue without the cones for one of them: Machado, Oliveira, Fernandes, A
# physiologically-based model for simulation of color vision deficiency, IEEE TVCG 15 (2009), severity 1.
VISIONS = {
    "all cones": np.eye(3),
    "protanopia": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "deuteranopia": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    "tritanopia": np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ]
    ),
}
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = np.array([0.9505, 1.0, 1.089])
APART = 25.0  # CIE 1976 colour difference


def lab(colours, vision):
    """(n, 3) CIELAB of colours 0xRRGGBBAA as a vision has them."""
    srgb = np.array([[c >> shift & 255 for shift in (24, 16, 8)] for c in colours]) / 255.0
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    xyz = np.clip(linear @ vision.T, 0.0, 1.0) @ XYZ.T / WHITE
    x, y, z = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16.0 / 116.0).T
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=1)


def nearest(colours, vision):
    """The least difference between two of the colours."""
    found = lab(colours, vision)
    apart = np.linalg.norm(found[:, None] - found, axis=2)
    return apart[np.triu_indices(len(found), 1)].min()


@pytest.mark.parametrize("vision", VISIONS.values(), ids=VISIONS)
def test_any_colour_vision_tells_reasons_and_signs_apart(vision):
    assert nearest([0xFF0000FF, 0xFF0000FF], vision) == 0.0
    assert nearest([*pictures.COLOURS.values(), pictures.INSIDE], vision) > APART
    ends = core.colour_scale(*SCALE, [-0.5, -0.2, 0.0, 0.2, 0.5]).tolist()
    assert nearest(ends, vision) > APART
