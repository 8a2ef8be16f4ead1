"""Random jobs made from the job's schema, so that a new key is tried by itself: valid ones, and nearly valid ones, of
which one or two keys are at the edge of what is allowed, or beyond.

Job ``number`` of ``seed`` is the same each time. Parts and programs are those in the folder parts (our own making).
"""

import copy
import json
import math
import random
import tempfile
from functools import lru_cache
from pathlib import Path

import numpy as np

from beltgrinding.base import frames
from beltgrinding.engine import core
from beltgrinding.job import load as jobs, workpiece
from beltgrinding.presets import library

PARTS = Path(__file__).resolve().parent / "parts"
SIZE = 30.0  # mm, of a part
NAMES = ("box", "cylinder", "cone", "torus", "sphere", "fillet", "steps")
IDENTITY = {"position_mm": [0.0, 0.0, 0.0], "quaternion_wxyz": [1.0, 0.0, 0.0, 0.0]}
POSE = dict.fromkeys(("x_mm", "y_mm", "z_mm", "qx", "qy", "qz"), 0.0) | {"qw": 1.0}
SOMETIMES = 0.35  # how often a key that may be missing is there
FAR = 0.04  # how often a number is anywhere in its range


def job(seed, number, nearly=False):
    """Job ``number`` of ``seed``, a dict; ``nearly``: with one or two keys at the edge or beyond."""
    dice = random.Random(f"{seed} {number} {nearly}")
    found = _Maker(dice).job()
    if nearly:
        for _ in range(dice.choice((1, 1, 2))):
            spoil(dice, found)
    return found


