"""The 3D views' cameras, turned to a place of the part from where it is seen; what hides it fades."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import FreeCADGui as Gui
import numpy as np
from pivy import coin

from ...engine import InputError, core
from ...inspection import sight
from ...objects import belt_machine
from ...objects.kinds import DocumentObject, Field, Point
from ..common.kinds import Array, Node, Surface, View3D
from .camera import fly_to
from .part_context import REST, design_of, tessellated
from .shapes3d import faint

if TYPE_CHECKING:
    from .cell_view import CellView

SEEN = 0.6  # of a place: less, and what hides it fades
SLACK = 1e-3  # of the part's diagonal: within it, the part's own triangles do not hide a place
ASIDE = 0.65  # of the view's direction along the wheel's axis: the contact is seen from the side
POINTS = 200  # of a place, at most
WHEEL_AXIS = (-0.4, 0.4)  # of the wheel's width: points of it that should be seen


class Sight:
    """Looks at places of a job's part in all 3D views of its document."""

    def __init__(self, job: DocumentObject) -> None:
        self.document, self.name = job.Document, job.Name
        self.part: Surface | None = None
        self.faded: list[tuple[Node, Node]] = []  # (separator, node in it)
        self.cell: CellView | None = None

    def at_samples(
        self, field: Field, samples: Any, size: float, middle: Point | None = None
    ) -> None:
        """Looks at ``samples`` (indices; the first is the one that matters) of a core.HeightField, at
        ``middle`` (mm) or the first, ``size`` mm around."""
        self.clear()
        samples = np.asarray(samples)
        first, rest = samples[:1], samples[1:]
        near = rest[field.normals[rest] @ field.normals[first[0]] > 0.2]
        chosen = np.concatenate([first, near[sight.thinned(len(near), POINTS)]])
        points = field.points[chosen] + field.height[chosen, None] * field.rays[chosen]
        normals = field.normals[chosen]
        target = points[0] if middle is None else np.asarray(middle, dtype=float)
        slack = 2.0 * field.spacing
        away, share = self._towards([self._part()], points, normals, normals[0], slack)
        if share < SEEN:
            self._fade_rest()
        for view in self._views():
            fly_to(view, target.tolist(), away.tolist(), size)

    def at_contact(self, cell: CellView, point: Array, size: float) -> None:
        """Looks at ``point`` (3,) mm of the part at the pose of a CellView, from aside of the wheel."""
        self.clear()
        frames, moved = cell.frames(), cell.carried(cell.frames())
        contact = frames["contact"]
        axis, away = contact[:3, 1], -contact[:3, 2]
        views = self._views()
        if not views:
            return
        # All views alike: the first one says on what side one stands.
        ahead = moved[:3, :3].T @ np.array(views[0].getViewDirection())
        side = -axis if axis @ ahead > 0.0 else axis
        wanted = ASIDE * side + (1.0 - ASIDE) * away
        machine = cell.machine
        places = [point]
        if machine is not None:
            # A belt's rollers lie beside the work, not above it: half a width away is where it is seen from.
            wide = belt_machine.across(machine)
            wheel = machine.Kind in belt_machine.WHEELS
            centre = contact[:3, 3] + (machine.WheelRadius.Value if wheel else 0.5 * wide) * away
            ends = [centre + share * wide * axis for share in WHEEL_AXIS]
            places += ends
        # The camera stands where it is wanted if all is seen from there; facing is no matter here.
        facing = np.tile(wanted / np.linalg.norm(wanted), (len(places), 1))
        others = {name: solid for name, solid in cell.solids().items() if name not in cell.tinted}
        meshes = [self._part(), *others.values()]
        lift = max(SLACK * self._diagonal(), 0.5)
        to, share = self._towards(meshes, np.array(places) + lift * away, facing, wanted, lift)
        if share < SEEN:
            self._fade_rest()
            self.cell = cell
            cell.fade(
                [
                    name
                    for name, solid in others.items()
                    if not core.Renderer([_surface(*solid)]).seen([point], [to], lift)[0, 0]
                ]
            )
        # Half way to the wheel's centre, so that both are in the picture.
        target = moved[:3, :3] @ (point + 0.2 * size * away) + moved[:3, 3]
        for view in views:
            fly_to(view, target.tolist(), (moved[:3, :3] @ to).tolist(), size)

    def clear(self) -> None:
        """What has faded is drawn as before."""
        for root, node in self.faded:
            if root.findChild(node) >= 0:
                root.removeChild(node)
        self.faded = []
        if self.cell is not None:
            self.cell.fade(())
            self.cell = None

    def _towards(
        self, meshes: Iterable[Surface], points: Array, normals: Array, wanted: Any, slack: float
    ) -> tuple[Array, float]:
        surfaces = [_surface(*mesh) for mesh in meshes if len(mesh[1])]
        if not surfaces:
            return np.asarray(wanted, dtype=float), 1.0
        return sight.towards(core.Renderer(surfaces), points, normals, wanted, slack)

    def _part(self) -> Surface:
        if self.part is None:
            job = self.document.getObject(self.name)
            try:
                self.part = tessellated(design_of(job)[0])
            except InputError:
                self.part = np.zeros((0, 3)), np.zeros((0, 3), dtype=np.uint32)
        return self.part

    def _diagonal(self) -> float:
        points, _ = self._part()
        return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0

    def _views(self) -> list[View3D]:
        return Gui.getDocument(self.document.Name).mdiViewsOfType("Gui::View3DInventor")

    def _fade_rest(self) -> None:
        for view in self._views():
            search = coin.SoSearchAction()
            search.setName(REST)
            search.setSearchingAll(True)
            search.setInterest(coin.SoSearchAction.ALL)
            search.apply(view.getSceneGraph())
            found = search.getPaths()
            for k in range(found.getLength()):
                root = coin.cast(found[k].getTail(), "SoSeparator")
                node = faint()
                root.insertChild(node, 0)
                self.faded.append((root, node))


def _surface(points: Any, triangles: Any) -> dict[str, Array]:
    return {
        "vertices": np.asarray(points, dtype=float),
        "triangles": np.asarray(triangles, dtype=np.uint32),
        "colours": np.array([0], dtype=np.uint32),
    }
