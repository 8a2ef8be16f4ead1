"""Makes the corpora of the fuzz targets by our own code: python3 make_corpus.py. To be run again when a format
changes; needs the build (PYTHONPATH as tools/setup.sh has it)."""

import json
import struct
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE.parents[1] / "workbench")]

from test_foreign_files import CUBE, TRIANGLES, core, write  # noqa: E402

from beltgrinding.job import load  # noqa: E402
from beltgrinding.simulation.run import run  # noqa: E402


def put(target, name, data):
    path = HERE / "corpus" / target / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def quad_ply(form):
    head = (
        f"ply\nformat {form} 1.0\ncomment x\nelement vertex 4\nproperty double x\nproperty uchar g\n"
        "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    corners = [(0, 0, 0), (2, 0, 0), (2, 1, 0.5), (0, 1, 0.5)]
    if form == "ascii":
        return (head + "".join("%g 9 %g %g\n" % c for c in corners) + "4 0 1 2 3\n").encode()
    order = "<" if "little" in form else ">"
    body = b"".join(struct.pack(order + "dBff", x, 9, y, z) for x, y, z in corners)
    return head.encode() + body + struct.pack(order + "B4i", 4, 0, 1, 2, 3)


def main():
    plate = core.shape_from_mesh(
        core.TriangleMesh(
            np.array([[0, 0, 0], [40, 0, 0], [40, 20, 0]], np.float32),
            np.array([[0, 1, 2]], np.uint32),
        )
    )
    field, _ = core.sample_faces(plate, [0], 6.0)
    put("ply", "field.ply", core.mesh_ply(field, True))
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        put("ply", form, quad_ply(form))

    for kind, suffix in enumerate((".off", ".obj", ".stl", ".3mf")):
        path = write(HERE / f"corpus/cube{suffix}")
        put("mesh", f"cube{suffix}", bytes([kind]) + path.read_bytes())
        path.unlink()

    text = lambda s: struct.pack("<Q", len(s)) + s.encode()
    argument = text("limit") + struct.pack("<Id", 1, 2.5) + text("what") + struct.pack("<I", 2)
    fact = (
        text("a.code") + text("{limit:.3g} {what}") + struct.pack("<I", 2) + argument + text("it")
    )
    put("answer", "error", fact + struct.pack("<I", 1) + fact)
    points, triangles = np.array(CUBE, "<f4"), np.array(TRIANGLES, "<u4")
    mesh = struct.pack("<Q", len(points)) + points.tobytes()
    put("answer", "triangles", mesh + triangles.tobytes())
    mesh += struct.pack("<Q", len(triangles)) + triangles.tobytes() + struct.pack("<Q", 0)
    put("answer", "mesh", mesh)
    put(
        "answer",
        "tried",
        struct.pack("<6dQQII", 0, 0, 0, 1, 2, 3, 2, 1, 1, 1) + struct.pack("<2db", 1.5, -1.0, 1),
    )
    put("answer", "numbers", np.linspace(-1, 1, 60).tobytes())
    literal = plate.write_brep().replace("\\", "\\\\").replace('"', '\\"').splitlines()
    (HERE / "face_brep.inc").write_text("\n".join(f'"{line}\\n"' for line in literal) + "\n")

    path = HERE / "corpus" / "field.h5"
    field.write_hdf5(str(path), "{}")
    put("height_field", "field.h5", path.read_bytes())
    pose = {"x_mm": 24, "y_mm": 5, "z_mm": 0.2, "qw": 0, "qx": 1, "qy": 0, "qz": 0}
    job = {
        "design": {"brep": plate.write_brep(), "faces": [1]},
        "sampling": {"spacing_mm": 3.0},
        "stock": {"kind": "allowance", "allowance_mm": 0.2},
        "belt_machine": {"wheel": {"radius_mm": 60, "width_mm": 15}, "force_N": 30},
        "programs": [{"poses": [pose, {**pose, "x_mm": 36}]}],
        "inspection": {"tolerance_mm": [-0.05, 0.05]},
    }
    recording = core.Recording()
    result = run(load.validate(job), recording=recording)
    put(
        "height_field",
        "ground.h5",
        (result.field.write_hdf5(str(path), json.dumps({})), path.read_bytes())[1],
    )
    recording.write_hdf5(str(path), "{}")
    put("recording", "recording.h5", path.read_bytes())
    path.unlink()


if __name__ == "__main__":
    main()
