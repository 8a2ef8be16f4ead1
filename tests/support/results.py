"""Results whose files a test changes."""

import json
from pathlib import Path


def unseal(folder):
    """Makes a result one of an older version, which has no sums of its files; returns its summary."""
    path = Path(folder, "summary.json")
    summary = json.loads(path.read_text())
    for key in ("files", "sha256", "run_id"):
        summary.pop(key, None)
    path.write_text(json.dumps(summary))
    return summary
