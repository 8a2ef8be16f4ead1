"""Colours of single values, as the live view asks for them, beside those of a height field."""

import numpy as np
import pytest

from beltgrinding.engine import InputError, core

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
