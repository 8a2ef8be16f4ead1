"""The compiled core and what every caller of it needs: ``core``, ``Fact``, ``InputError``,
``Cancelled``, ``RunContext``, ``__version__``.

They are taken from the core when first asked for: without a core that fits, the workbench must still be
able to say so (``library``).
"""

NAMES = {name: name for name in ("Fact", "InputError", "Cancelled", "RunContext")}
NAMES["__version__"] = "VERSION"


def __getattr__(name):
    if name != "core" and name not in NAMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    from . import library

    core = globals()["core"] = library.load()
    globals().update({ours: getattr(core, theirs) for ours, theirs in NAMES.items()})
    return globals()[name]


def __dir__():
    return sorted({*globals(), "core", *NAMES})
