"""One undo step, aborted and reported if it fails."""

from __future__ import annotations

from types import TracebackType
from typing import Any

import FreeCAD

from ...objects.kinds import Document
from .messages import report


def commit(document: Document) -> None:
    """Ends the undo step that is open. FreeCAD closes one only in a document that it has changed: else it stays open for
    all documents, and takes in what the next command does there."""
    if document.HasPendingTransaction:
        document.commitTransaction()
    else:
        FreeCAD.closeActiveTransaction(False)


def abort(document: Document) -> None:
    """Takes back what the undo step that is open has changed in ``document``, and ends it. Where it has changed nothing
    there it is ended only: what it holds of other documents is no panel's to take back."""
    if document.HasPendingTransaction:
        document.abortTransaction()
    else:
        commit(document)


class transaction:
    """One undo step; aborted, and the error reported, if the block fails or is cancelled. ``panel``: the
    step stays open for the panel that follows, whose Cancel takes it back.
    """

    def __init__(self, document: Document, name: str, panel: bool = False) -> None:
        self.document, self.name, self.panel = document, name, panel
        self.failed = False

    def __enter__(self) -> transaction:
        self.document.openTransaction(self.name)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: Any,
        trace: TracebackType | None,
    ) -> bool:
        if kind is None:
            if not self.panel:
                commit(self.document)
            return False
        self.failed = True
        from ...engine import Cancelled  # not above, as in messages

        abort(self.document)
        if issubclass(kind, Cancelled):
            return True  # whoever cancels knows
        if issubclass(kind, Exception):
            report(error)
            return True
        return False
