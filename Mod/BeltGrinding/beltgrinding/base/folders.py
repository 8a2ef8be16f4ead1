"""The files of a folder, replaced as a whole: whoever looks finds all of the old or all of the new,
also where the program or the machine stops in between.

What is new is written whole into a *stage*, a folder of its own, and onto the disk. Then either
- the stage changes places with the folder (renameat2 of Linux), which is one step for everybody; or,
  where that is not to be had or would be noticed (the folder has folders in it, is a mount point or
  somebody's working folder; its parent cannot be written),
- the stage is renamed to a *journal* inside the folder, and its files change places one after the
  other. That name is the decision: whoever reads or writes through this module next ends what was begun.
A lock (flock on the folder) keeps writers and readers apart, through all processes of a machine.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import fcntl
import json
import os
import shutil
import stat
import time
import uuid
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path

from ..engine import InputError
from .files import Data, begin, end, interruptible, remove_tree, uninterrupted, write_new, written
from .files import PART as STAGE

Contents = Mapping[str, Data]  # by file name

JOURNAL = ".beltgrind-ready-"  # whole, and decided: to be ended
MANIFEST = ".manifest.json"
WAIT = 60.0  # s for another process that writes
LEFT_OVER = 60.0  # s; a stage of that age whose owner does not hold it is a killed one's
NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL)  # of a file system
RENAME_EXCHANGE, AT_FDCWD = 2, -100


def replace(
    folder: Path, contents: Contents, look: Callable[[Path], Collection[str] | None] | None = None
) -> None:
    """Writes ``contents`` (by file name, as ``files.write_to`` takes them; perhaps twice, one after the other) into
    ``folder``, all of it or nothing. The folder is made where it is not; its other files stay. ``look(folder)`` is called under the lock, after what another
    had begun is ended; it may raise, or return the names of files to be removed. Ctrl-C comes before the
    change or after it. Raises OSError, InputError.
    """
    folder = Path(os.path.realpath(folder))
    with interruptible():
        _replace(folder, contents, look)


def _replace(
    folder: Path, contents: Contents, look: Callable[[Path], Collection[str] | None] | None
) -> None:
    made = _make(folder)
    try:
        with _locked(folder, fcntl.LOCK_EX):
            _end_journals(folder)
            gone = (look(folder) or ()) if look is not None else ()
            for name in (*contents, *gone):
                if (folder / name).is_dir():
                    raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), folder / name)
            if not _replace_by_exchange(folder, contents, gone):
                _replace_by_journal(folder, contents, gone)
    except BaseException:
        for path in made:
            with contextlib.suppress(OSError):
                path.rmdir()  # which fails where anything is in it
        raise


@contextlib.contextmanager
def reading(folder: Path) -> Iterator[None]:
    """While it lasts nobody replaces the folder's files through this module. Raises OSError, InputError."""
    folder = Path(os.path.realpath(folder))
    if any(_named(folder, JOURNAL)):
        with _locked(folder, fcntl.LOCK_EX):
            _end_journals(folder)
    with _locked(folder, fcntl.LOCK_SH):
        yield


def _make(folder: Path) -> list[Path]:
    """The folders that were made, the innermost first."""
    made, path = [], folder
    while not path.exists() and path != path.parent:
        made.append(path)
        path = path.parent
    folder.mkdir(parents=True, exist_ok=True)
    return made


@contextlib.contextmanager
def _locked(folder: Path, kind: int) -> Iterator[None]:
    """Holds the folder, the one that has the name now: it may have changed places while we waited."""
    end = time.monotonic() + WAIT
    while True:
        held = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            _lock(held, kind, folder, end)
            if os.path.samestat(os.fstat(held), os.stat(folder)):
                yield
                return
        finally:
            os.close(held)


def _lock(held: int, kind: int, folder: Path, end: float) -> None:
    while True:
        try:
            fcntl.flock(held, kind | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            if time.monotonic() > end:
                raise InputError(
                    "files.folder_in_use",
                    "{file}: another program is writing there; try again when it has ended",
                    file=folder,
                ) from None
            time.sleep(0.01)
        except OSError as error:
            if error.errno not in NO_LOCKS:
                raise
            return  # better without than not at all: what is written is whole all the same


def _replace_by_exchange(folder: Path, contents: Contents, gone: Collection[str]) -> bool:
    """False where it cannot be done; everything is then as it was."""
    if not _may_change_places(folder):
        return False
    parent = folder.parent
    try:
        _remove_stages(parent)
        with _stage(parent) as stage:
            about = folder.stat()
            os.chmod(stage, stat.S_IMODE(about.st_mode))
            if (stage.stat().st_uid, stage.stat().st_gid) != (about.st_uid, about.st_gid):
                os.chown(stage, about.st_uid, about.st_gid)
            taken = set(contents) | set(gone)
            for entry in os.scandir(folder):
                if entry.name not in taken and not entry.name.startswith(STAGE):
                    os.link(entry.path, stage / entry.name, follow_symlinks=False)
            _write_all(stage, contents)
            with uninterrupted():
                _exchange(stage, folder)
                written(folder)
                _keep_later(stage, folder, taken)  # the stage is now what the folder was
                remove_tree(stage)
                _sync_folder(parent)
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG):
            raise
        return False
    return True


