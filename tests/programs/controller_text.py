"""The written text of a program as a controller takes it: its own small parser of the statements that we write, one
function a language, and nothing of the readers. A statement that it does not know fails.
"""

import math
import re
from dataclasses import dataclass, replace

import numpy as np

NUMBER = r"[-+]?[\d.]+(?:[eE][-+]?\d+)?"
STOP = 0.0
RADIANS = 180.0 / math.pi


@dataclass(frozen=True)
class Block:
    """A motion: by which rules the controller goes to ``pose``."""

    kind: str  # joint, line, spline
    pose: np.ndarray  # 4 x 4, mm
    feed: float  # mm/s
    zone: float  # mm before and behind its end, 0: it stops
    force: float  # N, that is set when it begins
    share: float = 0.0  # of the feed, kept through the corner in place of a zone
    acceleration: float = math.inf  # mm/s2
    angular: float = math.inf  # degrees/s2
    turning: float = math.inf  # degrees/s


def blocks_of(file, newton, limits):
    """Blocks of a written file. ``newton``: N of a number that the force device's statement has; ``limits``: what the
    controller takes for what the text does not set (acceleration, angular, turning, zone)."""
    text = file.read_text()
    return LANGUAGES[file.suffix](text, newton, limits)


def numbers(text):
    return [float(one) for one in re.findall(NUMBER, text)]


def from_angles(x, y, z, a, b, c):
    """Rz(a) Ry(b) Rx(c), degrees."""
    (sa, sb, sc), (ca, cb, cc) = (f(np.radians([a, b, c])) for f in (np.sin, np.cos))
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    pose[:3, :3] = (
        np.array([[ca, -sa, 0], [sa, ca, 0], [0, 0, 1]])
        @ np.array([[cb, 0, sb], [0, 1, 0], [-sb, 0, cb]])
        @ np.array([[1, 0, 0], [0, cc, -sc], [0, sc, cc]])
    )
    return pose


