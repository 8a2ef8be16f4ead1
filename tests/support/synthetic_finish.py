"""SYNTHETIC roughness measurements: made up, to try the calibration of the finish. None of their figures is of a real belt."""

import numpy as np

TRUTH = {  # of the made-up belt
    "coefficient_um": 0.7,  # at the references
    "grit_exponent": -0.75,
    "pressure_exponent": 0.35,
    "belt_speed_exponent": -0.45,
    "feed_exponent": 0.2,
    "wear_exponent": 0.5,
    "rest_per_pass": 0.35,
}
REFERENCES = {"grit": 120.0, "pressure": 0.1, "speed": 20.0, "feed": 50.0}


def columns(count=40, scatter=0.1, seed=1, passes=True, fixed=()):
    """dict of columns of ``count`` measurements, ln Ra scattered by ``scatter``; ``passes``: after one to four passes
    from 3.2 µm, else after many; columns named in ``fixed`` do not vary."""
    random = np.random.default_rng(seed)
    spread = lambda low, high: np.exp(random.uniform(np.log(low), np.log(high), count))
    c = {
        "grit": random.choice([60.0, 120.0, 240.0, 400.0], count),
        "pressure_MPa": spread(0.03, 0.3),
        "belt_speed_m_s": spread(10.0, 35.0),
        "feed_mm_s": spread(15.0, 120.0),
        "remaining_cut": spread(0.4, 1.0),
    }
    for name in fixed:
        c[name] = np.full(count, np.median(c[name]))
    ra = steady(c)
    if passes:
        c["passes"] = random.integers(1, 5, count).astype(float)
        c["initial_Ra_um"] = np.full(count, 3.2)
        left = TRUTH["rest_per_pass"] ** c["passes"]
        ra = ra + left * (3.2 - ra)
    c["Ra_um"] = ra * np.exp(scatter * random.standard_normal(count))
    return {name: values.tolist() for name, values in c.items()}


def steady(c):
    """(n,) Ra, µm, of the made-up belt after many passes."""
    return (
        TRUTH["coefficient_um"]
        * (np.asarray(c["grit"]) / REFERENCES["grit"]) ** TRUTH["grit_exponent"]
        * (np.asarray(c["pressure_MPa"]) / REFERENCES["pressure"]) ** TRUTH["pressure_exponent"]
        * (np.asarray(c["belt_speed_m_s"]) / REFERENCES["speed"]) ** TRUTH["belt_speed_exponent"]
        * (np.asarray(c["feed_mm_s"]) / REFERENCES["feed"]) ** TRUTH["feed_exponent"]
        * np.asarray(c["remaining_cut"]) ** TRUTH["wear_exponent"]
    )


def write(path, table):
    """Writes columns as a CSV."""
    rows = [",".join(table), *(",".join(f"{x:.9g}" for x in row) for row in zip(*table.values()))]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    return path


def model():
    """A job's ``finish.model`` of the made-up belt itself."""
    exponents = {name: value for name, value in TRUTH.items() if name != "rest_per_pass"}
    return {
        **exponents,
        "reference_grit": REFERENCES["grit"],
        "reference_pressure_MPa": REFERENCES["pressure"],
        "reference_belt_speed_m_s": REFERENCES["speed"],
        "reference_feed_mm_s": REFERENCES["feed"],
        "rest_per_pass": TRUTH["rest_per_pass"],
        "ln_deviation": 0.1,
        "ranges": {
            "grit": [60.0, 400.0],
            "pressure_MPa": [0.0, 10.0],
            "belt_speed_m_s": [10.0, 35.0],
            "feed_mm_s": [15.0, 120.0],
            "remaining_cut": [0.4, 1.0],
        },
        "source": "SYNTHETIC, no measurement",
    }
