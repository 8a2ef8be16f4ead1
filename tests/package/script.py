"""Run by a Python that has numpy and the wheel alone: a box is ground by the library and by the command."""

import json
import subprocess
import sys
from pathlib import Path

import beltgrinding

BOX = """solid box
{facets}endsolid box
"""
CORNERS = [(x, y, z) for x in (0, 60) for y in (0, 40) for z in (0, 20)]
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def facet(corners):
    points = "".join("vertex {} {} {}\n".format(*CORNERS[one]) for one in corners)
    return f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet\n"


facets = "".join(facet((a, b, c)) + facet((a, c, d)) for a, b, c, d in QUADS)
Path("box.stl").write_text(BOX.format(facets=facets))
command = [str(Path(sys.executable).with_name("beltgrind"))]
faces = subprocess.run([*command, "faces", "box.stl", "--json"], capture_output=True, text=True)
assert faces.returncode == 0, faces.stderr
(top,) = [str(one["face"]) for one in json.loads(faces.stdout) if one["normal"][2] > 0.9]
ground = subprocess.run(
    [*command, "grind", "box.stl", "--faces", top, "-o", "ground", "--set", "rounds=1"],
    capture_output=True,
    text=True,
)
assert ground.returncode == 0, ground.stderr
assert Path("ground/raster.src").is_file(), list(Path("ground").iterdir())
result = beltgrinding.run("ground/job.json")
share = 100 * result.summary["in_tolerance_area_share"]
assert share > 50, share
print(f"Python {sys.version.split()[0]}: a box is ground, {share:.1f} % in tolerance")
