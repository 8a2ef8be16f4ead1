"""Robot programs are read while the window stays alive, and reading can be cancelled."""

import gc
import threading
import time
import weakref
from pathlib import Path
from types import SimpleNamespace

import pytest
import FreeCAD
from PySide import QtCore, QtGui

import beltgrinding
from beltgrinding.base import stopping
from beltgrinding.engine import Cancelled
from beltgrinding.gui.common import runner
from beltgrinding.gui.common.runner import Background
from beltgrinding.objects import importer, robot_path
from beltgrinding.gui.common.task_progress import TaskRow
from support.hands import menu, prepare, settle, start, wait, widgets
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def dialogs():
    return [d for d in widgets(QtGui.QProgressDialog, "BeltGrinding_Waiting") if d.isVisible()]


def press_cancel():
    shown = dialogs()
    if not shown:
        return QtCore.QTimer.singleShot(20, press_cancel)
    assert shown[0].labelText().startswith("Reading pass.csv") and shown[0].isModal()
    button = shown[0].findChild(QtGui.QPushButton)
    press_on(button)


def press_on(button):
    # as the mouse does it: through whatever looks at all events
    middle = button.rect().center()
    for kind in (QtCore.QEvent.MouseButtonPress, QtCore.QEvent.MouseButtonRelease):
        held = (
            QtCore.Qt.LeftButton if kind == QtCore.QEvent.MouseButtonPress else QtCore.Qt.NoButton
        )
        event = QtGui.QMouseEvent(
            kind, QtCore.QPointF(middle), QtCore.Qt.LeftButton, held, QtCore.Qt.NoModifier
        )
        QtGui.QApplication.postEvent(button, event)


def boxes():
    return [b for b in widgets(QtGui.QMessageBox, "BeltGrinding_Error") if b.isVisible()]


def prepared():
    job = prepare()
    doc = job.Document
    read, ended = robot_path.read_program, []

    def slow(path, *roll, **keys):
        end = time.monotonic() + 30
        try:
            while time.monotonic() < end:
                stopping.check()
        except Cancelled:
            ended.append("cancelled")
            raise
        ended.append("read")
        return read(path)

    def deaf(path, *roll, **keys):
        time.sleep(3)  # as a library that looks at nothing
        ended.append("deaf")
        return read(path)

    def cancelled(action):
        QtCore.QTimer.singleShot(50, press_cancel)
        before = names(), doc.UndoCount
        begin = time.monotonic()
        action()
        settle()
        assert time.monotonic() - begin < 15, time.monotonic() - begin  # slow() goes on for 30
        assert (names(), doc.UndoCount) == before and not boxes() and not dialogs()

    def names():
        return [obj.Name for obj in doc.Objects]

    return SimpleNamespace(
        cancelled=cancelled, deaf=deaf, doc=doc, ended=ended, names=names, read=read, slow=slow
    )


@pytest.mark.slow
def test_reading_is_cancelled_and_nothing_is_changed():
    here = prepared()
    cancelled, doc, ended, slow = here.cancelled, here.doc, here.ended, here.slow
    patch(robot_path, "read_program", slow)
    patch(QtGui.QFileDialog, "getOpenFileName", lambda *_: ("pass.csv", ""))
    cancelled(lambda: menu("Import robot program..."))
    cancelled(lambda: menu("Read programs again"))
    cancelled(lambda: importer.insert("pass.csv", doc.Name))
    documents = set(FreeCAD.listDocuments())
    cancelled(lambda: importer.open("pass.csv"))
    assert set(FreeCAD.listDocuments()) == documents
    wait(lambda: len(ended) == 4, 5)
    assert ended == ["cancelled"] * 4 and len(doc.RobotPath.Poses) == 9


def test_what_does_not_listen_is_left_behind():
    here = prepared()
    cancelled, deaf, doc, ended, names = here.cancelled, here.deaf, here.doc, here.ended, here.names
    patch(robot_path, "read_program", deaf)
    cancelled(lambda: importer.insert("pass.csv", doc.Name))
    assert not ended and len(runner._going) == 1
    wait(lambda: not runner._going, 8)
    assert ended == ["deaf"] and names().count("RobotPath001") == 0


