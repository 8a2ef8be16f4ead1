"""The compiled core and what every caller of it needs: ``core``, ``Fact``, ``InputError``,
``Cancelled``, ``RunContext``, ``__version__``.

They are taken from the core when first asked for: without a core that fits, the workbench must still be
able to say so (``library``).
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import beltgrinding_core as core
    from beltgrinding_core import VERSION as __version__
    from beltgrinding_core import Cancelled, Fact, InputError, RunContext

    __all__ = ["Cancelled", "Fact", "InputError", "RunContext", "__version__", "core"]

NAMES = {name: name for name in ("Fact", "InputError", "Cancelled", "RunContext")}
NAMES["__version__"] = "VERSION"


def __getattr__(name: str) -> Any:
    if name != "core" and name not in NAMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    from . import library

    core = globals()["core"] = library.load()
    globals().update({ours: getattr(core, theirs) for ours, theirs in NAMES.items()})
    return globals()[name]


def __dir__() -> list[str]:
    return sorted({*globals(), "core", *NAMES})
