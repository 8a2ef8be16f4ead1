"""What file dialogs offer."""

from ...programs.registry import file_pattern
from .compat import translate


def programs_filter():
    """What a file dialog for robot programs offers."""
    return translate("BeltGrinding", "Robot programs") + f" ({file_pattern()})"