class _Maker:
    """Values for the schema's rules, by ``dice``; what only fits together with others is made by hand."""

    def __init__(self, dice):
        self.dice, self.rules = dice, jobs.schema()
        self.part = dice.choice(NAMES)
        count = _faces(self.part)
        some = dice.sample(range(1, count + 1), dice.randint(1, count))
        self.faces = [] if dice.random() < 0.4 else sorted(some)

    def job(self):
        dice, made = self.dice, {}
        for name, rule in self.rules["properties"].items():
            if name not in ("design", "programs") and dice.random() < 0.6:
                made[name] = self.value(rule, (name,))
        made["design"] = self.design()
        self.mend(made)
        made["programs"] = [self.program(made) for _ in range(dice.choice((1, 1, 1, 2)))]
        if not made.get("law", {}).get("wear", {}).get("loading_share"):
            for program in made["programs"]:
                program.pop("dress", None)
        return made

    def value(self, rule, way):
        """A value that the rule allows."""
        dice, name = self.dice, way[-1]
        own = getattr(self, f"{way[0]}_{name}", None) or getattr(self, f"any_{name}", None)
        if own and len(way) > 1:
            return own()
        if "$ref" in rule:
            return self.frame()
        if "const" in rule:
            return rule["const"]
        if "enum" in rule:
            return dice.choice(rule["enum"])
        kind = rule["type"]
        if kind == "object":
            return self.object(rule, way)
        if kind == "array":
            least, most = rule.get("minItems", 0), rule.get("maxItems", 3)
            count = least if least == most else dice.randint(least, min(most, least + 3))
            found = [self.value(rule["items"], (*way, "item")) for _ in range(count)]
            return found if not rule.get("uniqueItems") else sorted(set(found))
        if kind == "boolean":
            return dice.random() < 0.5
        if kind == "string":
            return dice.choice(("a", "Ünïcode ✓", "two words")) if rule.get("minLength") else ""
        return number(dice, rule)

    def object(self, rule, way):
        required = rule.get("required", ())
        found = {}
        for name, inner in rule.get("properties", {}).items():
            if name in required or self.dice.random() < SOMETIMES:
                found[name] = self.value(inner, (*way, name))
        return found

    # By hand: what must fit the part, itself or other keys.

    def design(self):
        where = {"file": str(PARTS / f"{self.part}.brep")}
        if self.dice.random() < 0.1:
            where = {"brep": (PARTS / f"{self.part}.brep").read_text()}
        return {**where, "faces": self.faces, "flip_normals": False, "unit_mm": 1}

    def any_placement(self):
        return {"position_mm": [self.dice.gauss(0, 0.2) for _ in range(3)]}

    def frame(self):
        turn = np.array([self.dice.gauss(0, 1) for _ in range(4)])
        turn /= np.linalg.norm(turn)
        place = [self.dice.uniform(-500, 500) for _ in range(3)]
        return {"position_mm": place, "quaternion_wxyz": turn.tolist()}

    def sampling_spacing_mm(self):
        return self.dice.choice((1.5, 2.0, 3.0))

    def sampling_precision_mm(self):
        return self.dice.choice((0.0, 0.0, 0.05))

    def sampling_edge_spacing_mm(self):
        return self.dice.choice((0.0, 1.0))

    def stock_file(self):
        return str(PARTS / "slab.ply")

    def stock_left_by(self):
        return str(_left(self.part))

    def stock_brep(self):
        return (PARTS / f"{self.part}.brep").read_text()

    def belt_machine_contact_spacing_mm(self):
        return self.dice.choice((1.0, 2.0, 3.0))

    def belt_machine_contact_tolerance(self):
        return self.dice.choice((1e-4, 1e-3, 1e-2, 0.1))

    def belt_machine_radius_mm(self):
        return SIZE * 10.0 ** self.dice.uniform(-0.7, 0.7)

    def belt_machine_width_mm(self):
        return SIZE * 10.0 ** self.dice.uniform(-1.0, 0.3)

    def belt_machine_length_mm(self):
        return SIZE * 10.0 ** self.dice.uniform(-0.3, 1.0)

    def platen_length(self, machine):
        """A platen between its rollers that turns by less than 60 degrees."""
        run, platen = machine.setdefault("free_run", {}), machine.setdefault("platen", {})
        run["position_mm"] = 0.1 * run.setdefault("length_mm", 200.0)
        platen["length_mm"] = 0.3 * run["length_mm"]
        if platen.get("radius_mm"):
            platen["radius_mm"] = platen["length_mm"] * self.dice.uniform(0.7, 5.0)
        machine.get("frame", {}).pop("length_mm", None)

    def belt_machine_profile_mm(self):
        if self.dice.random() < 0.7:
            return []
        half = self.dice.uniform(3.0, 10.0)
        return [[y, abs(self.dice.gauss(0, 0.3))] for y in np.linspace(-half, half, 5).tolist()]

    def belt_machine_surrogate_file(self):
        return ""

    def law_curve(self):
        return self.falling(1e4, self.dice.randint(0, 4))

    def law_pressure_curve(self):
        return self.rising(1e-3, 2.0)

    def law_speed_curve(self):
        return self.rising(1.0, 60.0)

    def law_feed_curve(self):
        return self.rising(1.0, 500.0)

    def law_land_curve(self):
        return self.rising(0.1, 1.0)

    def rising(self, low, high):
        if self.dice.random() < 0.6:
            return []
        at = sorted(
            low * (high / low) ** self.dice.random() for _ in range(self.dice.randint(2, 5))
        )
        return [[x, 10.0 ** self.dice.uniform(-1, 1)] for x in at]

    def falling(self, scale, count):
        if count < 2:
            return []
        shares = sorted((self.dice.random() for _ in range(count - 1)), reverse=True)
        at = sorted(scale * 10.0 ** self.dice.uniform(-3, 0) for _ in range(count - 1))
        return [[0.0, 1.0], *([x, share] for x, share in zip(at, shares))]

    def law_calibration(self):
        names = ["coefficient", "pressure_exponent", "speed_exponent"][: self.dice.randint(0, 3)]
        if not names:
            return {}
        root = [[0.2 * self.dice.gauss(0, 1) for _ in names] for _ in names]
        covariance = (np.array(root) @ np.array(root).T).tolist()
        more = {"freedom": self.dice.uniform(1, 40), "widening": self.dice.uniform(1, 3)}
        return {
            "parameters": names,
            "covariance": covariance,
            "scatter": 0.1,
            **{name: value for name, value in more.items() if self.dice.random() < SOMETIMES},
        }

    def finish_model(self):
        more = {"rest_per_pass": 0.3, "ln_deviation": 0.1, "source": "made up", "calibration": {}}
        return {
            **{name: value for name, value in more.items() if self.dice.random() < SOMETIMES},
            "coefficient_um": 0.7,
            **{
                f"{name}_exponent": self.dice.gauss(0, 0.5)
                for name in ("grit", "pressure", "belt_speed", "feed", "wear")
            },
            "reference_grit": 120.0,
            "reference_pressure_MPa": 0.1,
            "reference_belt_speed_m_s": 20.0,
            "reference_feed_mm_s": 50.0,
            "ranges": {
                "grit": [40, 400],
                "pressure_MPa": [0.001, 1.0],
                "belt_speed_m_s": [2, 60],
                "feed_mm_s": [1, 500],
                "remaining_cut": [0.1, 1],
            },
        }

    def finish_grit(self):
        return self.dice.choice((60, 120, 240.5))

    def heat_conductivity_W_mK(self):
        return 10.0 ** self.dice.uniform(0, 2.6)

    def heat_heat_capacity_J_kgK(self):
        return self.dice.uniform(100.0, 2000.0)

    def heat_density_kg_m3(self):
        return self.dice.uniform(1500.0, 20000.0)

    def heat_friction(self):
        return [self.dice.uniform(0.1, 1.0) for _ in range(2)]

    def cell_file(self):
        return str(PARTS / "box.brep")

    def cell_brep(self):
        return (PARTS / "box.brep").read_text()

    def robot_preset(self):
        return self.dice.choice(_robots())

    def robot_controller(self):
        return self.dice.choice(("", *(one["id"] for one in library.controllers())))

    def robot_model(self):
        return {}

    def robot_packages(self):
        return []

    def robot_external_axes(self):
        track = {"kind": "linear", "carries": "robot", "axis": [0.0, 1.0, 0.0]}
        limits = {"lower": -500.0, "upper": 500.0, "position": self.dice.uniform(-500, 500)}
        more = {"home": self.dice.uniform(-500, 500), "max_speed": 200.0, "origin_mm": [0.0] * 3}
        more["motion"] = self.dice.choice(("indexed", "coordinated"))
        return self.dice.choice(([], [{**track, **limits}], [{**track, **limits, **more}]))

    def robot_start_joints_deg(self):
        return self.dice.choice(([], [self.dice.uniform(-90, 90) for _ in range(6)]))

    def robot_program(self):
        rule = self.rules["properties"]["robot"]["properties"]["program"]
        made = self.object(rule, ("robot", "program"))
        for name, least, most in (
            ("home_joints_deg", -90, 90),
            ("joint_acceleration_deg_s2", 0, 900),
            ("joint_jerk_deg_s3", 0, 9000),
        ):
            if name in made:
                made[name] = [self.dice.uniform(least, most) for _ in range(6)]
        return made

    def robot_link_radii_mm(self):
        return self.dice.choice(([], [50.0] * 7))

    def simulation_max_travel_mm(self):
        return SIZE * 10.0 ** self.dice.uniform(-1.3, 0.3)

    def simulation_max_angle_deg(self):
        return self.dice.choice((5.0, 20.0, 90.0))

    def inspection_tolerance_mm(self):
        return sorted(self.dice.gauss(0, 0.1) for _ in range(2))

    inspection_thickness_mm = inspection_tolerance_mm

    def inspection_faces(self):
        return sorted(self.dice.sample(self.faces, 1)) if self.faces else []

    def mend_loading(self, made):
        """A rigid tool does not load, and what does not load is not loaded."""
        law = made.get("law", {})
        if law.get("model") == "geometric":
            law.get("wear", {}).pop("loading_share", None)
        if not law.get("wear", {}).get("loading_share"):
            made["belt_machine"].get("belt", {}).pop("loading", None)

    def mend(self, made):
        """Gives keys what those beside them need."""
        dice = self.dice
        made.setdefault("sampling", {}).setdefault("spacing_mm", 2.0)
        made.setdefault("simulation", {}).setdefault("max_travel_mm", 3.0)
        made["simulation"].setdefault("max_angle_deg", 20.0)
        machine = made.setdefault("belt_machine", {})
        machine.setdefault("contact_spacing_mm", 2.0)
        wheel = machine.setdefault("wheel", {})
        wheel.setdefault("radius_mm", 25.0)
        wheel.setdefault("width_mm", 10.0)
        if wheel.get("profile_mm"):
            half = wheel["profile_mm"][-1][0]
            wheel["width_mm"] = 2.0 * half
            wheel.pop("crown_radius_mm", None)
        if wheel.get("crown_radius_mm"):
            wheel["crown_radius_mm"] = wheel["width_mm"] * dice.uniform(0.6, 20.0)
        compliance = machine.get("compliance", {})
        if compliance.get("model") == "surrogate":
            compliance["model"] = "bonded_layer"
        if machine.get("kind") in ("free_belt", "platen") and "law" in made:
            made["law"]["model"] = dice.choice(("local", "local_linear", "hammann"))
        elif (
            compliance.get("model") == "geometric"
            or made.get("law", {}).get("model") == "geometric"
        ):
            machine["compliance"] = {**compliance, "model": "geometric"}
            machine["control"] = "position"
            made["law"] = {**made.get("law", {}), "model": "geometric"}
        if machine.get("kind") == "platen" and dice.random() < 0.9:
            self.platen_length(machine)
        rim = machine.setdefault("compliance", {})
        rim["rim_thickness_mm"] = wheel["radius_mm"] * dice.uniform(0.1, 0.5)
        self.mend_loading(made)
        stock = made.get("stock", {})
        if "left_by" in stock:
            for name in ("offset_mm", "placement"):
                stock.pop(name, None)
        for name in ("file", "brep"):
            if stock.get("kind", "allowance") == "allowance" or name in stock:
                stock.pop(name, None)
        if stock.get("kind") == "solid":
            stock["brep"] = self.stock_brep()
        elif stock.get("kind") == "mesh":
            stock["file"] = self.stock_file()
        cell = made.get("cell", {})
        for k, body in enumerate(cell.get("bodies", [])):
            body.pop("brep" if dice.random() < 0.5 and "file" in body else "file", None)
            if "brep" not in body and "file" not in body:
                body["brep"] = self.cell_brep()
            body["name"] = f"body {k}"
        for at, zone in enumerate(made.get("inspection", {}).get("zones", [])):
            zone["name"] = f"zone {at}"
            if "thickness_mm" not in zone:
                zone.setdefault("tolerance_mm", self.inspection_tolerance_mm())
            if "finish" in zone and ("finish" not in made or "Ra_max_um" not in zone["finish"]):
                del zone["finish"]
            elif "finish" in zone:
                zone["finish"] = {"Ra_max_um": zone["finish"]["Ra_max_um"]}
        heat = made.get("heat")
        if heat is not None:
            for name in ("friction", "partition"):
                heat[name] = sorted(heat[name])
            if (
                "heat_capacity_J_kgK" in heat and "density_kg_m3" in heat
            ):  # in J/(m3 K), as of metals
                density = heat["density_kg_m3"]
                heat["heat_capacity_J_kgK"] = self.dice.uniform(1e6, 5e6) / density
        finish = made.get("finish")
        if finish is not None and "model" in finish:
            finish.setdefault("grit", 120)

    # Programs.

    def program(self, made):
        dice = self.dice
        if dice.random() < 0.08:
            name = dice.choice(("pass.csv", "axes.apt"))
            return {"file": str(PARTS / name), "feed_mm_s": 50.0}
        rule = self.rules["properties"]["programs"]["items"]
        keys = ("poses", "file", "values", "roll", "roll_direction")
        found = self.object(
            {"properties": {k: v for k, v in rule["properties"].items() if k not in keys}},
            ("programs",),
        )
        posed = rule["properties"]["poses"]["items"]
        count = dice.randint(2, 5)
        places = self.places(made, count)
        found["poses"] = []
        for place in places:
            pose = self.object(
                {"properties": {k: v for k, v in posed["properties"].items() if k not in POSE}},
                ("programs", "poses"),
            )
            found["poses"].append({**place, **pose})
        return found

    programs_feed_mm_s = lambda self: SIZE * 10.0 ** self.dice.uniform(-0.5, 1.0)
    programs_rapid = lambda self: self.dice.random() < 0.2

    def places(self, made, count):
        """Poses of the tool centre point where the contact lies on the part, or near it."""
        dice, (points, normals) = self.dice, surface(self.part, tuple(self.faces))
        at, contacts = dice.randrange(len(points)), []
        for _ in range(count):
            near = np.flatnonzero(np.linalg.norm(points - points[at], axis=1) < 0.4 * SIZE)
            at = int(dice.choice(near.tolist()))
            z = -normals[at]
            if dice.random() < 0.3:
                z = z + dice.choice((0.05, 0.3)) * np.array([dice.gauss(0, 1) for _ in range(3)])
            z = z / np.linalg.norm(z)
            x = np.cross(z, [dice.gauss(0, 1) for _ in range(3)])
            x /= np.linalg.norm(x)
            contact = np.eye(4)
            contact[:3, :3] = np.column_stack([x, np.cross(z, x), z])
            offset = dice.choice((0.0, 0.0, dice.gauss(0, 0.2), dice.gauss(0, 3.0)))
            contact[:3, 3] = points[at] + offset * z
            contacts.append(contact)
        cell = made.get("cell", {})
        frame = lambda name: frames.from_data(cell.get(name))
        tools = frames.base_from_tcp(
            np.array(contacts),
            cell.get("holding", "tool_in_hand"),
            *(frame(n) for n in ("base_from_work", "tcp_from_contact", "tcp_from_work")),
            frame("base_from_contact"),
        )
        turns = frames.to_quaternions(tools[:, :3, :3])
        names = ("x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz")
        rows = np.hstack([tools[:, :3, 3], turns]).tolist()
        return [dict(zip(names, row)) for row in rows]