def about(vector):
    """The rotation by a vector, radians (Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * (k @ k)


def krl(text, newton, limits):
    found, force, spline = [], 0.0, False
    now = {"acceleration": limits["acceleration"], "angular": limits["angular"]}
    now |= {"turning": limits["turning"]}
    feed = zone = 0.0
    body = text.split(";ENDFOLD (INI)")
    head, rest = re.findall(r"^\$.*$", body[0], re.M), body[1].splitlines()
    for row in [*head, *rest]:
        row = row.strip()
        trigger = re.match(r"TRIGGER WHEN (?:PATH=0 ONSTART|DISTANCE=0) DELAY=0 DO (.*)$", row)
        row = trigger[1] if trigger else row
        if not row or row[0] in ";&" or row == "END" or row.startswith("BAS (#"):
            continue
        if row in ("SPLINE", "ENDSPLINE"):
            spline = row == "SPLINE"
            if not spline and found[-1].kind == "spline":
                found[-1] = replace(found[-1], zone=STOP)
        elif match := re.match(r"\$ANOUT\[\d+\]=(.*)$", row):
            force = newton(float(match[1]))
        elif match := re.match(r"\$(VEL\.CP|ACC\.CP|APO\.CDIS|ACC\.ORI\d|VEL\.ORI\d)=(.*)$", row):
            name, value = match[1], float(match[2])
            if name == "VEL.CP":
                feed = 1000.0 * value
            elif name == "ACC.CP":
                now["acceleration"] = 1000.0 * value
            elif name == "APO.CDIS":
                zone = value
            else:
                now["angular" if name.startswith("ACC") else "turning"] = value
        elif match := re.match(r"(PTP|LIN|SPL) \{(.*?)\}(?: WITH \$VEL\.CP=(\S+))?( C_DIS)?$", row):
            kind = {"PTP": "joint", "LIN": "line", "SPL": "spline"}[match[1]]
            assert spline == (kind == "spline"), row
            own = 1000.0 * float(match[3]) if match[3] else feed
            round_ = zone if match[4] else (math.inf if spline else STOP)
            pose = from_angles(*numbers(re.sub(r"[XYZABC] ", "", match[2])))
            found.append(Block(kind, pose, own, round_, force, **now))
        else:
            raise AssertionError(row)
    return found


ZONES = {"fine": 0.0, "z0": 0.3, "z1": 1.0, "z5": 5.0, "z10": 10.0}


def rapid(text, newton, limits):
    found, force = [], 0.0
    now = {"acceleration": limits["acceleration"], "angular": limits["angular"]}
    body = text.split("PROC main()")[1].split("ENDPROC")[0]
    for row in body.splitlines():
        row = row.strip()
        if not row or row[0] == "!" or row in ("ConfL\\Off;", "ConfJ\\Off;"):
            continue
        if match := re.match(
            rf"PathAccLim TRUE\\AccMax:=({NUMBER}),TRUE\\DecelMax:=({NUMBER});", row
        ):
            now["acceleration"] = 1000.0 * min(float(match[1]), float(match[2]))
        elif match := re.match(rf"SetAO \w+,({NUMBER});", row):
            force = newton(float(match[1]))
        elif match := re.match(
            r"(MoveJ|MoveL) \[\[(.*?)\],\[(.*?)\],.*?\]\],(v\d+|\[.*?\]),(\w+|\[.*?\]),\w", row
        ):
            w, *v = numbers(match[3])
            pose = np.eye(4)
            pose[:3, 3] = numbers(match[2])
            norm = math.hypot(w, *v)
            half = 2.0 * math.acos(max(-1.0, min(1.0, w / norm)))
            sine = np.linalg.norm(v)
            pose[:3, :3] = about(np.array(v) / sine * half if sine > 1e-12 else np.zeros(3))
            speed = match[4]
            feed, turning = (float(speed[1:]), 500.0) if speed[0] == "v" else numbers(speed)[:2]
            zone = ZONES[match[5]] if match[5] in ZONES else numbers(match[5])[0]
            kind = "joint" if match[1] == "MoveJ" else "line"
            turning = min(turning, limits["turning"])
            found.append(Block(kind, pose, feed, zone, force, turning=turning, **now))
        else:
            raise AssertionError(row)
    return found


def urscript(text, newton, limits):
    found, force = [], 0.0
    now = {"angular": limits["angular"], "turning": limits["turning"]}
    for row in text.splitlines():
        row = row.strip()
        if not row or row[0] == "#" or row.startswith(("def ", "end", "ref_frame =", "set_tcp(")):
            continue
        if match := re.match(rf"set_standard_analog_out\(\d, ({NUMBER})\)$", row):
            force = newton(float(match[1]))
        elif match := re.match(r"(movel|movej)\(pose_trans\(ref_frame, p\[(.*?)\]\), (.*)\)$", row):
            x, y, z, *turn = numbers(match[2])
            pose = np.eye(4)
            pose[:3, 3] = 1000.0 * np.array([x, y, z])
            pose[:3, :3] = about(np.array(turn))
            given = {key: float(value) for key, value in re.findall(r"(\w)=([\d.e-]+)", match[3])}
            zone = 1000.0 * given.get("r", 0.0)
            if match[1] == "movej":
                found.append(Block("joint", pose, 1.0, STOP, force, **now))
                continue
            feed, most = 1000.0 * given["v"], 1000.0 * given["a"]
            found.append(Block("line", pose, feed, zone, force, acceleration=most, **now))
        else:
            raise AssertionError(row)
    return found


def fanuc(text, newton, limits):
    found, force = [], 0.0
    now = {key: limits[key] for key in ("acceleration", "angular", "turning")}
    points = {}
    for number, body in re.findall(r"P\[(\d+)\]\{(.*?)\};", text, re.S):
        at = {k: float(v) for k, v in re.findall(rf"\b([XYZWPR]) = ({NUMBER})", body)}
        points[number] = from_angles(*(at[k] for k in "XYZRPW"))
    body = text.split("/MN")[1].split("/POS")[0]
    for row in re.findall(r"^\s*\d+:(.*?)\s*;\s*$", body, re.M):
        if row.startswith("!") or re.match(r"U(FRAME|TOOL)_NUM=\d+$", row):
            continue
        if match := re.match(rf"AO\[\d+\]=({NUMBER})$", row):
            force = newton(float(match[1]))
        elif match := re.match(r"J P\[(\d+)\] \d+% (?:FINE|CNT\d+)$", row):
            found.append(Block("joint", points[match[1]], 1.0, STOP, force, **now))
        elif match := re.match(rf"L P\[(\d+)\] ({NUMBER})mm/sec (FINE|CNT(\d+))$", row):
            share = float(match[4]) / 100.0 if match[4] else 0.0
            found.append(
                Block("line", points[match[1]], float(match[2]), STOP, force, share, **now)
            )
        else:
            raise AssertionError(row)
    return found


def inform(text, newton, limits):
    found, force = [], 0.0
    now = {key: limits[key] for key in ("acceleration", "angular", "turning")}
    points = {}
    for number, body in re.findall(r"^C(\d+)=(.*?)\s*$", text, re.M):
        x, y, z, c, b, a = numbers(body)
        points[number] = from_angles(x, y, z, a, b, c)
    for row in text.split("\nNOP")[1].splitlines():
        row = row.strip()
        if not row or row[0] == "'" or row == "END":
            continue
        if match := re.match(rf"AOUT AO#\(\d+\) ({NUMBER})$", row):
            force = newton(float(match[1]))
        elif match := re.match(r"MOVJ C(\d+) VJ=[\d.]+ PL=\d$", row):
            found.append(Block("joint", points[match[1]], 1.0, STOP, force, **now))
        elif match := re.match(rf"MOVL C(\d+) V=({NUMBER}) PL=(\d)$", row):
            zone = STOP if match[3] == "0" else limits["zone"]  # of PL=1
            found.append(Block("line", points[match[1]], float(match[2]), zone, force, **now))
        else:
            raise AssertionError(row)
    return found


LANGUAGES = {".src": krl, ".mod": rapid, ".script": urscript, ".ls": fanuc, ".jbi": inform}
