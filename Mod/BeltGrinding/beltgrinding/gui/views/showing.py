"""What the views of one job tell each other."""

from __future__ import annotations

from typing import Any

from ...objects.job_data import child
from ...objects.kinds import DocumentObject
from ...objects.stock import Stock


def show_stock(job: DocumentObject) -> None:
    """Draws a job's stock anew, or no longer."""
    stock = None if job is None else child(job, Stock)
    proxy: Any = getattr(getattr(stock, "ViewObject", None), "Proxy", None)
    if getattr(proxy, "shell", None) is not None:
        proxy.update_shell()
