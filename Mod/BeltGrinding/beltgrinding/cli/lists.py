"""What there is to choose from."""

import json


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    preset = commands.add_parser("presets", help="list the presets, with their sources")
    preset.add_argument(
        "kind",
        nargs="?",
        choices=(
            "machines",
            "wheels",
            "belts",
            "materials",
            "thermals",
            "robots",
            "actuators",
            "controllers",
        ),
    )
    preset.add_argument("--json", action="store_true", help="as JSON")
    preset.set_defaults(do=_presets)
    printed = commands.add_parser("schema", help="print the JSON Schema of job.json")
    printed.add_argument(
        "name",
        nargs="?",
        choices=(
            "job",
            "contact",
            "presets",
            "raster",
            "plan",
            "study",
            "events",
            "summary",
            "values",
            "verdict",
        ),
        default="job",
    )
    printed.set_defaults(do=_schema)


def _presets(arguments):
    from ..presets import library as presets

    presets.print_list(arguments.kind, arguments.json)


def _schema(arguments):
    from ..base import schemas

    print(json.dumps(schemas.schema(arguments.name), indent=2, allow_nan=False))
