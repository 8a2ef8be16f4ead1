"""Random KRL programs against an evaluator of their own; with one statement that the reader cannot understand,
each motion that is still told is one of the program's, at its place."""

import copy
import random

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.registry import read_program

HEAD = [
    "DEF p()",
    "DECL REAL r[2], s",
    "DECL INT i[2], n, k1, k2, k3",
    "DECL FRAME f, g, a[3]",
    "DECL BOOL b",
    "$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}",
    "$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}",
    "$VEL.CP=0.125",
]
TAIL = ["END", "DEF bump(v:OUT, w:IN)", "DECL REAL v, w, s", "s=w*2", "v=v+s", "w=0", "END"]
FRAME = "xyzabc"


class Program:
    """Lines of KRL, and what they do as Python over a state."""

    def __init__(self, seed):
        self.random, self.lines, self.simple = random.Random(seed), list(HEAD), []
        self.loops = 0
        self.steps = self.block([], 12, 0)
        self.lines += TAIL

    def text(self):
        return "\n".join(self.lines) + "\n"

    def truth(self):
        """[(line, six components, mm/s)] of its motions."""
        zero = dict.fromkeys(FRAME, 0.0)
        state = {
            "r": [1.0, 2.0], "i": [1, 2], "n": 2, "s": 0.5, "b": True, "vel": 125.0,
            "f": dict(zero), "g": dict(zero, x=5.0), "a": [dict(zero, y=float(k)) for k in range(3)],
            "motions": [], "here": None,
        }  # fmt: skip
        run(self.steps, state)
        return state["motions"]

    def line(self, text, does, target=None):
        self.lines.append("  " + text)
        if target:
            self.simple.append((len(self.lines) - 1, target))
        return does

    def whole(self):
        """(KRL, Python) of a whole number."""
        pick, c = self.random.randrange(5), self.random.randint(1, 3)
        if pick == 0:
            return str(c), lambda s: c
        if pick == 1:
            return "n", lambda s: s["n"]
        if pick == 2:
            return f"i[1]+{c}", lambda s: s["i"][0] + c
        if pick == 3:
            return f"i[2]*{c}/2", lambda s: int(s["i"][1] * c / 2)
        return f"(i[1]-{c})", lambda s: s["i"][0] - c

    def real(self):
        pick, c = self.random.randrange(6), self.random.randint(1, 9) / 2.0
        if pick == 0:
            return str(c), lambda s: c
        if pick == 1:
            return f"r[1]+{c}", lambda s: s["r"][0] + c
        if pick == 2:
            text, value = self.whole()
            return f"s+{text}", lambda s: s["s"] + value(s)
        if pick == 3:
            return f"f.X*0.5-{c}", lambda s: s["f"]["x"] * 0.5 - c
        if pick == 4:
            return "a[n].Y+r[2]", lambda s: s["a"][s["n"] - 1]["y"] + s["r"][1]
        return "SQRT(16)+g.Z", lambda s: 4.0 + s["g"]["z"]

    def statement(self):
        rng, (real, value), (whole, count) = self.random, self.real(), self.whole()
        name, pick = rng.choice(["f", "g"]), rng.randrange(13)
        other = "g" if name == "f" else "f"
        axis = rng.choice("XYZ")

        def bounded(s):
            return max(-900.0, min(900.0, value(s)))

        if pick == 0:
            k = rng.randint(1, 2)
            return self.line(f"r[{k}]={real}", lambda s: put(s["r"], k - 1, value(s)), "r")
        if pick == 1:
            k = rng.randint(1, 2)
            return self.line(f"i[{k}]={whole}", lambda s: put(s["i"], k - 1, count(s)), "i")
        if pick == 2:
            return self.line(f"s={real}", lambda s: put(s, "s", value(s)), "s")
        if pick == 3:
            return self.line(
                f"{name}={{X {real},Y 1,Z -2.5,A 10,B 90,C 0}}",
                lambda s: put(s, name, dict(zip(FRAME, (value(s), 1.0, -2.5, 10.0, 90.0, 0.0)))),
                name,
            )
        if pick == 4:
            return self.line(
                f"{name}.{axis}={real}", lambda s: put(s[name], axis.lower(), value(s)), name
            )
        if pick == 5:
            return self.line(f"{name}={other}", lambda s: put(s, name, dict(s[other])), name)
        if pick == 6:
            k = rng.randint(1, 3)
            return self.line(f"a[{k}]={name}", lambda s: put(s["a"], k - 1, dict(s[name])), "a")
        if pick == 7:
            return self.line(
                f"a[n].{axis}={real}",
                lambda s: put(s["a"][s["n"] - 1], axis.lower(), value(s)),
                "a",
            )
        if pick == 8:
            return self.line(f"{name}=a[n]", lambda s: put(s, name, dict(s["a"][s["n"] - 1])), name)
        if pick == 9:
            speed = rng.choice([0.25, 0.5, 0.0625])
            return self.line(f"$VEL.CP={speed}", lambda s: put(s, "vel", speed * 1000), "$vel")
        if pick == 10:
            k = rng.randint(1, 2)

            def bump(s):
                s["r"][k - 1] += 2 * value(s)

            return self.line(f"bump(r[{k}], {real})", bump, "r")
        if pick == 11:
            k = rng.randint(1, 3)
            return self.line(f"n={k}", lambda s: put(s, "n", k), "n")
        return self.line(f"b=n>{whole}", lambda s: put(s, "b", s["n"] > count(s)), "b")

    def motion(self):
        rng, (real, value) = self.random, self.real()
        at, pick, name = (
            len(self.lines) + 1,
            rng.randrange(4),
            rng.choice(["f", "g", "a[2]", "a[n]"]),
        )

        def go(s, frame):
            s["here"] = {**(s["here"] or {}), **frame}
            s["motions"].append((at, [s["here"][c] for c in FRAME], s["vel"]))

        def named(s):
            index = {"a[2]": 1, "a[n]": s["n"] - 1}.get(name)
            return s[name] if index is None else s["a"][index]

        if pick < 2:
            return self.line(f"LIN {name} C_DIS", lambda s: go(s, named(s)))
        if pick == 2:
            return self.line(f"LIN {{X {real}}}", lambda s: go(s, {"x": value(s)}))
        return self.line(f"LIN_REL {{Y {real}}}", lambda s: go(s, {"y": s["here"]["y"] + value(s)}))

    def block(self, steps, size, depth):
        if depth == 0:
            start = {
                "n=2": None, "s=0.5": None, "r[1]=1": None, "r[2]=2": None, "i[1]=1": None, "i[2]=2": None,
                "b=TRUE": None, "f={X 0,Y 0,Z 0,A 0,B 0,C 0}": None, "g={X 5,Y 0,Z 0,A 0,B 0,C 0}": None,
                **{f"a[{k + 1}]={{X 0,Y {k},Z 0,A 0,B 0,C 0}}": None for k in range(3)},
            }  # fmt: skip
            for text in start:
                self.line(text, None, text.split("=")[0].split("[")[0])
            at = len(self.lines) + 1

            def first(s):
                s["here"] = dict(s["f"])
                s["motions"].append((at, [0.0] * 6, s["vel"]))

            steps.append(self.line("LIN f", first))
        for _ in range(size):
            pick = self.random.randrange(10)
            if pick < 5 or depth > 2:
                steps.append(self.statement())
            elif pick < 8:
                steps.append(self.motion())
            else:
                steps.append(self.structure(depth))
        return steps

    def structure(self, depth):
        rng, (whole, count) = self.random, self.whole()
        pick = rng.randrange(4)
        if pick == 0:
            self.lines.append(f"IF (n<{whole}) OR NOT b THEN")
            yes = self.block([], 2, depth + 1)
            self.lines.append("ELSE")
            no = self.block([], 2, depth + 1)
            self.lines.append("ENDIF")
            return lambda s: run(yes if s["n"] < count(s) or not s["b"] else no, s)
        if pick == 1:
            self.lines.append("SWITCH n")
            parts = {}
            for words in ("CASE 1", "CASE 2,3", "DEFAULT"):
                self.lines.append(words)
                parts[words] = self.block([], 1, depth + 1)
            self.lines.append("ENDSWITCH")
            return lambda s: run(
                parts["CASE 1" if s["n"] == 1 else "CASE 2,3" if s["n"] in (2, 3) else "DEFAULT"], s
            )
        self.loops += 1
        name, passes = f"k{1 + depth}", rng.randint(1, 3)
        if pick == 2:
            self.lines.append(f"FOR {name}=1 TO {passes}")
            inner = self.block([], 2, depth + 1)
            self.lines.append("ENDFOR")
        else:
            self.lines += [f"{name}=0", f"WHILE {name}<{passes}", f"{name}={name}+1"]
            inner = self.block([], 2, depth + 1)
            self.lines.append("ENDWHILE")
        return lambda s: [run(inner, s) for _ in range(passes)]


