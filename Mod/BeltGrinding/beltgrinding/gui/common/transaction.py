"""One undo step, aborted and reported if it fails."""

from .messages import report


class transaction:
    """One undo step; aborted, and the error reported, if the block fails or is cancelled. ``panel``: the
    step stays open for the panel that follows, whose Cancel takes it back.
    """

    def __init__(self, document, name, panel=False):
        self.document, self.name, self.panel = document, name, panel
        self.failed = False

    def __enter__(self):
        self.document.openTransaction(self.name)
        return self

    def __exit__(self, kind, error, trace):
        if kind is None:
            if not self.panel:
                self.document.commitTransaction()
            return False
        self.failed = True
        from ...engine import Cancelled  # not above, as in messages

        self.document.abortTransaction()
        if issubclass(kind, Cancelled):
            return True  # whoever cancels knows
        if issubclass(kind, Exception):
            report(error)
            return True
        return False