def number(dice, rule):
    """A number that the rule allows, most often not far from its default."""
    low, high = rule.get("minimum", rule.get("exclusiveMinimum")), _highest(rule)
    least = rule.get("least", 0.0)
    default = rule.get("default")
    if rule["type"] == "integer":
        low = 0 if low is None else low
        return int(min(high, low + dice.choice((0, 0, 1, 2, 7, 1000))))
    if dice.random() < 0.1 and low == 0 and "minimum" in rule:
        return 0.0
    if dice.random() < FAR or not default and low is None:
        top = math.log10(high or 1.0)
        bottom = math.log10(max(least, low or 0.0, 1e-9))
        value = 10.0 ** dice.uniform(bottom, max(top, bottom))
        value *= -1.0 if low is not None and low < 0 and dice.random() < 0.5 else 1.0
    else:
        value = (default or 1.0) * 10.0 ** dice.choice((0.0, dice.gauss(0, 0.3), dice.gauss(0, 1)))
    value = max(value, least) if value > 0 else value
    return min(high, max(value, -high if low is None else low))


def _highest(rule):
    if "exclusiveMaximum" in rule:
        return math.nextafter(rule["exclusiveMaximum"], 0.0)
    return rule.get("maximum", 1e9)


@lru_cache(maxsize=None)
def _robots():
    return "", *(one["id"] for one in library.robots())


