"""What the views of one job tell each other."""

from ...objects.job_data import child
from ...objects.stock import Stock


def show_stock(job):
    """Draws a job's stock anew, or no longer."""
    stock = None if job is None else child(job, Stock)
    proxy = getattr(getattr(stock, "ViewObject", None), "Proxy", None)
    if getattr(proxy, "shell", None) is not None:
        proxy.update_shell()
