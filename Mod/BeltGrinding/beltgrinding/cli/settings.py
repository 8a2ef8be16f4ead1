"""Settings of a command: a JSON file, and single ones as KEY=VALUE."""

import json
from pathlib import Path


def given(file, pairs, option="--set"):
    """A dict of the settings in ``file`` (None: none), and of ``pairs``, KEY=VALUE with the value as JSON or as text.
    Raises InputError."""
    from ..base import schemas
    from ..engine import InputError

    settings = schemas.read_json(Path(file)) if file else {}
    if not isinstance(settings, dict):
        raise InputError(
            "cli.settings_no_object", "{file}: the settings are no object of keys", file=file
        )
    for one in pairs:
        key, equals, value = one.partition("=")
        if not equals:
            raise InputError(
                "cli.set_without_value",
                "{option} {given}: write KEY=VALUE",
                option=option,
                given=one,
            )
        try:
            settings[key] = json.loads(value)
        except ValueError:
            settings[key] = value
    return settings
