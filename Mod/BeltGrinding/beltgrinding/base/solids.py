"""Simple solids as points and triangles, for collisions and for what is drawn."""

import numpy as np


def box(low, high):
    """(points (8, 3), triangles (12, 3)) between two corners."""
    corners = np.array([[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners, triangles(quads)


def prism():
    """Triangles (12, 3) between four corners at one end and four at the other."""
    sides = [[k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k] for k in range(4)]
    return triangles([[3, 2, 1, 0], [4, 5, 6, 7], *sides])


def triangles(quads):
    """(2 n, 3): two of each quad."""
    return np.array([t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])])
