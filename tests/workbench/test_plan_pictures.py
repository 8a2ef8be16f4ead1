"""The pictures of a plan, side by side."""

import io

import numpy as np
from PIL import Image

from beltgrinding.planning import pictures


def test_sides_that_are_a_pixel_higher_lie_side_by_side():
    """Stock on the part moves its outline, and with it the picture's size."""
    drawn = [
        [np.full((rows, 640, 3), shade, dtype=np.uint8) for shade in (10, 200)]
        for rows in (767, 768, 767)
    ]
    shown = pictures.Pictures(*pictures._small(drawn))
    assert all(side.shape == shown.before[0].shape for sides in shown for side in sides)
    strip = Image.open(io.BytesIO(pictures.strip(shown)))
    assert strip.width == 3 * pictures.WIDTH
    shares = {word: 0.1 for word in pictures.reasons.WORDS.values()}
    assert Image.open(io.BytesIO(pictures.composed(shown, shares))).width >= strip.width