def test_the_window_lives_while_a_long_program_is_read():
    here = prepared()
    read = here.read
    line = "LIN {X %d,Y 2,Z 3,A 4,B 5,C 6}"
    Path("long.src").write_text("DEF a()\n" + "\n".join(line % k for k in range(20000)) + "\nEND\n")
    beats = []
    timer = QtCore.QTimer()
    timer.timeout.connect(lambda: beats.append((time.monotonic(), len(dialogs()))))
    timer.start(20)
    done = []

    def measured(path, *roll, **keys):
        program = read(path, *roll, **keys)
        done.append(time.monotonic())
        return program

    patch(robot_path, "read_program", measured)
    robot = robot_path.read_arrays("long.src")[0]
    timer.stop()
    meanwhile = [beat for beat in beats if beat[0] < done[0]]
    assert len(robot.motions) == 20000 and len(meanwhile) >= 5, len(meanwhile)
    assert meanwhile[-1][1] == 1 and not dialogs()
    try:
        robot_path.read_arrays("absent.src")
    except beltgrinding.engine.InputError as error:
        assert "absent.src" in str(error)
    else:
        raise AssertionError("no error")


def test_a_work_that_nobody_waits_for_ends_on_the_windows_thread():
    # Freed by its own thread, its timer goes on in the window's, and FreeCAD dies of it.
    freed, told = [], []

    def let_go(owner):
        work = Background(
            lambda context: time.sleep(0.3), lambda *outcome: told.append(outcome), owner
        )
        main = threading.main_thread()
        weakref.finalize(work, lambda: freed.append(threading.current_thread() is main))
        return work

    let_go(None).abandon()
    let_go(None)
    panel = QtGui.QWidget()
    let_go(panel)
    panel.deleteLater()
    DEFERRED_DELETE = 52  # QEvent's number of it: processEvents leaves those alone
    QtCore.QCoreApplication.sendPostedEvents(panel, DEFERRED_DELETE)

    def all_freed():
        gc.collect()
        return len(freed) == 3

    wait(all_freed, 10)
    assert freed == [True] * 3 and told == [(None, None)], (freed, told)


def test_garbage_is_freed_on_the_windows_thread_while_a_work_goes_on():
    start()
    here, freed = threading.get_ident(), []

    class Circle:
        def __init__(self):
            self.me, self.widget = self, QtGui.QWidget()

        def __del__(self):
            freed.append(threading.get_ident())

    def work(context):
        kept = []
        for k in range(200):
            kept.append([{str(i): [i]} for i in range(500)])  # Python's collector would run here
            time.sleep(0.002)
        return len(kept)

    assert gc.isenabled()
    done = []
    for k in range(20):
        Circle()
    first = runner.Background(work, lambda *outcome: done.append(outcome))
    second = runner.Background(work, lambda *outcome: done.append(outcome))
    assert not gc.isenabled()
    wait(lambda: len(done) == 2)
    settle()
    assert [o[0] for o in done] == [200, 200] and gc.isenabled()
    gc.collect()
    assert len(freed) == 20 and set(freed) == {here}, (freed, here)

    # One that is waited for, or abandoned, gives it back too.
    one = runner.Background(work, lambda *outcome: None)
    one.thread.join()
    one.forget()
    assert gc.isenabled()
    other = runner.Background(work, lambda *outcome: None)
    other.abandon()
    wait(lambda: not other.thread.is_alive())
    wait(gc.isenabled, 5)


def test_a_work_shows_how_far_it_is_and_what_is_left():
    start()
    steps, outcomes, threads = [0.25, 0.5], [], []

    def work(context):
        threads.append(threading.current_thread())
        begin = time.monotonic()
        while steps:
            context.report(steps[0] if time.monotonic() - begin < 1.5 else steps[-1])
            context.throw_if_cancelled()
            time.sleep(0.01)

    row = TaskRow()
    bar, text = row.follower.bar, row.text
    task = Background(work, lambda *outcome: outcomes.append(outcome))
    assert not row.isVisible()
    row.follow(task, "Counting")
    assert row.isVisible() and (bar.minimum(), bar.maximum()) == (0, 0)
    wait(lambda: bar.value() == 500, 5)
    assert "Counting, " in text.text() and "left" in text.text(), text.text()
    # A phase that begins anew: nobody knows how much is left.
    steps[-1] = 0.1
    wait(lambda: bar.maximum() == 0, 5)
    assert "Counting, " in text.text() and "left" not in text.text(), text.text()
    row.button.click()
    wait(lambda: outcomes, 5)
    assert isinstance(outcomes[0][1], Cancelled)
    row.end()
    assert not row.isVisible() and threads[0] is not threading.main_thread()
