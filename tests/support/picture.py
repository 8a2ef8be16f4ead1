"""Counts colours in a picture."""

import numpy as np
from PIL import Image


def coloured(path):
    """Numbers of brown and of blue pixels: too much left, cut too deep."""
    pixels = np.asarray(Image.open(path).convert("RGB")).astype(int)
    red, _, blue = np.moveaxis(pixels, 2, 0)
    return int((red > blue + 80).sum()), int((blue > red + 60).sum())
