"""Writes KUKA KRL: passes of poses as linear motions."""

from pathlib import Path

import numpy as np

from ..frames import to_abc


def _components(pose):
    x, y, z = pose[:3, 3]
    a, b, c = to_abc(pose)
    values = zip("XYZABC", (x, y, z, a, b, c))
    return "{" + ",".join(f"{name} {value:.4f}" for name, value in values) + "}"


def write_krl(path, name, passes, approach_m_s=0.25, comment=""):
    """Writes the module ``name`` to ``path`` (.src).

    passes: list of dict(poses=(n, 4, 4) base_from_tcp in mm, feed_mm_s=float). The first pose of a
    pass is reached by PTP, the rest by LIN at the pass's feed.
    """
    lines = ["&ACCESS RVP", "&REL 1"]
    if comment:
        lines.append(f"&COMMENT {comment}")
    lines += [
        f"DEF {name} ( )",
        ";FOLD INI",
        "$BASE={FRAME: X 0,Y 0,Z 0,A 0,B 0,C 0}",
        "$TOOL={FRAME: X 0,Y 0,Z 0,A 0,B 0,C 0}",
        f"$VEL.CP={approach_m_s:g}",
        ";ENDFOLD",
    ]
    for number, one in enumerate(passes, 1):
        poses = np.asarray(one["poses"], dtype=float)
        lines.append(f";FOLD PASS {number}")
        lines.append(f"PTP {_components(poses[0])}")
        lines.append(f"$VEL.CP={one['feed_mm_s'] / 1000.0:.6g}")
        lines += [f"LIN {_components(pose)} C_DIS" for pose in poses[1:]]
        lines.append(";ENDFOLD")
    lines += ["END", ""]
    Path(path).write_bytes("\r\n".join(lines).encode("ascii"))
