"""Run inside FreeCAD with a window: runs the scripts that stdin names, one after the other, and says on
the pipe ANSWERS whether each passed. See tests/support/freecad.py.
"""

import faulthandler
import json
import os
import runpy
import sys
import traceback

answers = int(os.environ.pop("ANSWERS"))
patience = float(os.environ.pop("PATIENCE"))  # s, after which a hanging script says where it is
log = open(2, "w", closefd=False)  # sys.stderr is FreeCAD's own
faulthandler.enable(log)  # a crash says where it was; FreeCAD's own handler does not
environment = dict(os.environ)
folder, path = os.getcwd(), list(sys.path)
for line in open(0, "rb", closefd=False):  # sys.stdin is FreeCAD's own
    task = json.loads(line)
    os.environ.update(task["variables"])
    answer = b"failed\n"
    faulthandler.dump_traceback_later(patience, file=log)
    try:
        runpy.run_path(task["script"], run_name="script")
        from support import hands

        hands.reset()
        answer = b"passed\n"
    except BaseException:
        traceback.print_exc()
    faulthandler.cancel_dump_traceback_later()
    # Only what differs: threads of FreeCAD's start page read the environment meanwhile.
    for name in os.environ.keys() | environment.keys():
        if name not in environment:
            del os.environ[name]
        elif os.environ.get(name) != environment[name]:
            os.environ[name] = environment[name]
    os.chdir(folder)
    sys.path[:] = path
    sys.stdout.flush()
    sys.stderr.flush()
    os.write(answers, answer)
