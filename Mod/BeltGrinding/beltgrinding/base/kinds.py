"""Names of types that stand in many signatures. It loads nothing: they are read by who checks types."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..engine import core

Json: TypeAlias = Mapping[str, Any]  # an object of JSON, checked by its schema
Array: TypeAlias = "NDArray[Any]"
Floats: TypeAlias = "NDArray[np.float64]"
Facts: TypeAlias = "list[core.Fact]"
Context: TypeAlias = "core.RunContext | None"

T = TypeVar("T")


def known(value: T | None) -> T:
    """What must be there for what is asked of it, as a result's steps for their figures."""
    assert value is not None
    return value
