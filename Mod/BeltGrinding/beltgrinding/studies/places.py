"""Where the tasks of a study run: on processes of this machine, or on the workers of a Dask scheduler that is there."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from ..engine import InputError
from . import cluster, clusters, pool

if TYPE_CHECKING:
    from .kinds import Run
    from .clusters import Tls


def runner(scheduler: str | None, tls: Tls, workers: int) -> Run:
    """``pool.run`` without its first argument. ``scheduler``: an address, None: so many ``workers`` of this machine; ``tls``: as
    ``clusters.There`` takes it. Raises InputError."""
    if scheduler is not None:
        return functools.partial(cluster.run, clusters.There(scheduler, tls))
    if tls is not None:
        raise InputError(
            "studies.tls_of_nothing",
            "a key or its lack belongs to a scheduler; give its address too",
        )
    return functools.partial(pool.run, workers)
