"""What file dialogs offer."""

from __future__ import annotations

from ...programs.registry import file_pattern
from .compat import translate


def programs_filter() -> str:
    """What a file dialog for robot programs offers."""
    return translate("BeltGrinding", "Robot programs") + f" ({file_pattern()})"
