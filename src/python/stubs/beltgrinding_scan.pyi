# Made by tools/stubs.py from beltgrinding_scan: what mypy knows of it. Do not edit.
import builtins
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, SupportsIndex, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

def measure_cloud(cloud: ArrayLike, points: ArrayLike, normals: ArrayLike, start: Sequence[float] | NDArray[Any], reach: float, neighbours: SupportsIndex = ...) -> NDArray[np.float64]: ...
def register_scan(scan: ArrayLike, scan_normals: ArrayLike, datum: ArrayLike, datum_normals: ArrayLike, spacing: float, start: ArrayLike, max_distance: float, share: float, fixed: Sequence[bool], iterations: SupportsIndex = ..., most_points: SupportsIndex = ...) -> dict[str, Any]: ...
