"""What every document object of the workbench has in common."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import FreeCAD

from ..engine import InputError
from . import damage, view_providers
from .kinds import DocumentObject


class Stateless:
    """A proxy without state of its own: all state lives in properties.

    FreeCAD 0.20 calls __getstate__ and __setstate__, 1.0 prefers dumps and loads.
    """

    def dumps(self) -> None:
        return None

    def loads(self, state: object) -> None:
        return None

    __getstate__ = dumps

    def __setstate__(self, state: object) -> None:
        return None


class Proxy(Stateless):
    """Base of the objects' proxies. ``TYPE`` tells objects apart; ``VIEW`` names the view provider
    in gui/views/providers.py; ``add_properties`` also gives a file of an older version what it lacks.
    """

    TYPE = ""
    VIEW = ""
    SCHEMA = 1

    def __init__(self, obj: DocumentObject) -> None:
        obj.Proxy = self
        self._complete(obj)
        if FreeCAD.GuiUp:
            view_providers.attach(obj.ViewObject, self.VIEW)

    def loads(self, state: object) -> None:
        damage.look()

    __setstate__ = loads

    def onDocumentRestored(self, obj: DocumentObject) -> None:
        before = set(obj.PropertiesList)
        self._complete(obj)
        damage.restored(obj, before, self._complete)

    def onChanged(self, obj: DocumentObject, name: str) -> None:
        damage.changed(obj, name)

    def _complete(self, obj: DocumentObject) -> None:
        if "Schema" not in obj.PropertiesList:
            obj.addProperty("App::PropertyInteger", "Schema", "Base", "version of the properties")
            obj.setEditorMode("Schema", 2)
        self.add_properties(obj)
        obj.Schema = self.SCHEMA

    def add_properties(self, obj: DocumentObject) -> None:
        raise NotImplementedError

    def execute(self, obj: DocumentObject) -> None:
        """Nothing by default."""


@contextmanager
def checking(obj: DocumentObject) -> Iterator[None]:
    """Around the checks of an input of a job: if they fail, the job's results are out of date. The job
    does not say so itself, for FreeCAD recomputes nothing that depends on a failure.
    """
    try:
        yield
    except InputError:
        group = obj.getParentGroup()
        for one in getattr(group, "Group", ()):
            if "OutOfDate" in one.PropertiesList and not one.OutOfDate:
                one.OutOfDate = True
        raise


def type_of(obj: object) -> str:
    """The TYPE of a workbench object's proxy, '' for anything else."""
    return getattr(getattr(obj, "Proxy", None), "TYPE", "")
