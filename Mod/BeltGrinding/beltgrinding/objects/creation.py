"""How objects are added to a document: whole, or not at all."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING, Literal

from .job_data import child
from .kinds import DocumentObject, Properties
from .properties import set_by_name

if TYPE_CHECKING:
    from .proxy import Proxy


def make_child(
    job: DocumentObject, proxy: type[Proxy], name: str, label: str, properties: Properties
) -> DocumentObject:
    """The job's child of a kind, made where it is missing, with properties set."""
    found = child(job, proxy)
    if found is not None:
        set_by_name(found, properties)
        return found
    found = job.Document.addObject("App::FeaturePython", name)
    with removed_on_error(found):
        proxy(found)
        called(found, label)
        set_by_name(found, properties)
        job.addObject(found)
    return found


def called(obj: DocumentObject, label: str) -> DocumentObject:
    """Gives a new object the label that it has in the user's language; English ones are FreeCAD's, numbered
    where there are several."""
    if obj.Label.rstrip("0123456789") != label:
        obj.Label = label
    return obj


class removed_on_error:
    """Removes a new object from its document if the block fails."""

    def __init__(self, obj: DocumentObject) -> None:
        self.document, self.name = obj.Document, obj.Name

    def __enter__(self) -> removed_on_error:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> Literal[False]:
        if kind is not None and self.document.getObject(self.name) is not None:
            self.document.removeObject(self.name)
        return False
