"""Document objects that may have gone, alone or with their document."""

from __future__ import annotations

from .kinds import Document, DocumentObject

GONE = (
    NameError,
    ReferenceError,
    RuntimeError,
)  # of objects, of their views, of Qt's and Coin's parts of them


def named(document: Document, name: str) -> DocumentObject | None:
    """A document's object of this name, None once it or the document has gone."""
    try:
        return document.getObject(name)
    except GONE:
        return None


def living(obj: DocumentObject | None) -> DocumentObject | None:
    """The object, None once it is no longer in its document."""
    try:
        return obj if obj is not None and obj.Document.getObject(obj.Name) is not None else None
    except GONE:
        return None


def goes_with(obj: DocumentObject, document: Document) -> bool:
    """Whether an object goes with a document that is closed, or has gone before."""
    try:
        return bool(obj.Document == document)
    except GONE:
        return True
