"""Runs a piece of Python inside FreeCAD, with or without its window, in a home of its own."""

import os
import shutil
import subprocess
import textwrap
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MOD = ROOT / "Mod" / "BeltGrinding"
SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
TIME_LIMIT = 240  # s


class FreeCad:
    """A home folder, its FreeCAD with our workbench installed by a link unless told otherwise."""

    def __init__(self, folder, link=True):
        self.folder = Path(folder)
        mods = self.folder / ".local" / "share" / "FreeCAD" / "Mod"
        mods.mkdir(parents=True)
        if link:
            (mods / "BeltGrinding").symlink_to(MOD)
        self.runs = 0

    def run(self, body, window=False, **variables):
        """Runs ``body`` (Python); fails the test with FreeCAD's output if it raises."""
        program = "freecad" if window else "freecadcmd"
        for tool in (program, "xvfb-run"):
            if shutil.which(tool) is None:
                pytest.skip(f"{tool} is not installed")
        self.runs += 1
        script = self.folder / f"run{self.runs}.py"
        path = f"import sys\nsys.path.insert(0, {str(ROOT / 'tests')!r})\n"
        script.write_text(path + textwrap.dedent(body))
        command = [program, str(ROOT / "tools" / "in_freecad.py")]
        if window:
            command = ["xvfb-run", "-a", "-s", "-screen 0 1600x1000x24", *command]
        environment = {
            **os.environ,
            "QTWEBENGINE_DISABLE_SANDBOX": "1",
            "HOME": str(self.folder),
            "BELTGRINDING_RUN": str(script),
            **{name: str(value) for name, value in variables.items()},
        }
        done = subprocess.run(
            command,
            env=environment,
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=TIME_LIMIT,
        )
        output = done.stdout[-4000:] + done.stderr[-4000:]
        assert done.returncode == 0, output
        return output


@pytest.fixture(scope="module")
def freecad(tmp_path_factory):
    return FreeCad(tmp_path_factory.mktemp("freecad"))
