"""What was prepared before, kept for the next that needs the same.

A stage (a part that was read, faces that were sampled, stock that was measured by rays) is known by the digest of
all that it is made from: of files by what they hold, not by their names and times. Where that is the same, the
kept value is what making it again would give.
"""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import json
import os
import threading
import weakref
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")

SHARE = 0.125  # of the machine's memory
MOST = 2e9  # bytes, all together
LARGEST = (
    0.25  # of all, one value: a field of ten million samples is made again rather than held twice
)
LIMIT = "BELTGRINDING_KEPT_LIMIT_MB"  # of the environment; 0: nothing is kept


def digest(*parts: object) -> str:
    """SHA-256, hex digits, of plain data with bytes, arrays and dataclasses in it. Raises TypeError for anything else."""
    text = json.dumps(parts, sort_keys=True, separators=(",", ":"), default=_special)
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _special(value: object) -> Any:
    if isinstance(value, np.ndarray):
        held = hashlib.sha256(np.ascontiguousarray(value).data).hexdigest()
        return {"array": [str(value.dtype), list(value.shape), held]}
    if isinstance(value, bytes):
        return {"bytes": hashlib.sha256(value).hexdigest()}
    if dataclasses.is_dataclass(value):
        return {one.name: getattr(value, one.name) for one in dataclasses.fields(value)}
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (os.PathLike, range)):
        return [type(value).__name__, str(value)]
    raise TypeError(f"no digest of a {type(value).__name__}")


class Kept:
    """Values by stage and digest, the least recently used of which go when all hold more than ``most`` bytes. May
    be used by several threads. What is kept is handed out to all who ask, and must not be changed, unless as a copy.
    """

    def __init__(self, most: float | None = None) -> None:
        self.most = _most() if most is None else most
        self.bytes = 0.0
        self.hits: dict[str, int] = {}  # by stage
        self.made: dict[str, int] = {}
        self._values: OrderedDict[tuple[str, str], tuple[Any, float]] = OrderedDict()  # and bytes
        self._lock = threading.Lock()

    def get(
        self,
        stage: str,
        parts: Callable[[], Any],
        make: Callable[[], T],
        size: Callable[[T], float],
        copy: Callable[[T], T] = lambda value: value,
    ) -> T:
        """The value of ``stage`` for ``parts()``, all that it is made from as ``digest`` takes it; by ``make()`` where
        it is not kept. ``size(value)``: bytes; ``copy(value)``: of one that is kept, for who changes what is handed
        out. What ``make`` raises is not kept, nor what was made while ``parts()`` changed, as when a file is written
        to, nor what would take more than ``LARGEST`` of all.
        """
        key = stage, digest(parts())
        with self._lock:
            found = self._values.get(key)
            if found is not None:
                self._values.move_to_end(key)
                self.hits[stage] = self.hits.get(stage, 0) + 1
        if found is not None:
            return copy(found[0])
        value = make()
        taken = int(size(value))
        with self._lock:
            self.made[stage] = self.made.get(stage, 0) + 1
        if taken <= LARGEST * self.most and key == (stage, digest(parts())):
            self._put(key, value, taken)
            return copy(value)
        return value

    def find(self, stage: str, digest: str) -> Any:
        """What ``put`` kept; None where there is nothing."""
        with self._lock:
            found = self._values.get((stage, digest))
            if found is None:
                return None
            self._values.move_to_end((stage, digest))
            return found[0]

    def put(self, stage: str, digest: str, value: Any, size: float, reused: bool) -> None:
        """Keeps a value of ``size`` bytes that is no stage as a whole, in place of the one before, unless it would take
        more than ``LARGEST`` of all. ``reused``: some of it was taken from that; counts as a hit.
        """
        counted = self.hits if reused else self.made
        with self._lock:
            counted[stage] = counted.get(stage, 0) + 1
        if size <= LARGEST * self.most:
            self._put((stage, digest), value, size)

    def _put(self, key: tuple[str, str], value: Any, taken: float) -> None:
        with self._lock:
            before = self._values.pop(key, None)
            self.bytes += taken - (before[1] if before else 0)
            self._values[key] = value, taken
            while self.bytes > self.most:
                _, (_, freed) = self._values.popitem(last=False)
                self.bytes -= freed

    def forget(self) -> None:
        """Frees all."""
        with self._lock:
            self._values.clear()
            self.bytes = 0


def _most() -> float:
    """Bytes that the environment, or else the machine, allows."""
    given = os.environ.get(LIMIT, "")
    try:
        return max(0.0, float(given)) * 1e6
    except ValueError:
        pass
    try:
        memory: float = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError, AttributeError):
        memory = MOST
    return min(MOST, SHARE * memory)


_stages = Kept()  # of this process
_names: weakref.WeakKeyDictionary[
    Any, str
] = weakref.WeakKeyDictionary()  # digests of what objects were made from


def get(
    stage: str,
    parts: Callable[[], Any],
    make: Callable[[], T],
    size: Callable[[T], float],
    copy: Callable[[T], T] = lambda value: value,
) -> T:
    """As ``Kept.get``, of this process."""
    return _stages.get(stage, parts, make, size, copy)


def find(stage: str, digest: str) -> Any:
    """As ``Kept.find``, of this process."""
    return _stages.find(stage, digest)


def put(stage: str, digest: str, value: Any, size: float, reused: bool) -> None:
    """As ``Kept.put``, of this process."""
    _stages.put(stage, digest, value, size, reused)


def largest() -> float:
    """Bytes that one value of this process may take."""
    return LARGEST * _stages.most


def forget() -> None:
    """Frees all that this process keeps."""
    _stages.forget()


@contextlib.contextmanager
def instead(stages: Kept) -> Iterator[Kept]:
    """Has this process keep its stages in another ``Kept`` meanwhile."""
    global _stages
    before, _stages = _stages, stages
    try:
        yield stages
    finally:
        _stages = before


def named(value: T, *parts: object) -> T:
    """``value``, which never changes, known from now on by the digest of what it was made from."""
    _names[value] = digest(*parts)
    return value


def name(value: Any) -> str | None:
    """The digest of what a value was made from; None where nobody has told."""
    return _names.get(value)
