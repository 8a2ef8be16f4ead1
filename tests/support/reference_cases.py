"""What the product says beside what others say: finite elements, closed forms, measured grinds. ``all_cases()`` are what
docs/validation.md is made of."""

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

import beltgrinding
from beltgrinding.contact import single_contact
from beltgrinding.engine import core
from support import held_out
from support.freecad import SHARED

REFERENCE = SHARED / "reference"
WHEEL = {"outer_radius_mm": 100, "width_mm": 50, "rim_thickness_mm": 15, "youngs_modulus_MPa": 5}
WORKPIECES = {  # of the finite elements, by the file's name
    "flat": ("plane", {"shape": "plane"}),
    "cyl": ("cylinder of 50 mm along the feed", {"shape": "cylinder", "radius_mm": 50.0}),
    "edgeY": ("edge under the middle", {"shape": "edge"}),
    "rib5": ("rib of 5 mm", {"shape": "strip", "width_mm": 5.0, "axis_angle_deg": 90.0}),
    "tilt3f": ("plane tilted by 3°", {"shape": "plane", "tilt_deg": 3.0}),
}


class Figure(NamedTuple):
    """One figure of a case: its name, the error as a share, the share that is aimed at."""

    name: str
    error: float
    aim: float


class Case(NamedTuple):
    """One comparison. ``ours``, ``theirs``: (x, y) of a curve each, (n,); ``axes``: what x and y are, with units."""

    group: str
    name: str
    figures: list[Figure]
    ours: tuple[np.ndarray, np.ndarray]
    theirs: tuple[np.ndarray, np.ndarray]
    axes: tuple[str, str]
    dots: bool = False  # points without a line, ours over theirs


def all_cases() -> Iterator[Case]:
    """The cases; those on shared data only where it is."""
    if REFERENCE.is_dir():
        yield from wheels()
    for make in (removal, wear, force_lag):
        yield make()
    yield from moving_heat()
    if held_out.TABLE.is_file():
        yield measured_grinds()


# Finite elements -----------------------------------------------------------------------------------------------------


def wheels() -> Iterator[Case]:
    """A wheel's rim on rigid workpieces, by CalculiX, neo-Hookean where there is such."""
    for path in sorted(REFERENCE.glob("fem_*_nu*_F*.csv")):
        shape, nu, material = re.match(r"fem_([^_]+)_nu([\d.]+)_(\w+)_F", path.name).groups()
        if shape in WORKPIECES and (material == "neo" or nu == "0.49"):
            yield wheel(path, shape, float(nu), material)


def wheel(path, shape: str, nu: float, material: str) -> Case:
    text = path.read_text()
    force = float(re.search(r"F=([\d.]+) N", text).group(1))
    approach = float(re.search(r"delta=([\d.]+)", text).group(1))
    name, workpiece = WORKPIECES[shape]
    given = {"wheel": {**WHEEL, "poissons_ratio": nu}, "workpiece": workpiece, "force_N": force}
    result = single_contact.run(single_contact.validate(given))
    across = shape != "rib5"  # rows along the wheel's axis, but of the rib along the feed
    at = result["y" if across else "x"]
    loads = (result["pressure"] * result["coverage"] * result["cell_area"]).sum(1 if across else 0)
    middles, theirs = rows(text, across)
    ours = np.array([within(at, loads, m - 0.5, m + 0.5) for m in middles])
    off = np.abs(ours - theirs * ours.sum() / theirs.sum()).sum() / ours.sum()
    law = "linear" if material == "lin" else "neo-Hookean"
    return Case(
        "Elastic contact",
        f"{name}, ν {nu:g}, {law}, {force:.0f} N",
        [Figure("approach", result["approach"] / approach - 1, 0.02), Figure("rows", off, 0.04)],
        (middles, ours),
        (middles, theirs),
        ("mm along the wheel's axis" if across else "mm along the feed", "N of a row of 1 mm"),
    )


def rows(text: str, across: bool) -> tuple[np.ndarray, np.ndarray]:
    """(mm, N) of rows of 1 mm: as the file lists them, or sums of its quarter's cells."""
    if found := re.search(r"row forces.*", text):
        pairs = re.findall(r"(-?[\d.]+):([\d.]+)", found.group(0))
        return tuple(np.array(pairs, dtype=float).T)
    cells = np.array(
        [line.split(",")[:3] for line in text.splitlines() if line[:1].isdigit()], dtype=float
    )
    at = np.unique(cells[:, 1 if across else 0])
    sums = np.array([2.0 * cells[cells[:, 1 if across else 0] == a, 2].sum() for a in at])
    return np.concatenate([-at[::-1], at]), np.concatenate([sums[::-1], sums])


def within(at: np.ndarray, loads: np.ndarray, low: float, high: float) -> float:
    """Of loads that are spread evenly over cells round ``at``, what lies from ``low`` to ``high``."""
    half = 0.5 * (at[1] - at[0])
    inside = np.minimum(at + half, high) - np.maximum(at - half, low)
    return float((np.clip(inside, 0.0, None) / (2.0 * half) * loads).sum())


# Whole jobs against closed forms -------------------------------------------------------------------------------------

