"""A surrogate of the contact: support-vector regression trained on a database of solved contacts.

After Zhang, Kuhlenkötter and Kneupner, Int. J. Machine Tools & Manufacture 45 (2005). The database
is made here, from the wheel rim or from CalculiX, or brought along; both files are numpy archives.
"""

from __future__ import annotations

import time
from types import ModuleType
from collections.abc import Callable
from typing import Any

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..engine import InputError, core
from ..job.settings import Compliance, Wheel
from ..job.surrogate_file import LEAST_CONTACTS, WHEEL, core_arguments
from . import single_contact as contacts

CONTACTS = 2000
SAMPLES = 6  # cells of a contact that are learnt
HELD_OUT = 0.1  # of the contacts
COST, EPSILON = 10.0, 0.02
GAMMA = 0.9  # over the number of features


def wheel_of(contact: Json) -> dict[str, float]:
    """The wheel of a validated contact, as a surrogate's file names it."""
    if contact["wheel"]["profile_mm"]:
        raise InputError(
            "contact.surrogate_profile",
            "a surrogate knows no profiled wheels; leave 'profile_mm' out",
        )
    if contact["wheel"]["layers"]:
        raise InputError(
            "contact.surrogate_layers",
            "a surrogate knows no rims of several rubbers; leave out 'layers'",
        )
    wheel = {**contact["wheel"], "youngs_modulus_MPa": contacts.modulus(contact["wheel"])}
    return {key: float(wheel[key]) for key in WHEEL}


def random_gap(random: np.random.Generator, wheel: Json, ds: float) -> tuple[Floats, Floats]:
    """A random surface under the wheel: gap (ny, nx) mm from first touch, inf where there is none,
    and coverage. Curved either way, tilted, rippled, stepped, or a strip with free edges.
    """
    radius, width, rim = wheel["outer_radius_mm"], wheel["width_mm"], wheel["rim_thickness_mm"]
    ny = max(1, round(width / ds))
    half = min(1.0 * radius, np.sqrt(2.0 * radius * rim / 3.0))
    nx = 2 * int(np.ceil(half / ds)) + 1
    s, y = np.meshgrid(
        (np.arange(nx) - (nx - 1) / 2) * ds, (np.arange(ny) - (ny - 1) / 2) * width / ny
    )

    def log_uniform(low: float, high: float) -> float:
        return np.exp(random.uniform(np.log(low), np.log(high)))

    def curvature(most_concave: float) -> float:
        if random.random() < 0.3:
            return 0.0
        return max(
            random.choice([1, 1, -1]) / log_uniform(0.15 * radius, 6.0 * radius), most_concave
        )

    along, across = curvature(-0.7 / radius), curvature(-0.8 / width)
    angle = random.uniform(0.0, np.pi) if random.random() < 0.5 else 0.0
    if angle and random.random() < 0.5:
        along, across = max(along, 0.0), max(across, 0.0)
    off = (
        random.uniform(-0.6, 0.6) * width
        if random.random() < 0.5
        else 0.06 * width * random.normal()
    )
    u = s * np.cos(angle) + (y - off) * np.sin(angle)
    v = -s * np.sin(angle) + (y - off) * np.cos(angle)
    gap = s * s / (2.0 * radius) + 0.5 * along * u * u + 0.5 * across * v * v
    if wheel["crown_radius_mm"] > 0.0:
        crown = wheel["crown_radius_mm"]
        gap = gap + crown - np.sqrt(crown * crown - y * y)
    if random.random() < 0.5:
        gap = gap + np.radians(0.7 * random.normal()) * y
    if random.random() < 0.3:
        length, turn = log_uniform(0.5 * rim, 2.7 * rim), random.uniform(0.0, np.pi)
        phase = 2.0 * np.pi * (s * np.cos(turn) + y * np.sin(turn)) / length
        gap = gap + log_uniform(0.01, 0.15) * np.cos(phase + random.uniform(0.0, 2.0 * np.pi))
    if random.random() < 0.2:
        turn, place = random.uniform(0.0, np.pi), 0.4 * width * random.uniform(-1.0, 1.0)
        q = s * np.cos(turn) + y * np.sin(turn) - place
        gap = gap + log_uniform(0.02, 0.2) * np.tanh(q / random.uniform(2.0, 10.0))
    coverage = np.ones_like(gap)
    if random.random() < 0.35:
        turn = random.choice([0.0, 0.5 * np.pi, random.uniform(0.0, np.pi)])
        q = s * np.sin(turn) + y * np.cos(turn) - random.uniform(-0.45, 0.45) * width
        coverage = np.clip((0.5 * log_uniform(0.2, 1.6) * width - np.abs(q)) / ds + 0.5, 0.0, 1.0)
        coverage = np.where(coverage > 0.02, coverage, 0.0)
        if (coverage * (np.abs(s) < 0.1 * half)).sum() < 4:
            return random_gap(random, wheel, ds)
    gap = np.where(coverage > 0.0, gap, np.inf)
    return gap - gap.min(), coverage


