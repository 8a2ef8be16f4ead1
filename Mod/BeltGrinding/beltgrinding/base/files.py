"""Files that are written whole or not at all."""

import json
import os


def write_whole(path, data):
    """Writes bytes to ``path``, whole or not at all."""
    part = path.with_name(path.name + ".part")
    try:
        part.write_bytes(data)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def json_bytes(data):
    return (json.dumps(data, indent=2, allow_nan=False) + "\n").encode()
