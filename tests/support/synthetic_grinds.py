"""Grinds of made-up laws, whose truth is known: tables to calibrate with, and how often intervals hold it."""

from typing import NamedTuple

import numpy as np

SCATTER = 0.08  # of ln of a grind's removal
WEARS_FROM = 2e4  # J
REFERENCES = {"pressure": 0.1, "speed": 20.0}  # MPa, m/s


class Truth(NamedTuple):
    """A law, drawn at random: dh/dt = K k_t V_ref (V / V_ref)^beta p_ref (p / p_ref)^alpha."""

    alpha: float
    beta: float
    wear: float  # exponent of (1 + W / WEARS_FROM); 0: none
    coefficient: float = 1.25e-4  # mm2/N

    def law(self, factor=1.0):
        """As a job's."""
        wear = {"model": "power", "scale": WEARS_FROM, "exponent": self.wear}
        return {
            "model": "local",
            "coefficient_mm2_per_N": factor * self.coefficient,
            "pressure_exponent": self.alpha,
            "speed_exponent": self.beta,
            "wear": wear if self.wear else {"model": "none"},
        }

    def volume(self, columns):
        """(n,) mm3 of the grinds of a table."""
        force, speed, time, area = (
            columns[key] for key in ("force_N", "belt_speed_m_s", "time_s", "area_mm2")
        )
        pressure = REFERENCES["pressure"] * (force / area / REFERENCES["pressure"]) ** self.alpha
        fast = 1e3 * REFERENCES["speed"] * (speed / REFERENCES["speed"]) ** self.beta
        cut = (1.0 + columns.get("work_J", 0.0) / WEARS_FROM) ** -self.wear
        return self.coefficient * cut * fast * pressure * area * time


def drawn(random, worn):
    """A ``Truth``."""
    wear = random.uniform(0.1, 0.4) if worn else 0.0
    return Truth(random.uniform(0.7, 1.7), random.uniform(1.0, 1.5), wear)


def inputs(random, count, worn, areas=True):
    """Columns of ``count`` grinds."""
    columns = {
        "force_N": random.uniform(10, 60, count),
        "belt_speed_m_s": random.uniform(12, 30, count),
        "time_s": random.uniform(5, 30, count),
        "area_mm2": random.uniform(100, 400, count) if areas else np.full(count, 200.0),
    }
    if worn:
        columns["work_J"] = random.uniform(0, 2e5, count)
    return columns


def measured(random, truth, columns):
    """(n,) mm3 as they would be measured."""
    volume = truth.volume(columns)
    return volume * random.lognormal(0.0, SCATTER, len(volume))
