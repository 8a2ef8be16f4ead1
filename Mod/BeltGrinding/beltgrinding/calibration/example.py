"""A table of made-up grinds: what a table for a calibration looks like, and one to try it with."""

from __future__ import annotations

import numpy as np

GRINDS = 32
COEFFICIENT, SCATTER = 2.0e-5, 0.06  # mm2/N of a linear law; of its removals
HEADER = "force_N,belt_speed_m_s,time_s,area_mm2,work_J,removed_volume_mm3"


def table() -> str:
    """The text of a CSV file: grinds by V = K V_b F t with some scatter, each input over a range."""
    chance = np.random.default_rng(7)
    force, speed = chance.uniform(8.0, 60.0, GRINDS), chance.uniform(10.0, 30.0, GRINDS)
    time, area = chance.uniform(4.0, 20.0, GRINDS), chance.uniform(80.0, 240.0, GRINDS)
    scatter = np.exp(chance.normal(0.0, SCATTER, GRINDS))
    volume = COEFFICIENT * 1000.0 * speed * force * time * scatter
    work = np.cumsum(force * speed * time) - force * speed * time
    lines = [
        "# made up, to show the columns; a row a grind. Units stand in the names.",
        "# work_J: what the belt has done before, force times belt speed times time; may be left out.",
        HEADER,
    ]
    for row in zip(force, speed, time, area, work, volume):
        lines.append("{:.1f},{:.2f},{:.1f},{:.0f},{:.0f},{:.2f}".format(*row))
    return "\n".join(lines) + "\n"
