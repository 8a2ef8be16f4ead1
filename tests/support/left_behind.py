"""What tests and tools leave in the checkout, outside of build/."""

import subprocess

# What Python and its tools keep beside sources, and what people keep for themselves.
LET_BE = ("build/", "__pycache__/", ".venv/", ".idea/", ".vscode/")


def listing(root):
    """The files of a checkout that git does not track, ignored ones among them, as a set of paths below ``root``; None
    where it is no checkout of git."""
    command = ["git", "status", "--porcelain", "--ignored", "--untracked-files=all", "-z"]
    try:
        done = subprocess.run(command, cwd=root, capture_output=True, text=True, timeout=60)
    except (OSError, subprocess.TimeoutExpired):
        return None
    if done.returncode != 0:
        return None
    found = {line[3:] for line in done.stdout.split("\0") if line[:2] in ("??", "!!")}
    return {path for path in found if not _let_be(path)}


def _let_be(path):
    parts = [f"{part}/" for part in path.split("/")]
    return path.endswith(".pyc") or any(part in LET_BE for part in parts)


def sentence(before, after):
    """What is to be told of two listings, "" if nothing is."""
    left = sorted(after - before) if before is not None and after is not None else []
    if not left:
        return ""
    return "the tests left files in the checkout, outside of build/: " + ", ".join(left)
