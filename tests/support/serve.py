"""Run inside FreeCAD: calls the functions of test files that stdin names, one after the other, and says on
the pipe ANSWERS what became of each. See tests/support/freecad.py.
"""

import faulthandler
import inspect
import os
import pickle
import resource
import runpy
import sys
import traceback

import pytest
from _pytest.assertion import util
from _pytest.config import get_config

from support import inside, restoring

TIRED = 2_000_000  # KiB; a FreeCAD that has taken so much is not asked again

answers = int(os.environ.pop("ANSWERS"))
patience = float(os.environ.pop("PATIENCE"))  # s, after which a hanging test says where it is
log = open(2, "w", closefd=False)  # sys.stderr is FreeCAD's own
faulthandler.enable(log)  # a crash says where it was; FreeCAD's own handler does not
environment = dict(os.environ)
home, path = os.getcwd(), list(sys.path)
config = get_config()
config.parse(["-s", "--noconftest", "-c", os.devnull, "-p", "no:cacheprovider", home])


def compare(*sides):
    """What differs between the sides of a comparison, as pytest asks for it."""
    lines = util.assertrepr_compare(config, *sides)
    return "\n~".join(line.replace("\n", "\\n") for line in lines) if lines else None


def stack(context=1):
    """Who calls, alone: FreeCAD asks for each command that a workbench adds and looks at no more, and
    ``inspect.stack`` searches all modules for each frame: 10 s for ours, this deep below the tests' frames.
    """
    caller = sys._getframe(1)
    return [inspect.FrameInfo(caller, caller.f_code.co_filename, caller.f_lineno, "", None, None)]


util._reprcompare = compare
inspect.stack = stack
modules = set()  # paths of the test files


def call(task):
    """(how it ended, what it returned or what went wrong)."""
    try:
        if "script" in task:
            runpy.run_path(task["script"], run_name="script")
            return "passed", None
        file, name = task["function"]
        module = inside.load(file)
        modules.add(file)
        arguments, named = pickle.loads(task["arguments"])
        value = getattr(module, name)(*arguments, **named)
        return "passed", pickle.dumps(value)
    except pytest.skip.Exception as skipped:
        return "skipped", str(skipped)
    except BaseException as error:
        return "failed", told(error)


def told(error):
    """The traceback as pytest shows it, from the test's own file on."""
    info = pytest.ExceptionInfo.from_exc_info((type(error), error, error.__traceback__))
    try:
        own = [k for k, entry in enumerate(info.traceback) if str(entry.path) in modules]
        info.traceback = type(info.traceback)(info.traceback[own[0] if own else 0 :])
        text = str(info.getrepr(style="long"))
        return text if text.startswith(("E ", "> ")) else f"    {text}"
    except Exception:
        return "".join(traceback.format_exception(error))


def put_back():
    """As it was before the test: its variables, folder and path."""
    # Only what differs: threads of FreeCAD's start page read the environment meanwhile.
    for name in os.environ.keys() | environment.keys():
        if name not in environment:
            del os.environ[name]
        elif os.environ.get(name) != environment[name]:
            os.environ[name] = environment[name]
    os.chdir(home)
    sys.path[:] = path
    sys.stdout.flush()
    sys.stderr.flush()


tasks = open(0, "rb", closefd=False)  # sys.stdin is FreeCAD's own
while True:
    try:
        task = pickle.load(tasks)
    except EOFError:
        break
    os.environ.update(task["variables"])
    os.chdir(task["folder"])
    sys.path += [folder for folder in task["path"] if folder not in sys.path]
    faulthandler.dump_traceback_later(patience, file=log)
    outcome = call(task)
    try:
        restoring.restore()
    except BaseException as error:
        if outcome[0] != "failed":
            outcome = "failed", told(error)
    faulthandler.cancel_dump_traceback_later()
    put_back()
    tired = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss > TIRED
    with open(answers, "wb", closefd=False) as pipe:
        pickle.dump((*outcome, tired), pipe)