BELT_SPEED, FEED, FORCE, RADIUS, WIDTH = 20.0, 40.0, 30.0, 40.0, 16.0
LOOKING_DOWN = {"qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}


def slab(length: float, width: float, height: float) -> str:
    """A faceted box as BREP text, its second face at z = 0."""
    corners = [
        (x, y, z) for z in (-height, 0) for y in (-width / 2, width / 2) for x in (0, length)
    ]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    mesh = core.TriangleMesh(np.array(corners, np.float32), np.array(triangles, np.uint32))
    return core.shape_from_mesh(mesh).write_brep()


def pass_over(length, start, end, *, feed=FEED, width=24.0, height=10.0, poses=2, **job):
    """The result of a pass along x over a slab's top."""
    places = [
        {"x_mm": float(x), "y_mm": 0.0, "z_mm": 0.0, "feed_mm_s": feed} | LOOKING_DOWN
        for x in np.linspace(start, end, poses)
    ]
    machine = {
        "wheel": {"radius_mm": RADIUS, "width_mm": WIDTH},
        "force_N": FORCE,
        "belt_speed_m_s": BELT_SPEED,
        **job.pop("belt_machine", {}),
    }
    given = {
        "design": {"brep": slab(length, width, height), "faces": [2]},
        "sampling": {"spacing_mm": 0.5},
        "stock": {"allowance_mm": 2.0},
        "belt_machine": machine,
        "cell": {"check_collisions": False},
        "programs": [{"poses": job.pop("way", places)}],
        **job,
    }
    return beltgrinding.run(given)


def removal() -> Case:
    """The removed volume over time against coefficient x force x belt speed x time."""
    coefficient = 2e-6
    result = pass_over(60, 5, 55, law={"coefficient_mm2_per_N": coefficient})
    time, work, volume = so_far(result)
    wanted = coefficient * 1000.0 * work
    error = Figure("volume", volume[-1] / wanted[-1] - 1.0, 0.001)
    axes = ("s", "mm³ removed")
    return Case("Removal", "volume = K F V t", [error], (time, volume), (time, wanted), axes)


def wear() -> Case:
    """The same with a belt whose cut falls exponentially with the work of the force."""
    coefficient, scale = 2e-6, 4000.0  # mm2/N, J
    law = {
        "coefficient_mm2_per_N": coefficient,
        "wear": {"model": "exponential", "scale": scale, "rest": 0.0},
    }
    _, work, volume = so_far(pass_over(60, 5, 55, law=law))
    wanted = coefficient * 1000.0 * scale * (1.0 - np.exp(-work / scale))
    off = np.abs(volume - wanted).max() / wanted[-1]
    name, axes = "belt wear, exp(-W / 4 kJ)", ("J of the force's work", "mm³ removed")
    return Case(
        "Removal", name, [Figure("volume", off, 0.005)], (work, volume), (work, wanted), axes
    )


def so_far(result):
    """(s, J of the force at belt speed, mm3 removed) at the end of every step."""
    steps = {key: np.asarray(values, dtype=float) for key, values in result.steps.items()}
    duration = steps["duration"]
    work = np.cumsum(steps["force"] * BELT_SPEED * duration)
    return np.cumsum(duration), work, np.cumsum(steps["removal_rate"] * duration)


def force_lag() -> Case:
    """A commanded step of force that a device of first order follows."""
    lag, at = 0.05, 25.0  # s, mm
    place = {"y_mm": 0.0, "z_mm": 0.0, "feed_mm_s": 60.0} | LOOKING_DOWN
    way = [place | {"x_mm": x, "force_N": n} for x, n in ((10.0, 20.0), (at, 20.0), (50.0, 40.0))]
    machine = {"force_dynamics": {"model": "lag", "lag_s": lag}}
    steps = pass_over(60, 10, 50, way=way, belt_machine=machine).steps
    time, duration, force = (
        np.asarray(steps[key], dtype=float) for key in ("time", "duration", "force")
    )
    change = (at - 10.0) / 60.0
    begin, end = (np.maximum(time + half * duration - change, 0.0) for half in (-0.5, 0.5))
    fallen = lag * (np.exp(-begin / lag) - np.exp(-end / lag)) / duration
    wanted = np.where(end > 0.0, 40.0 - 20.0 * fallen, 20.0)
    clear = (begin > 0.0) | (end <= 0.0)
    time, force, wanted = time[clear], force[clear], wanted[clear]
    error = Figure("force", np.abs(force - wanted).max() / 20.0, 0.02)
    axes = ("s", "N, mean of a step")
    return Case("Force", "step of force, lag 0.05 s", [error], (time, force), (time, wanted), axes)


# Heat ----------------------------------------------------------------------------------------------------------------

METALS = {  # W/(m K), J/(kg K), kg/m3
    "steel": (16.0, 500.0, 8000.0),
    "carbon steel": (45.0, 470.0, 7850.0),
    "titanium": (7.0, 560.0, 4430.0),
    "aluminium": (160.0, 900.0, 2700.0),
}
HEATED = (("steel", 40.0), ("steel", 10.0), ("carbon steel", 40.0), ("titanium", 40.0))
HEATED += (("aluminium", 100.0),)  # mm/s
PARTITION = 0.2  # share of the force's power at belt speed that flows into the work


def moving_heat() -> Iterator[Case]:
    """The greatest temperature across a pass against Jaeger's point source summed over the product's own pressure."""
    wheel = {"outer_radius_mm": RADIUS, "width_mm": WIDTH, "rim_thickness_mm": 15}
    wheel |= {"youngs_modulus_MPa": 5, "poissons_ratio": 0.45}
    given = {"wheel": wheel, "workpiece": {"shape": "plane"}, "force_N": FORCE, "spacing_mm": 0.25}
    pressed = single_contact.run(single_contact.validate(given))
    for metal, feed in HEATED:
        conductivity, capacity, density = METALS[metal]
        heat = {"conductivity_W_mK": conductivity, "heat_capacity_J_kgK": capacity}
        heat |= {"density_kg_m3": density, "friction": [0.4, 0.4]}
        heat |= {"partition": [PARTITION / 0.4, PARTITION / 0.4]}
        law = {"coefficient_mm2_per_N": 1e-12}
        result = pass_over(120, 10, 110, feed=feed, height=60.0, heat=heat, law=law)
        points = np.asarray(result.field.points, dtype=float)
        steady = (points[:, 0] > 70.0) & (points[:, 0] < 95.0) & (np.abs(points[:, 1]) < WIDTH / 2)
        rise = np.asarray(result.field.heat["rise"], dtype=float)[steady]
        across, which = np.unique(np.round(np.abs(points[steady, 1]), 6), return_inverse=True)
        ours = np.bincount(which, weights=rise) / np.bincount(which)
        y, truth = jaeger(pressed, metal, feed)
        theirs = np.interp(across, y, truth)
        middle, side = across < WIDTH / 4, across > WIDTH / 2 - 0.6
        off = ours / theirs - 1.0
        figures = [
            Figure("middle", off[middle][np.abs(off[middle]).argmax()], 0.01),
            Figure("side", off[side][np.abs(off[side]).argmax()], 0.03),
        ]
        axes = ("mm from the pass's middle", "K, greatest rise")
        name = f"{metal}, {feed:.0f} mm/s"
        yield Case("Heat", name, figures, (across, ours), (across, theirs), axes)


def jaeger(pressed, metal: str, feed: float):
    """(mm across (n,), K (n,)): the greatest rise along each line, of a steady contact on a half-space."""
    conductivity, capacity, density = METALS[metal]
    diffusivity = conductivity / (density * capacity) * 1e6  # mm2/s
    x, y = np.asarray(pressed["x"]), np.asarray(pressed["y"])
    cell = x[1] - x[0]
    flux = PARTITION * np.asarray(pressed["pressure"]) * BELT_SPEED  # W/mm2
    parts = 9  # of a cell, each way, over which the source is averaged
    inner = (np.arange(parts) - (parts - 1) / 2) * cell / parts
    ahead = np.arange(-len(x) + 1, len(x)) * cell
    aside = np.arange(-len(y) + 1, len(y)) * cell
    kernel = np.zeros((len(aside), len(ahead)))
    for dy in inner:
        for dx in inner:
            along = (ahead + dx)[None, :]
            away = np.hypot(along, (aside + dy)[:, None])
            # The middle part holds the source itself: the mean of 1/r over a square of edge h is 3.5255/h.
            away = np.where(away < 1e-9, cell / parts / 3.5255, away)
            kernel += np.exp(-feed * (away + along) / (2.0 * diffusivity)) / away / parts**2
    kernel *= cell**2 / (2.0 * np.pi * conductivity * 1e-3)  # K per W/mm2
    shape = [a + b - 1 for a, b in zip(flux.shape, kernel.shape)]
    sums = np.fft.irfft2(np.fft.rfft2(flux, shape) * np.fft.rfft2(kernel, shape), shape)
    rise = sums[len(y) - 1 : 2 * len(y) - 1]  # along the line: from far behind to far ahead
    return np.abs(y[y >= 0]), rise.max(axis=1)[y >= 0]


# Measured grinds -----------------------------------------------------------------------------------------------------


def measured_grinds() -> Case:
    """Each half of the grinds predicted from the other; the law, and an ordinary power law beside it."""
    table = held_out.tables()["known areas"]
    measured, said, plain = [], [], []
    for fitted, held in held_out.halves(len(table.force), 0):
        one, other = table.take(fitted), table.take(held)
        measured.append(other.measured)
        said.append(held_out.law(one, other)[0])
        plain.append(held_out.power_law(one, other))
    truth, ours, power = map(np.concatenate, (measured, said, plain))
    figures = [
        Figure("median", float(np.median(np.abs(ours / truth - 1.0))), 0.15),
        Figure("power law's median", float(np.median(np.abs(power / truth - 1.0))), 0.15),
    ]
    line = np.array([truth.min(), truth.max()])
    axes = ("mm³ measured", "mm³ predicted")
    return Case("Measured grinds", "never seen", figures, (truth, ours), (line, line), axes, True)
