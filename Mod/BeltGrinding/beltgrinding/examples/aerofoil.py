"""The geometry of a compressor blade from published aerofoil data; numpy only, mm.

Thickness: NACA 65-010 basic thickness form, stations and ordinates in percent of the chord, from
Abbott, von Doenhoff and Stivers, Summary of Airfoil Data, NACA Report 824 (1945), appendix I, as used
for compressor cascades by Emery et al., NACA Report 1368 (1958). Camber: the a = 1.0 mean line of the
same report, scaled by the free-air lift coefficient.
"""

import math

import numpy as np

# percent of the chord: station, half thickness of the 10 % thick section
NACA_65_010 = np.array(
    [
        (0.0, 0.0), (0.5, 0.772), (0.75, 0.932), (1.25, 1.169), (2.5, 1.574), (5.0, 2.177),
        (7.5, 2.647), (10.0, 3.040), (15.0, 3.666), (20.0, 4.143), (25.0, 4.503), (30.0, 4.760),
        (35.0, 4.924), (40.0, 4.996), (45.0, 4.963), (50.0, 4.812), (55.0, 4.530), (60.0, 4.146),
        (65.0, 3.682), (70.0, 3.156), (75.0, 2.584), (80.0, 1.987), (85.0, 1.385), (90.0, 0.810),
        (95.0, 0.306), (100.0, 0.0),
    ]
)  # fmt: skip
TRAILING_EDGE = 0.012  # of the chord: half thickness that is added towards the trailing edge


def mean_line(x, lift):
    """Ordinate and slope of the a = 1.0 mean line at x in (0, 1) of the chord."""
    x = np.clip(x, 1e-4, 1 - 1e-4)
    factor = lift / (4 * math.pi)
    y = -factor * ((1 - x) * np.log(1 - x) + x * np.log(x))
    return y, factor * (np.log(1 - x) - np.log(x))


def natural_spline(x, y, at):
    """Values at ``at`` of the natural cubic spline through (x, y); all (n,), x increasing."""
    h = np.diff(x)
    matrix = np.eye(len(x))
    right = np.zeros(len(x))
    for i in range(1, len(x) - 1):
        matrix[i, i - 1 : i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        right[i] = 6 * ((y[i + 1] - y[i]) / h[i] - (y[i] - y[i - 1]) / h[i - 1])
    m = np.linalg.solve(matrix, right)
    k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(h) - 1)
    a, b = (x[k + 1] - at) / h[k], (at - x[k]) / h[k]
    bend = (a**3 - a) * m[k] + (b**3 - b) * m[k + 1]
    return a * y[k] + b * y[k + 1] + bend * h[k] ** 2 / 6


def section(chord, thickness, lift, count=61):
    """Pressure and suction side of a section, each (count, 2) in mm from leading to trailing edge.

    ``thickness``: greatest thickness as a share of the chord; ``lift``: design lift coefficient of
    the mean line, positive: the suction side is the upper (+y) one. x from 0 to chord.
    """
    t = 0.5 * (1 - np.cos(np.linspace(0, math.pi, count)))
    # In the root of x the rounded leading edge is smooth.
    half = natural_spline(np.sqrt(NACA_65_010[:, 0] / 100), NACA_65_010[:, 1] / 100, np.sqrt(t))
    half = half * thickness / 0.10 + TRAILING_EDGE * t**4
    y, slope = mean_line(t, lift)
    y[0] = y[-1] = 0.0
    slope[0], slope[-1] = slope[1], slope[-2]
    angle = np.arctan(slope)
    normal = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    centre = np.stack([t, y], axis=1)
    offset = half[:, None] * normal
    return chord * (centre - offset), chord * (centre + offset)


def placed(side, chord, stagger_deg, height):
    """A side (n, 2) turned by the stagger angle about mid-chord, at the height z: (n, 3)."""
    a = math.radians(stagger_deg)
    x, y = side[:, 0] - 0.5 * chord, side[:, 1]
    return np.stack(
        [
            x * math.cos(a) - y * math.sin(a),
            x * math.sin(a) + y * math.cos(a),
            np.full(len(x), height),
        ],
        axis=1,
    )


# Span station (mm), chord (mm), thickness, lift coefficient, stagger (degrees): root to tip.
STATIONS = (
    (0.0, 64.0, 0.105, 1.00, 18.0),
    (30.0, 62.0, 0.095, 0.90, 24.0),
    (60.0, 60.0, 0.085, 0.80, 30.0),
    (90.0, 58.0, 0.075, 0.70, 36.0),
    (120.0, 56.0, 0.065, 0.60, 42.0),
)


def blade_sides():
    """Pressure and suction sides of all stations: two lists of (n, 3) arrays, mm."""
    pressure, suction = [], []
    for height, chord, thickness, lift, stagger in STATIONS:
        low, high = section(chord, thickness, lift)
        pressure.append(placed(low, chord, stagger, height))
        suction.append(placed(high, chord, stagger, height))
    return pressure, suction
