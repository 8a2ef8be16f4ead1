"""Free-form surfaces through sections. Needs FreeCAD's Part; mm."""

import numpy as np


def pieces(points, borders):
    """Part.BSplineCurves through (n, 3) points: of a closed section if ``borders`` has several entries, cut
    at those points (numbers from 0, the first one 0) and smooth across the cuts.
    """
    import FreeCAD
    import Part

    count = len(points)
    curve = Part.BSplineCurve()
    places = [FreeCAD.Vector(*point) for point in points]
    curve.interpolate(places, PeriodicFlag=True, Parameters=[float(k) for k in range(count + 1)])
    cut = []
    for first, last in zip(borders, [*borders[1:], count]):
        piece = curve.copy()
        piece.segment(first, last)
        cut.append(piece)
    return cut


def side(points):
    """The Part.BSplineCurve through (n, 3) points from the first to the last, one parameter a point."""
    import FreeCAD
    import Part

    curve = Part.BSplineCurve()
    places = [FreeCAD.Vector(*point) for point in points]
    curve.interpolate(places, Parameters=[float(k) for k in range(len(places))])
    return curve


def skin(curves, at):
    """The face through B-spline curves of equal degree and knots, one at each of the values ``at``, which
    become its second parameter. Faces of neighbouring pieces have the same border.
    """
    import Part

    columns = []
    for column in zip(*(curve.getPoles() for curve in curves)):
        line = Part.BSplineCurve()
        line.interpolate(list(column), Parameters=[float(value) for value in at])
        columns.append(line)
    one, other = curves[0], columns[0]
    surface = Part.BSplineSurface()
    surface.buildFromPolesMultsKnots(
        [line.getPoles() for line in columns],
        one.getMultiplicities(), other.getMultiplicities(), one.getKnots(), other.getKnots(),
        False, False, one.Degree, other.Degree,
    )  # fmt: skip
    return surface.toShape()


def closed(faces, ends):
    """The solid between ``faces`` and flat ends, each a list of the curves round it."""
    import Part

    flat = [Part.Face(Part.Wire([curve.toShape() for curve in end])) for end in ends]
    shell = Part.Shell([*faces, *flat])
    shell.sewShape()
    solid = Part.Solid(shell)
    if solid.Volume < 0:
        solid.reverse()
    return solid


def stations(centres):
    """Values for ``skin``: the way along the sections' middles (n, 3), mm."""
    ways = np.linalg.norm(np.diff(np.asarray(centres, dtype=float), axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(ways)])


def nearest_face(shape, point):
    """The number, from 1, of the face that is nearest to a point."""
    import Part

    probe = Part.Vertex(*point)
    return 1 + min(range(len(shape.Faces)), key=lambda k: shape.Faces[k].distToShape(probe)[0])