def _may_change_places(folder: Path) -> bool:
    try:
        if os.path.ismount(folder) or not os.access(folder.parent, os.W_OK | os.X_OK):
            return False
        if any(entry.is_dir(follow_symlinks=False) for entry in os.scandir(folder)):
            return False
        if os.listxattr(folder):
            return False
    except OSError:
        return False
    return not _is_working_folder(folder)


def _is_working_folder(folder: Path) -> bool:
    """Whether a process that we may look at works in it: it would find itself in a folder that is gone."""
    about = folder.stat()
    for process in os.scandir("/proc") if os.path.isdir("/proc/self") else ():
        if process.name.isdigit():
            with contextlib.suppress(OSError):
                if os.path.samestat(os.stat(f"/proc/{process.name}/cwd"), about):
                    return True
    return False


def _keep_later(old: Path, folder: Path, taken: Collection[str]) -> None:
    """What somebody put into the old folder after it was looked through is not thrown away."""
    for entry in os.scandir(old):
        place = folder / entry.name
        if entry.name not in taken and not os.path.lexists(place):
            os.rename(entry.path, place)


def _replace_by_journal(folder: Path, contents: Contents, gone: Collection[str]) -> None:
    _remove_stages(folder)
    manifest = json.dumps({"files": list(contents), "gone": list(gone)}, allow_nan=False).encode()
    with _stage(folder) as stage:
        _write_all(stage, {**contents, MANIFEST: manifest})
        with uninterrupted():
            os.rename(stage, folder / (JOURNAL + uuid.uuid4().hex))
            written(folder)
            _sync_folder(folder)
            _end_journals(folder)


def _end_journals(folder: Path) -> None:
    for journal in _named(folder, JOURNAL):
        try:
            manifest = _manifest(journal / MANIFEST)
        except FileNotFoundError:
            manifest = {"files": [], "gone": []}  # it was being removed
        for name in manifest["files"]:
            with contextlib.suppress(FileNotFoundError):  # it has changed its place
                os.replace(journal / name, folder / name)
        for name in manifest["gone"]:
            (folder / name).unlink(missing_ok=True)
        _sync_folder(folder)
        with uninterrupted():
            shutil.rmtree(journal)  # to be told of: else it would be ended a second time


def _manifest(path: Path) -> dict[str, list[str]]:
    """{"files", "gone"}: names. Raises FileNotFoundError, and InputError for what is damaged."""
    try:
        found: dict[str, list[str]] = json.loads(path.read_bytes())
        lists = [found[name] for name in ("files", "gone")]
        sound = all(type(one) is list for one in lists) and all(
            isinstance(name, str) and name == Path(name).name for one in lists for name in one
        )
    except (ValueError, KeyError, TypeError, RecursionError):
        sound = False
    if not sound:
        raise InputError(
            "base.journal",
            "{file}: the result was being replaced, and what is left of that is damaged; remove {folder} and run the "
            "job again",
            file=path,
            folder=path.parent,
        )
    return found


@contextlib.contextmanager
def _stage(parent: Path) -> Iterator[Path]:
    """A new folder that is held as long as it is made; what is left of it in the end goes."""
    path = parent / (STAGE + uuid.uuid4().hex)
    begin(path)
    try:
        path.mkdir()
        held = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
        try:
            with contextlib.suppress(OSError):
                fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            yield path
        finally:
            os.close(held)
    finally:
        remove_tree(path)
        end(path)


def _remove_stages(parent: Path) -> None:
    """What killed writers could not tidy up themselves."""
    for stage in _named(parent, STAGE):
        with contextlib.suppress(OSError):
            held = os.open(stage, os.O_RDONLY | os.O_DIRECTORY)
            try:
                fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if time.time() - os.fstat(held).st_mtime > LEFT_OVER:
                    remove_tree(stage)
            finally:
                os.close(held)


def _named(folder: Path, prefix: str) -> list[Path]:
    try:
        return sorted(folder / e.name for e in os.scandir(folder) if e.name.startswith(prefix))
    except FileNotFoundError:
        return []


def _write_all(folder: Path, contents: Contents) -> None:
    for name, data in contents.items():
        write_new(folder / name, data)
    _sync_folder(folder)


def _exchange(one: Path, other: Path) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    call = getattr(libc, "renameat2", None)
    if call is None:
        raise OSError(errno.ENOSYS, "no renameat2")
    if call(AT_FDCWD, os.fsencode(one), AT_FDCWD, os.fsencode(other), RENAME_EXCHANGE) != 0:
        error = ctypes.get_errno()
        raise OSError(error, os.strerror(error))


def _sync_folder(folder: Path) -> None:
    """Its names, onto the disk. Some file systems know no such thing."""
    with contextlib.suppress(OSError):
        held = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(held)
        finally:
            os.close(held)
