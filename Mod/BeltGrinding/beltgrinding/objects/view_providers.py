"""How objects get their view providers, which stand in a layer above: its factory is put in here."""

from __future__ import annotations

from typing import Any

from .kinds import ViewObject

factory: Any = None  # (view object, name of the class) -> None: set by the package itself


def attach(view_object: ViewObject, name: str) -> None:
    """Gives a view object the view provider of that name."""
    factory(view_object, name)
