"""Run inside FreeCAD with a window: grinds a job and saves the document and a picture of it.

Environment: BELTGRINDING_JOB (job.json), BELTGRINDING_OUT (folder). Writes deviation.FCStd and
deviation.png; ends FreeCAD with status 0 only if both are there.
"""

import os
import sys
import traceback
from pathlib import Path


def main():
    import FreeCAD
    import FreeCADGui
    import Part

    import beltgrinding
    from beltgrinding.objects.deviation import make_deviation

    out = Path(os.environ["BELTGRINDING_OUT"])
    result = beltgrinding.run(os.environ["BELTGRINDING_JOB"])
    result.write(out)
    doc = FreeCAD.newDocument("BeltGrinding")
    design = doc.addObject("Part::Feature", "Design")
    design.Shape = Part.read(result.job["design"]["file"])
    # The design itself would hide what is cut below it: show the other faces only.
    design.ViewObject.Visibility = False
    ground = set(result.job["design"]["faces"])
    others = [f for i, f in enumerate(design.Shape.Faces, 1) if ground and i not in ground]
    rest = doc.addObject("Part::Feature", "OtherFaces")
    rest.Shape = Part.Compound(others)
    rest.ViewObject.ShapeColor = (0.62, 0.64, 0.67)
    make_deviation(doc, result)
    doc.recompute()
    view = FreeCADGui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    normal = result.field.normals.mean(axis=0)
    upright = FreeCAD.Vector(0, 0, 1)
    side = upright.cross(FreeCAD.Vector(*(float(value) for value in normal))).normalize()
    camera = FreeCAD.Rotation(side, upright, FreeCAD.Vector(*map(float, normal)), "ZXY")
    view.setCameraOrientation(camera.Q)
    view.fitAll()
    FreeCADGui.updateGui()
    view.saveImage(str(out / "deviation.png"), 1400, 1000, "White")
    doc.saveAs(str(out / "deviation.FCStd"))


status = 1
try:
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    main()
    status = 0
except BaseException:
    traceback.print_exc()
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