@lru_cache(maxsize=None)
def _shape(part):
    text = (PARTS / f"{part}.brep").read_text()
    return workpiece.read_design(
        jobs.validate({"design": {"brep": text}, "programs": [{"poses": [POSE, POSE]}]})["design"]
    )


def _faces(part):
    return _shape(part).face_count


@lru_cache(maxsize=None)
def _left(part):
    """File of what an earlier run left on a part, about 3 mm apart: of a lasting name, so that a job stays the same."""
    folder = Path(tempfile.gettempdir()) / "beltgrinding-left"
    folder.mkdir(exist_ok=True)
    if not (file := folder / f"{part}.h5").exists():
        field = core.sample_faces(_shape(part), list(range(_faces(part))), 3.0)[0]
        core.apply_allowance(field, 0.2)
        with tempfile.TemporaryDirectory(dir=folder) as new:
            field.write_hdf5(Path(new) / "field.h5")
            (Path(new) / "field.h5").replace(file)
    return file


@lru_cache(maxsize=None)
def surface(part, faces):
    """(points (n, 3), normals (n, 3)) on the faces of a part, about 3 mm apart."""
    numbers = [face - 1 for face in faces] or list(range(_faces(part)))
    field = core.sample_faces(_shape(part), numbers, 3.0)[0]
    return np.array(field.points), np.array(field.normals, dtype=float)


