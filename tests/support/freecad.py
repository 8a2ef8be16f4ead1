"""Calls functions of tests, and runs pieces of Python, inside FreeCAD, with or without its window."""

import contextlib
import io
import os
import pickle
import select
import shutil
import signal
import subprocess
import sys
import textwrap
import time
import warnings
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MOD = ROOT / "Mod" / "BeltGrinding"
SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
TIME_LIMIT = 600  # s, of which the slowest test takes a quarter on a busy machine
SHOWN = 8000  # characters of FreeCAD's output that a failure shows
SCREEN = "-screen 0 1400x900x24"


class FreeCad:
    """A home folder, its FreeCAD with our workbench installed by a link unless told otherwise.

    One FreeCAD with a window, and one without, serve all calls that do not ask for a ``fresh`` one: it
    takes seconds to start. After each ``restoring.restore`` puts it back; one that fails, or has taken
    much memory, is followed by a new one.
    """

    def __init__(self, folder, link=True):
        self.folder = Path(folder)
        mods = self.folder / ".local" / "share" / "FreeCAD" / "Mod"
        mods.mkdir(parents=True)
        if link:
            (mods / "BeltGrinding").symlink_to(MOD)
        self.runs = 0
        self.output = ""
        self.servers = {}  # with a window or not: the Server

    def call(
        self, function, *arguments, window=False, fresh=False, folder=None, variables=None, **named
    ):
        """What a function of a test's file returns, called inside FreeCAD; fails the test with the
        traceback and FreeCAD's output if it raises. Arguments and value are pickled. ``folder`` is its
        current folder, the home's by default; ``variables`` are added to the environment. What FreeCAD
        has told meanwhile is ``output`` then.
        """
        try:
            given = pickle.dumps((arguments, named))
        except (AttributeError, TypeError, pickle.PicklingError) as error:
            pytest.fail(f"What goes into FreeCAD is pickled: {error}", pytrace=False)
        file = function.__code__.co_filename
        task = {"function": (file, function.__name__), "arguments": given}
        value, self.output = self._ask(task, window, fresh, folder, variables or {})
        return pickle.loads(value)

    def run(self, body, window=False, fresh=False, **variables):
        """FreeCAD's output while it runs ``body`` (Python); otherwise as ``call``."""
        self.runs += 1
        script = self.folder / f"run{self.runs}.py"
        script.write_text(textwrap.dedent(body))
        return self._ask({"script": str(script)}, window, fresh or not window, None, variables)[1]

    def environment(self, **variables):
        """The environment of a FreeCAD in this home."""
        own = {"QTWEBENGINE_DISABLE_SANDBOX": "1", "HOME": str(self.folder)}
        return {**os.environ, **own, **variables}

    def _ask(self, task, window, fresh, folder, variables):
        """(what it returned, FreeCAD's output meanwhile)."""
        for tool in ("freecad", "xvfb-run") if window else ("freecadcmd",):
            if shutil.which(tool) is None:
                pytest.skip(f"{tool} is not installed")
        task["variables"] = {name: str(value) for name, value in variables.items()}
        task["folder"] = str(folder or self.folder)
        task["path"] = [part for part in sys.path if Path(part).is_relative_to(ROOT / "tests")]
        key = "fresh" if fresh else window
        for last in (False, True):
            if key not in self.servers:
                environment = self.environment(**task["variables"])
                self.servers[key] = Server(self.folder, window, environment)
            server = self.servers[key]
            try:
                outcome, value, output = server.ask(task)
            except BaseException:  # else FreeCAD and its screen would outlive xvfb-run
                self.close(key)
                raise
            if fresh or outcome == "failed" or server.tired:
                self.close(key)
            if not server.hung or last:
                break
            # One that is ours comes again; FreeCAD's own, once in thousands of tests, does not.
            warnings.warn(f"FreeCAD hung and was started anew: {output}", stacklevel=4)
        if outcome == "skipped":
            pytest.skip(value)
        if outcome == "failed":
            pytest.fail(f"\n{value}\n{output}", pytrace=False)
        return value, output

    def close(self, *keys):
        """Ends its FreeCADs, or one."""
        for key in keys or list(self.servers):
            self.servers.pop(key).close()


class Server:
    """A FreeCAD that does one task after the other (tests/support/serve.py)."""

    def __init__(self, home, window, environment):
        self.logs = [home / "out.log", home / "err.log"]
        self.hung = self.tired = False
        self.answers, answer = os.pipe()
        command = ["freecad" if window else "freecadcmd", str(ROOT / "tools" / "in_freecad.py")]
        if window:
            command = ["xvfb-run", "-a", "-s", SCREEN, *command]
        environment.update(
            BELTGRINDING_RUN=str(ROOT / "tests" / "support" / "serve.py"),
            ANSWERS=str(answer),
            PATIENCE=str(TIME_LIMIT - 20),
        )
        with self.logs[0].open("ab") as out, self.logs[1].open("ab") as told:
            self.begins = [out.tell(), told.tell()]
            self.process = subprocess.Popen(
                command,
                env=environment,
                cwd=home,
                stdin=subprocess.PIPE,
                stdout=out,
                stderr=told,
                pass_fds=(answer,),
                start_new_session=True,
            )
        os.close(answer)

    def ask(self, task):
        """(how it ended, its value or what went wrong, FreeCAD's output since it was asked last)."""
        try:
            self.process.stdin.write(pickle.dumps(task))
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # it says below what it died of
        answer = self._answer()
        output = ""
        for k, log in enumerate(self.logs):
            said = log.read_bytes()[self.begins[k] :]
            self.begins[k] += len(said)
            text = said.decode(errors="replace").replace("\r", "\n")  # FreeCAD's progress ends so
            output += text[-SHOWN // 2 :]
        if answer is None:
            return "failed", self._end(), output
        outcome, value, self.tired = answer
        return outcome, value, output

    def _end(self):
        """How FreeCAD ended, or that it has not."""
        try:
            return f"FreeCAD died, exit status {self.process.wait(5)}"
        except subprocess.TimeoutExpired:
            self.hung = True
            return f"FreeCAD hangs: no answer within {TIME_LIMIT} s\n{self._stacks()}"

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
        """What it answers; None if FreeCAD is dead or takes too long."""
        told, end = b"", time.monotonic() + TIME_LIMIT
        while True:
            if not select.select([self.answers], [], [], max(end - time.monotonic(), 0))[0]:
                return None
            part = os.read(self.answers, 1 << 16)
            if not part:
                return None
            told += part
            with contextlib.suppress(EOFError, pickle.UnpicklingError):
                return pickle.load(io.BytesIO(told))

    def close(self):
        """Ends FreeCAD and its screen, by force if it does not listen."""
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        os.close(self.answers)
        try:
            self.process.wait(0 if self.hung else 10)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()


@pytest.fixture(scope="module")
def freecad(tmp_path_factory):
    made = FreeCad(tmp_path_factory.mktemp("freecad"))
    yield made
    made.close()