def make_database(
    contact: Json,
    count: int = CONTACTS,
    source: str = "wheel_rim",
    seed: int = 1,
    tell: Callable[[int, int], object] | None = None,
) -> dict[str, Any]:
    """Solves ``count`` random contacts of the validated contact's wheel, on its ``spacing_mm``,
    under a fifth of its ``force_N`` up to twice of it. ``source``: 'wheel_rim' or 'ccx'.
    ``tell(done, count)`` hears of progress. Returns a database (see docs/contact.md).
    """
    if "force_N" not in contact:
        raise InputError(
            "contact.database_force", "{key}: a database of contacts needs 'force_N'", key="contact"
        )
    if count < LEAST_CONTACTS:
        raise InputError(
            "contact.database_too_small",
            "a database needs at least {least} contacts",
            least=LEAST_CONTACTS,
        )
    wheel, ds = wheel_of(contact), float(contact["spacing_mm"])
    shape, elasticity = _core_wheel(wheel), _elasticity(wheel)
    random, start = np.random.default_rng(seed), time.perf_counter()
    rows: list[tuple[Any, ...]] = []
    tried = 0
    while len(rows) < count:
        tried += 1
        if tried > 10 * count:
            raise InputError(
                "contact.database_out_of_reach",
                "nine of ten random contacts reach beyond the grid or do not converge: lower "
                "'force_N'",
            )
        gap, coverage = random_gap(random, wheel, ds)
        force = contact["force_N"] * np.exp(random.uniform(np.log(0.2), np.log(2.0)))
        solved = core.solve_gap(gap, coverage, ds, shape, elasticity, force)
        if not solved["converged"] or solved["pressure"][:, [0, 1, -2, -1]].any():
            continue
        pressure = solved["pressure"]
        if source == "ccx":
            from . import finite_elements as reference

            truth = _finite_elements(reference, solved, contacts.rim(contact))
            if truth is None:
                continue
            covered = np.maximum(coverage, 0.02)
            pressure = np.where(coverage > 0.0, truth["pressure"] / covered, 0.0)
            force = truth["force"]
        rows.append((gap, coverage, pressure, solved["approach"], force))
        if tell:
            tell(len(rows), count)
    columns = [np.array(column, dtype=np.float32) for column in zip(*rows)]
    return {
        **dict(zip(("gap", "coverage", "pressure", "approach", "force"), columns)),
        "ds": np.array(ds),
        "wheel": wheel,
        "source": source,
        "seconds": time.perf_counter() - start,
    }


def _finite_elements(reference: ModuleType, solved: Json, rim: Json) -> dict[str, Any] | None:
    try:
        return reference.solve(solved, rim)
    except InputError as error:
        if error.code == "contact.calculix_failed":  # rather another contact than none
            return None
        raise


def train(database: Json, seed: int = 1) -> tuple[dict[str, Any], dict[str, Any]]:
    """Trains on nine tenths of a database's contacts, tries itself on the rest. Returns
    (surrogate: what ``save`` writes, report: dict of figures).
    """
    random = np.random.default_rng(seed)
    count = len(database["force"])
    order = random.permutation(count)
    held = order[: max(1, int(HELD_OUT * count))]
    wheel, ds = database["wheel"], float(database["ds"])
    rows: list[Floats] = []
    wanted: list[Floats] = []
    for k in order[len(held) :]:
        gap, coverage = database["gap"][k], database["coverage"][k]
        approach = float(database["approach"][k])
        cells, values = core.surrogate_features(
            gap, coverage, ds, wheel["width_mm"], approach, ds, wheel["rim_thickness_mm"]
        )
        chosen = random.permutation(len(cells))[:SAMPLES]
        rows.append(values[chosen])
        greatest = approach - gap[coverage > 0].min()
        wanted.append(database["pressure"][k].ravel()[cells[chosen]] / greatest)
    features, targets = np.concatenate(rows), np.concatenate(wanted)
    start = time.perf_counter()
    regression = core.train_regression(features, targets, COST, GAMMA / features.shape[1], EPSILON)
    seconds = time.perf_counter() - start
    surrogate = {**regression, "cell": ds, "wheel": wheel}
    report = {
        "contacts": count,
        "source": database["source"],
        "database_time_s": database["seconds"],
        "training_samples": len(targets),
        "training_time_s": seconds,
        "support_vectors": len(regression["coefficients"]),
        "held_out_contacts": len(held),
        **_held_out(surrogate, database, held),
    }
    surrogate["report"] = report
    return surrogate, report


def _held_out(surrogate: Json, database: Json, held: Array) -> dict[str, float]:
    errors, approaches, times = [], [], []
    arguments, shape = core_arguments(surrogate, "held out"), _core_wheel(surrogate["wheel"])
    for k in held:
        gap, coverage = database["gap"][k], database["coverage"][k]
        force = float(database["force"][k])
        found = core.solve_gap(gap, coverage, float(database["ds"]), shape, arguments, force)
        truth = coverage * database["pressure"][k]
        errors.append(np.abs(coverage * found["pressure"] - truth).sum() / truth.sum())
        approaches.append(found["approach"] / database["approach"][k] - 1.0)
        times.append(found["time"])
    return {
        "held_out_L1_mean": float(np.mean(errors)),
        "held_out_L1_median": float(np.median(errors)),
        "held_out_L1_p90": float(np.quantile(errors, 0.9)),
        "held_out_approach_rms": float(np.sqrt(np.mean(np.square(approaches)))),
        "solve_time_ms": 1000.0 * float(np.median(times)),
    }


def _core_wheel(wheel: Json) -> Wheel:
    return Wheel(
        radius_mm=wheel["outer_radius_mm"],
        width_mm=wheel["width_mm"],
        crown_radius_mm=wheel["crown_radius_mm"],
        profile_mm=(),
    )


def _elasticity(wheel: Json) -> Compliance:
    return Compliance(
        model="wheel_rim",
        youngs_modulus_MPa=wheel["youngs_modulus_MPa"],
        poissons_ratio=wheel["poissons_ratio"],
        rim_thickness_mm=wheel["rim_thickness_mm"],
        layers=(),
        belt_tension_N_per_mm=wheel["belt_tension_N_per_mm"],
        belt_bending_N_mm=wheel["belt_bending_N_mm"],
        dynamic_modulus_factor=1.0,
        stiffness_MPa_per_mm=0.0,
        surrogate_file="",
    )