# Nearly valid.


@lru_cache(maxsize=None)
def leaves():
    """Every key of the schema as (way, rule): of a list's entries one, at 0."""
    whole = jobs.schema()

    def walk(rule, way):
        if "$ref" in rule:
            rule = whole["definitions"][rule["$ref"].rpartition("/")[2]]
        if way:
            yield way, rule
        for name, inner in rule.get("properties", {}).items():
            yield from walk(inner, (*way, name))
        if isinstance(rule.get("items"), dict):
            yield from walk(rule["items"], (*way, 0))

    return list(walk(whole, ()))


def ends(rule):
    """Numbers and choices that a rule just allows."""
    found = list(rule.get("enum", ()))
    for name, beyond in (("minimum", 0), ("maximum", 0), ("exclusiveMinimum", 1), ("least", 0)):
        if name in rule:
            found.append(math.nextafter(rule[name], math.inf) if beyond else rule[name])
    return found


def edges(rule):
    """Values at the edges of a rule, and beyond."""
    found = [None, True, "", "text", [], {}, [None], 0, -0.0, 1, 5e-324, -5e-324, 1e308, 2**70]
    found += [10**400, float("nan"), float("inf"), -1, 0.5, MISSING, "\0", "\ud800", "x" * 5000]
    for name in ("minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "least"):
        if name in rule:
            value = float(rule[name])
            found += [value, math.nextafter(value, -math.inf), math.nextafter(value, math.inf)]
    if "enum" in rule:
        found.append(str(rule["enum"][0]).upper())
    if rule.get("type") == "array":
        found += [DOUBLED, LONG, REVERSED]
    return found


MISSING, DOUBLED, LONG, REVERSED = object(), object(), object(), object()


def spoil(dice, made):
    """Puts a value from the edges in the place of one of the job's keys, or of one that it might have."""
    way, rule = dice.choice(leaves())
    just = ends(rule) if dice.random() < 0.6 else []
    value, holder = dice.choice(just or edges(rule)), made
    for step, after in zip(way, way[1:]):
        holder = _held(holder, step, [] if after == 0 else {})
        if not isinstance(holder, (dict, list)):
            return
    name = way[-1]
    if value in (DOUBLED, LONG, REVERSED):
        before = _held(holder, name, [])
        before = before if isinstance(before, list) else [before]
        value = {DOUBLED: before * 2, LONG: (before or [1]) * 500, REVERSED: before[::-1]}[value]
        value = copy.deepcopy(value)
    if isinstance(holder, list):
        holder[:1] = [] if value is MISSING else [value]
    elif not isinstance(holder, dict):
        return
    elif value is MISSING:
        holder.pop(name, None)
    else:
        holder[name] = value


def _held(holder, step, empty):
    if isinstance(holder, list):
        if not holder:
            holder.append(empty)
        return holder[0]
    return holder.setdefault(step, empty) if isinstance(holder, dict) else None


def as_json(made):
    """The text of a job; NaN and infinity as Python writes them."""
    return json.dumps(made, indent=1)
