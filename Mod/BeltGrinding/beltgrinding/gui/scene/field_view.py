"""A height field in the 3D view, fast enough to follow a run: one vertex and one value a sample, coloured
at every pixel.

Drawn by our own Coin node, SoHeightField (module ``beltgrinding_coin``), where that shares its Coin
with pivy and FreeCAD; else by Coin's stock nodes, which do the same more slowly.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from pivy import coin

from ...engine import InputError, core, library
from ...objects.kinds import Field
from ..common.kinds import Array, Node, View3D

STOCK_NODES = "BELTGRINDING_STOCK_NODES"  # environment: set, to do without SoHeightField
PICK_RADIUS = 1.0  # pixels
DEVIATION, REMOVED, UNCERTAINTY, FACE = "deviation", "removed depth", "uncertainty", "face"
PRESSURE, CONTACT, TEMPERATURE = "pressure", "contact", "temperature"
ROUGHNESS, CELL_ERROR = "roughness", "error of the cells"
LEAST = 1e-9  # of a scale: half its range
PALETTE = 2048  # colours from one end of a scale to the other
MODES = (
    *(DEVIATION, REMOVED, UNCERTAINTY, FACE, PRESSURE, CONTACT, TEMPERATURE, ROUGHNESS),
    CELL_ERROR,
)


def _coin_module() -> Any:
    """``beltgrinding_coin``, its node known to pivy's Coin; None where that is another Coin."""
    if os.environ.get(STOCK_NODES):
        return None
    try:
        module = library.extension("beltgrinding_coin")
    except ImportError:
        return None  # not built, or its libCoin is not there
    # A second libCoin in the process has not been started, and pivy does not see its types.
    if not module.register_node() or coin.SoType.fromName("SoHeightField").isBad():
        return None
    return module


def has_own_node() -> bool:
    """Whether SoHeightField can be used in this program."""
    return _coin_module() is not None


class _OwnNode:
    """Draws with SoHeightField."""

    def __init__(self, module: Any, field: Field) -> None:
        self.module = module
        self.shape = coin.SoType.fromName("SoHeightField").createInstance()
        self.address = int(self.shape.this)
        self.parts = (self.shape,)
        module.set_samples(self.address, field.points, field.rays, field.triangles)

    def set_heights(self, heights: Array) -> None:
        self.module.set_heights(self.address, heights)

    def set_colours(self, packed: Array) -> None:
        self.module.set_colours(self.address, packed)

    def set_values(
        self, values: Array, low: float, high: float, palette: Array, missing: int
    ) -> None:
        self.module.set_values(self.address, values, low, high, palette, missing)


class _StockNodes:
    """Draws with Coin's SoIndexedFaceSet."""

    def __init__(self, field: Field) -> None:
        self.points, self.rays, self.normals = field.points, field.rays, field.normals
        self.colours = coin.SoPackedColor()
        binding = coin.SoMaterialBinding()
        binding.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
        self.coordinates = coin.SoCoordinate3()
        normals = coin.SoNormal()
        normals.vector.setValues(0, len(self.normals), self.normals.tolist())
        normal_binding = coin.SoNormalBinding()
        normal_binding.value = coin.SoNormalBinding.PER_VERTEX_INDEXED
        self.shape = coin.SoIndexedFaceSet()
        ends = np.full((len(field.triangles), 1), -1)
        indices = np.hstack([field.triangles.astype(np.int64), ends]).ravel()
        self.shape.coordIndex.setValues(0, len(indices), indices.tolist())
        self.parts = (
            self.colours,
            binding,
            self.coordinates,
            normals,
            normal_binding,
            self.shape,
        )

    def set_heights(self, heights: Array) -> None:
        points = self.points + heights[:, None] * self.rays
        self.coordinates.point.setValues(0, len(points), list(map(tuple, points.tolist())))

    def set_colours(self, packed: Array) -> None:
        opaque = packed | np.uint32(0xFF)
        self.colours.orderedRGBA.setValues(0, len(packed), opaque.tolist())


