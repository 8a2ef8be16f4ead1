"""Runs pieces of Python inside FreeCAD, with or without its window, in a home of its own."""

import contextlib
import json
import os
import select
import shutil
import signal
import subprocess
import textwrap
import time
import warnings
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MOD = ROOT / "Mod" / "BeltGrinding"
SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
TIME_LIMIT = 300  # s, of which the slowest test takes a quarter beside another suite
SHOWN = 8000  # characters of FreeCAD's output that a failure shows
SCREEN = "-screen 0 1400x900x24"


class FreeCad:
    """A home folder, its FreeCAD with our workbench installed by a link unless told otherwise.

    One window serves all runs that do not ask for a ``fresh`` one: FreeCAD takes seconds to start.
    Between two runs ``hands.reset`` puts it back, and a run that fails has it started anew.
    """

    def __init__(self, folder, link=True):
        self.folder = Path(folder)
        mods = self.folder / ".local" / "share" / "FreeCAD" / "Mod"
        mods.mkdir(parents=True)
        if link:
            (mods / "BeltGrinding").symlink_to(MOD)
        self.runs = 0
        self.server = None

    def run(self, body, window=False, fresh=False, **variables):
        """Runs ``body`` (Python); fails the test with FreeCAD's output if it raises. ``variables``
        are added to the environment.
        """
        program = "freecad" if window else "freecadcmd"
        for tool in (program, "xvfb-run"):
            if shutil.which(tool) is None:
                pytest.skip(f"{tool} is not installed")
        self.runs += 1
        script = self.folder / f"run{self.runs}.py"
        path = f"import sys\nsys.path.insert(0, {str(ROOT / 'tests')!r})\n"
        script.write_text(path + textwrap.dedent(body))
        variables = {name: str(value) for name, value in variables.items()}
        if window and not fresh:
            return self._shared(script, variables)
        command = [program, str(ROOT / "tools" / "in_freecad.py")]
        if window:
            command = ["xvfb-run", "-a", "-s", SCREEN, *command]
        process = subprocess.Popen(
            command,
            env=self.environment(BELTGRINDING_RUN=str(script), **variables),
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        try:
            out, told = process.communicate(timeout=TIME_LIMIT)
        except BaseException:  # else FreeCAD and its screen would outlive xvfb-run
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            raise
        output = out[-SHOWN // 2 :] + told[-SHOWN // 2 :]
        assert process.returncode == 0, output
        return output

    def environment(self, **variables):
        """The environment of a FreeCAD in this home."""
        own = {"QTWEBENGINE_DISABLE_SANDBOX": "1", "HOME": str(self.folder)}
        return {**os.environ, **own, **variables}

    def _shared(self, script, variables):
        if self.server is None:
            self.server = Server(self)
        passed, output = self.server.run(script, variables)
        if not passed:
            hung = self.server.hung
            self.close()
            if hung:
                # One that is ours comes again; FreeCAD's own, once in thousands of tests, does not.
                warnings.warn(f"FreeCAD hung and was started anew: {output}", stacklevel=3)
                self.server = Server(self)
                passed, output = self.server.run(script, variables)
                if not passed:
                    self.close()
        assert passed, output
        return output

    def close(self):
        """Ends the window, if there is one."""
        if self.server is not None:
            self.server.close()
            self.server = None


class Server:
    """A FreeCAD with a window that runs one script after the other (tests/support/serve.py)."""

    def __init__(self, home):
        self.log = home.folder / "freecad.log"
        self.hung = False
        self.answers, answer = os.pipe()
        serve = str(ROOT / "tests" / "support" / "serve.py")
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                ["xvfb-run", "-a", "-s", SCREEN, "freecad", str(ROOT / "tools" / "in_freecad.py")],
                env=home.environment(
                    BELTGRINDING_RUN=serve, ANSWERS=str(answer), PATIENCE=str(TIME_LIMIT - 20)
                ),
                cwd=home.folder,
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=log,
                pass_fds=(answer,),
                start_new_session=True,
            )
        os.close(answer)

    def run(self, script, variables):
        """(whether it passed, FreeCAD's output meanwhile)."""
        begin = self.log.stat().st_size
        try:
            line = json.dumps({"script": str(script), "variables": variables}) + "\n"
            self.process.stdin.write(line.encode())
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # it says below what it died of
        answer = self._answer()
        output = self.log.read_bytes()[begin:].decode(errors="replace")[-SHOWN:]
        return answer == b"passed\n", output + ("" if answer else self._end())

    def _end(self):
        """How FreeCAD ended, or that it has not."""
        try:
            return f"\nFreeCAD died, exit status {self.process.wait(5)}"
        except subprocess.TimeoutExpired:
            self.hung = True
            return f"\nFreeCAD hangs: no answer within {TIME_LIMIT} s\n{self._stacks()}"

    def _stacks(self):
        """Where FreeCAD's native code is, if there is a debugger to ask."""
        if shutil.which("gdb") is None:
            return ""
        told = ""
        for process in Path("/proc").iterdir():
            with contextlib.suppress(OSError, ValueError):
                same = os.getsid(int(process.name)) == self.process.pid
                if same and "freecad" in (process / "comm").read_text().lower():
                    command = ["gdb", "-p", process.name, "-batch", "-ex", "thread apply all bt 30"]
                    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
                    told += done.stdout[-SHOWN:]
        return told

    def _answer(self):
        """One line, b"" if FreeCAD is dead or takes too long."""
        text, end = b"", time.monotonic() + TIME_LIMIT
        while not text.endswith(b"\n"):
            if not select.select([self.answers], [], [], max(end - time.monotonic(), 0))[0]:
                return b""
            part = os.read(self.answers, 100)
            if not part:
                return b""
            text += part
        return text

    def close(self):
        """Ends FreeCAD and its screen, by force if it does not listen."""
        self.process.stdin.close()
        os.close(self.answers)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()


@pytest.fixture(scope="module")
def freecad(tmp_path_factory):
    made = FreeCad(tmp_path_factory.mktemp("freecad"))
    yield made
    made.close()