def put(where, key, value):
    where[key] = value


def run(steps, state):
    for step in steps:
        step(state)


def same(motion, row):
    line, six, speed = row
    return (
        motion.line == line
        and motion.speed_mm_s in (speed, None)
        and np.allclose(motion.pose, frames.from_abc(six[:3], six[3:]), atol=1e-9)
    )


def read(folder, lines):
    path = folder / "p.src"
    path.write_text("\n".join(lines) + "\n")
    return read_program(path)


@pytest.mark.parametrize("seed", range(60))
def test_random_programs_and_what_is_left_of_them(tmp_path, seed):
    made = Program(seed)
    truth = made.truth()
    program = read(tmp_path, made.lines)
    assert not program.problems, program.problems
    assert len(program.motions) == len(truth)
    assert all(same(motion, row) for motion, row in zip(program.motions, truth))
    assert all(motion.speed_mm_s for motion in program.motions)
    for at, target in random.Random(seed).sample(made.simple, min(6, len(made.simple))):
        for change in (
            lambda t: t.partition("=")[0] + "=zz_value" if "=" in t else None,
            lambda t: t.partition("=")[0] + "=zz_made(3)" if "=" in t else None,
            lambda t: t.partition("=")[0] + "=@?" if "=" in t else None,
            lambda t: t.replace("[", "[zz+", 1) if "[" in t.partition("=")[0] else None,
            lambda t: t.replace(".", ".zz", 1) if "." in t.partition("=")[0] else None,
            lambda t: f"zz_sets({target if target != '$vel' else '$VEL.CP'})",
            lambda t: f"zz {t}" if "=" not in t else f"{t.replace('=', ' ? ', 1)}",
        ):
            lines = copy.copy(made.lines)
            lines[at] = change(lines[at].strip())
            if lines[at] is None:
                continue
            left(read(tmp_path, lines), truth, lines[at])


def left(program, truth, changed):
    """Each motion is one of ``truth``, in order, and none is joined over one that is missing."""
    at, arriving = 0, True
    for motion in program.motions:
        if motion.kind == "GAP":
            arriving = True
            continue
        found = next((k for k in range(at, len(truth)) if same(motion, truth[k])), None)
        assert found is not None, f"{changed}: another motion in line {motion.line}"
        assert (
            arriving or found == at
        ), f"{changed}: line {motion.line} is joined over a missing one"
        at, arriving = found + 1, False
    if at < len(truth):
        assert program.problems, changed


def test_speeds_of_turning_say_nothing_of_the_path_speed(tmp_path):
    lin = "LIN {X %d,Y 0,Z 0,A 0,B 0,C 0}\n"
    body = f"$VEL.ORI1=200\n{lin % 1}$VEL.CP=0.1\n$VEL.ORI1=100\n{lin % 2}"
    (tmp_path / "a.src").write_text(f"DEF a()\n{body}END\n")
    program = read_program(tmp_path / "a.src")
    assert [motion.speed_mm_s for motion in program.motions] == [None, 100.0]
    assert not program.problems