class FieldView:
    """A core.HeightField as Coin nodes; add ``node`` to a scene. Coordinates: mm, work frame.

    ``stock_nodes``: draw with Coin's stock nodes in any case. ``own_node`` tells which it is. All
    calls belong to the window's thread.
    """

    def __init__(self, field: Field, stock_nodes: bool = False) -> None:
        # The field itself stays alive: its arrays are views of it.
        self.field = field
        self.points, self.rays = field.points, field.rays
        self.flags, self.faces = field.flags, field.faces
        module = None if stock_nodes else _coin_module()
        self.own_node = module is not None
        self.drawn: _OwnNode | _StockNodes = (
            _StockNodes(field) if module is None else _OwnNode(module, field)
        )
        light = coin.SoLightModel()  # none: a shade would change what a colour says
        light.model = coin.SoLightModel.BASE_COLOR
        hints = coin.SoShapeHints()  # seen from both sides
        hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
        self.node = coin.SoSeparator()
        behind = coin.SoPolygonOffset()  # lines on the surface are drawn whole
        for part in (light, hints, behind, *self.drawn.parts):
            self.node.addChild(part)
        self.set_heights(field.height)
        self.drawn.set_colours(np.full(len(self.points), 0xB0B0B0FF, dtype=np.uint32))

    def set_heights(self, heights: Array) -> None:
        """Moves the samples: ``heights`` (n,) mm along the rays. Colours stay as they are."""
        self.heights = self._one_each(heights, np.float64).copy()
        self.drawn.set_heights(self.heights)

    def set_colours(self, colours: Array) -> None:
        """``colours``: (n, 4) uint8 RGBA, or (n,) uint32 0xRRGGBBAA; drawn opaque."""
        colours = np.asarray(colours)
        if colours.ndim == 2:
            if colours.dtype != np.uint8 or colours.shape[1] != 4:
                raise InputError("gui.colours", "colours are (n, 4) uint8 or (n,) uint32")
            colours = np.ascontiguousarray(colours).view(">u4").ravel().astype(np.uint32)
        self.drawn.set_colours(self._one_each(colours, np.uint32))

    def colour_by(self, mode: str, *limits: Any, values: Array | None = None) -> None:
        """Colours by one of MODES.

        deviation: ``limits`` are lower and upper limit and the end of the ramps, mm; then, if not
        the usual ones, bands and colours as core.deviation_colours has them. removed depth, uncertainty: the end of the ramp, mm. face: none. pressure (MPa), contact (a mask or a share):
        ``values`` (n,), and the end of the ramp (contact: 1 if not given). ``values`` replaces what
        the field knows in the other modes too.
        """
        if values is not None:
            values = self._one_each(values, np.float64)
        if mode == FACE:
            self.drawn.set_colours(core.face_colours(self.faces))
        elif mode == DEVIATION:
            values = self.heights if values is None else values
            if isinstance(self.drawn, _OwnNode):
                lower, upper, limit, *steps = limits
                end = max(float(limit), LEAST)
                palette = core.colour_scale(lower, upper, limit, _middles(-end, end), *steps)
                self._set_values(self.drawn, values, -end, end, palette)
            else:
                self.drawn.set_colours(core.height_colours(values, self.flags, *limits))
        elif mode in MODES:
            if values is None:
                values = self._known(mode)
            limits = limits or ((1.0,) if mode == CONTACT else ())
            if isinstance(self.drawn, _OwnNode):
                end = max(float(limits[0]), LEAST)
                palette = core.uncertainty_scale(end, _middles(0.0, end))
                self._set_values(self.drawn, values, 0.0, end, palette)
            else:
                self.drawn.set_colours(core.magnitude_colours(values, self.flags, *limits))
        else:
            raise InputError(
                "gui.colour_mode",
                "'{mode}' is no colour mode; use one of {modes}",
                mode=mode,
                modes=", ".join(MODES),
            )

    def _set_values(
        self, drawn: _OwnNode, values: Array, low: float, high: float, palette: Array
    ) -> None:
        missed = (self.flags & core.MISSED) != 0
        values = np.where(missed, np.nan, values)
        (missing,) = core.colour_scale(-1.0, 1.0, 2.0, [np.nan])
        drawn.set_values(values, low, high, palette, int(missing))

    def _known(self, mode: str) -> Array:
        if mode == REMOVED:
            return np.maximum(self.field.stock_height - self.heights, 0.0)
        if mode == UNCERTAINTY:
            if len(self.field.height_sd) != len(self.points):
                raise InputError(
                    "inspection.no_uncertainty",
                    "the result has no uncertainty: its law was not calibrated",
                )
            return self.field.height_sd
        raise InputError("gui.colour_values", "colours by {mode} need its values", mode=mode)

    def _one_each(self, values: Array, kind: Any) -> Array:
        values = np.ascontiguousarray(values, dtype=kind)
        if values.shape != (len(self.points),):
            raise InputError(
                "gui.values",
                "{given} values given, ({needed},) needed",
                given=values.shape,
                needed=len(self.points),
            )
        return values

    def pick(self, view: View3D, position: Sequence[float]) -> int | None:
        """The sample drawn at ``position`` (x, y in pixels from the lower left) of a FreeCAD 3D
        view; None beside the field. Other things in front are looked through."""
        width, height = view.getSize()
        region = coin.SbViewportRegion(int(width), int(height))
        root = coin.SoSeparator()
        root.ref()
        root.addChild(view.getCameraNode())
        place = coin.SoMatrixTransform()
        place.matrix = self._placed(view.getSceneGraph(), region)
        root.addChild(place)
        root.addChild(self.node)
        index = self.pick_in(root, region, position)
        root.removeAllChildren()
        root.unref()
        return index

    def pick_in(self, root: Node, region: Any, position: Sequence[float]) -> int | None:
        """The same in a scene of one's own: ``root`` with camera and ``node``."""
        action = coin.SoRayPickAction(region)
        action.setPoint(coin.SbVec2s(int(position[0]), int(position[1])))
        action.setRadius(PICK_RADIUS)
        action.apply(root)
        picked = action.getPickedPoint()
        if picked is None or picked.getDetail() is None:
            return None
        detail = coin.cast(picked.getDetail(), "SoFaceDetail")
        corners = [detail.getPoint(k).getCoordinateIndex() for k in range(detail.getNumPoints())]
        at = np.array(picked.getObjectPoint().getValue(), dtype=float)
        tops = self.points[corners] + self.heights[corners, None] * self.rays[corners]
        return int(corners[np.linalg.norm(tops - at, axis=1).argmin()])

    def _placed(self, scene: Node, region: Any) -> Any:
        """The matrix at which the scene draws the node; unity where it does not."""
        search = coin.SoSearchAction()
        search.setNode(self.node)
        search.apply(scene)
        if search.getPath() is None:
            return coin.SbMatrix.identity()
        matrix = coin.SoGetMatrixAction(region)
        matrix.apply(search.getPath())
        return matrix.getMatrix()


def _middles(low: float, high: float) -> list[float]:
    """The values in the middle of a palette's colours."""
    return (low + (high - low) * (np.arange(PALETTE) + 0.5) / PALETTE).tolist()
