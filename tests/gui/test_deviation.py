"""The coloured deviation in FreeCAD's window: it is drawn, and survives save, close and reopen."""

import os
import shutil
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MOD = ROOT / "Mod" / "BeltGrinding"

REOPEN = """
import os, sys, traceback
status = 1
try:
    sys.path.insert(0, {mod!r})
    import FreeCAD, FreeCADGui
    doc = FreeCAD.openDocument({doc!r})
    deviation = doc.getObject("Deviation")
    assert len(deviation.VertexColors) == deviation.Mesh.CountPoints > 0
    assert deviation.ViewObject.Coloring
    assert deviation.InTolerance > 0 and deviation.Maximum > deviation.Minimum
    view = FreeCADGui.ActiveDocument.ActiveView
    FreeCADGui.updateGui()
    view.saveImage({png!r}, 400, 300, "White")
    status = 0
except BaseException:
    traceback.print_exc()
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
"""


def gui(script, **variables):
    environment = {**os.environ, **variables, "QTWEBENGINE_DISABLE_SANDBOX": "1"}
    done = subprocess.run(
        ["xvfb-run", "-a", "-s", "-screen 0 1600x1000x24", "freecad", str(script)],
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=240,
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]


def pixels(path):
    """Rows of (r, g, b) of an 8-bit PNG, by the five filters of its specification."""
    data = path.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        kind, chunk = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", chunk[:10])
        elif kind == b"IDAT":
            packed += chunk
        at += 12 + length
    assert depth == 8 and colour in (2, 6)
    size = 3 if colour == 2 else 4
    raw, stride = zlib.decompress(packed), width * size
    above, result = bytearray(stride), []
    for y in range(height):
        start = y * (stride + 1)
        method, row = raw[start], bytearray(raw[start + 1 : start + 1 + stride])
        for i in range(stride):
            a = row[i - size] if i >= size else 0
            b, c = above[i], above[i - size] if i >= size else 0
            if method == 4:
                p = a + b - c
                nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = row[i] + (0, a, b, (a + b) // 2, nearest if method == 4 else 0)[method] & 255
        result += [tuple(row[i : i + 3]) for i in range(0, stride, size)]
        above = row
    return result


def coloured(path):
    """Counts of (brown, blue) pixels outside of the legend."""
    found = pixels(path)
    brown = sum(r > b + 80 for r, g, b in found)
    blue = sum(b > r + 60 for r, g, b in found)
    return brown, blue


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    for tool in ("freecad", "freecadcmd", "xvfb-run"):
        if shutil.which(tool) is None:
            pytest.skip(f"{tool} is not installed")
    out = tmp_path_factory.mktemp("demo")
    home = {"HOME": str(out), "BELTGRINDING_OUT": str(out)}
    make = MOD / "beltgrinding" / "examples" / "make_blade.py"
    subprocess.run(
        ["freecadcmd", str(make)],
        env={**os.environ, **home},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=True,
    )
    gui(
        MOD / "beltgrinding" / "gui" / "demo_picture.py",
        BELTGRINDING_JOB=str(out / "job.json"),
        **home,
    )
    return out


def test_the_picture_shows_both_ramps(demo):
    brown, blue = coloured(demo / "deviation.png")
    assert brown > 30000 and blue > 20000


def test_the_colours_survive_reopening(demo):
    script = demo / "reopen.py"
    png = demo / "reopened.png"
    document = demo / "deviation.FCStd"
    script.write_text(REOPEN.format(mod=str(MOD), doc=str(document), png=str(png)))
    gui(script, HOME=str(demo))
    brown, blue = coloured(png)
    assert brown > 1000 and blue > 400
