"""Meshes of the 3D view, made as small as a page can carry: thinned, quantised, packed."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base.kinds import Array
from ..engine import core

STEPS = 65534  # of a quantised value
MISSING = 65535  # its code where there is none
SHARP = np.cos(np.radians(25.0))  # of the turn at an edge from which it is drawn
LEVEL = 7  # of 9: a third of the time of 9 for a twentieth more bytes
KINDS = {"u1": np.uint8, "u2": np.uint16, "u4": np.uint32}


class Packed:
    """Arrays of unsigned integers one after the other, as Resources/report/view_data.js reads them.

    Every column is coded as differences from row to row, zigzag (0, -1, 1, -2 ... as 0, 1, 2, 3), all
    lowest bytes first, then all second ones, and so on. ``index``: name -> [kind, rows, columns, first byte].
    """

    def __init__(self) -> None:
        self.index: dict[str, Any] = {}
        self.parts: list[bytes] = []
        self.length = 0

    def add(self, name: str, values: Array, kind: str) -> None:
        """Takes up ``values`` (n,) or (n, columns) under a ``name``; ``kind``: a key of KINDS."""
        values = np.asarray(values)
        rows, columns = values.shape[0], 1 if values.ndim == 1 else values.shape[1]
        values = values.reshape(rows, columns).astype(KINDS[kind])
        self.index[name] = [kind, rows, columns, self.length]
        for column in values.T:
            data = _differences(column)
            self.parts.append(data)
            self.length += len(data)

    def text(self) -> str:
        """All of it, compressed (zlib), in Base64."""
        return base64.b64encode(zlib.compress(b"".join(self.parts), LEVEL)).decode()


def _differences(column: Array) -> bytes:
    size = column.dtype.itemsize
    signed = np.dtype(f"i{size}")
    step = np.diff(column, prepend=column.dtype.type(0)).view(signed)
    zigzag = ((step << 1) ^ (step >> (8 * size - 1))).astype(f"<u{size}")
    return zigzag.view(np.uint8).reshape(-1, size).T.tobytes()


def quantised(values: Array, known: Array | None = None) -> tuple[Array, float, float]:
    """(codes (n,) uint16, low, high): ``low + (high - low) * code / STEPS`` is a value again, to half a
    step. MISSING where a value is not finite or not ``known`` (n, bool).
    """
    values = np.asarray(values, dtype=float)
    there = np.isfinite(values) if known is None else known & np.isfinite(values)
    codes = np.full(len(values), MISSING, dtype=np.uint16)
    if not there.any():
        return codes, 0.0, 0.0
    low, high = float(values[there].min()), float(values[there].max())
    scale = STEPS / (high - low) if high > low else 0.0
    codes[there] = np.round((values[there] - low) * scale).astype(np.uint16)
    return codes, low, high


def in_box(points: Array, low: Array, high: Array) -> Array:
    """(n, 3) uint16 of points (n, 3) between the corners ``low`` and ``high`` (3,), mm."""
    low, size = np.asarray(low, float), np.subtract(high, low)
    scale = np.divide(STEPS, size, out=np.zeros(3), where=size > 0.0)
    return np.clip(np.round((points - low) * scale), 0, STEPS).astype(np.uint16)


def octahedral(normals: Array) -> Array:
    """(n, 2) uint8 of unit vectors (n, 3), to about one degree (Meyer et al. 2010)."""
    n = np.asarray(normals, dtype=float)
    n = n / np.maximum(np.abs(n).sum(axis=1, keepdims=True), 1e-12)
    folded = (1.0 - np.abs(n[:, 1::-1])) * np.where(n[:, :2] >= 0.0, 1.0, -1.0)
    flat = np.where(n[:, 2:] < 0.0, folded, n[:, :2])
    return np.round((flat + 1.0) * 127.0).astype(np.uint8)


def add_triangles(packed: Packed, name: str, triangles: Array) -> None:
    """Packs triangles (m, 3): their first corners, and how far on the others are."""
    t = np.asarray(triangles, dtype=np.uint32).reshape(-1, 3)
    packed.add(name, np.stack([t[:, 0], t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]], axis=1), "u4")


def thinned(
    points: Array,
    normals: Array,
    groups: Array,
    most: int,
    keep: Sequence[int] | Array = (),
) -> tuple[Array, Array]:
    """(chosen (k,), place (n,)): about ``most`` of the samples, each as it is, and which of them stands for
    every one.

    Space is cut into cubes; of the samples in a cube that belong to one of ``groups`` (n,) and face the same
    way, the one nearest to their middle stays, or one of ``keep``.
    """
    count = len(points)
    if count <= most:
        return np.arange(count), np.arange(count)
    return core.thinned(points, normals, groups, most, np.asarray(keep, dtype=np.uint32))


def proper_edges(edges: Array) -> Array:
    """Those edges (k, 2) that have two ends, each once."""
    e = np.sort(np.asarray(edges, dtype=np.int64).reshape(-1, 2), axis=1)
    return _pairs(np.unique(_key(e[e[:, 0] != e[:, 1]])))


def proper_triangles(triangles: Array) -> Array:
    """Those triangles (m, 3) that have three corners, each once."""
    t = np.asarray(triangles, dtype=np.int64)
    t = t[(t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])]
    first = np.argmin(t, axis=1)[:, None]
    t = np.take_along_axis(t, (first + np.arange(3)) % 3, axis=1)
    if t.max(initial=0) >= 1 << 21:
        return np.unique(t, axis=0)
    key = np.unique(t[:, 0] << 42 | t[:, 1] << 21 | t[:, 2])  # three numbers in one sort faster
    return np.stack([key >> 42, key >> 21 & 0x1FFFFF, key & 0x1FFFFF], axis=1)


def borders(triangles: Array) -> Array:
    """(k, 2) edges that only one of the triangles has."""
    edges = _edges(triangles)
    found, counts = np.unique(_key(edges), return_counts=True)
    return _pairs(found[counts == 1])


def creases(points: Array, normals: Array, triangles: Array) -> Array:
    """(k, 2) edges at which a surface turns, or ends. ``normals`` (n, 3): the surface's at the corners, of
    which those of two smooth patches are two, at one place.
    """
    if not len(triangles):
        return np.zeros((0, 2), dtype=np.int64)
    _, same = np.unique(np.round(points, 6), axis=0, return_inverse=True)
    t = same.reshape(-1)[triangles]
    whole = (t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])
    ends, keys = _edges(triangles[whole]), _key(_edges(t[whole]))
    along = normals[ends[:, 0]] + normals[ends[:, 1]]
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    order = np.argsort(keys, kind="stable")
    keys, along, ends = keys[order], along[order], ends[order]
    starts = np.flatnonzero(np.concatenate([[True], np.diff(keys) > 0]))
    counts = np.diff(np.append(starts, len(keys)))
    turned = (along[starts] * along[starts + counts - 1]).sum(axis=1) < SHARP
    return ends[starts[(counts == 1) | turned]]


def _edges(triangles: Array) -> Array:
    t = np.asarray(triangles, dtype=np.int64)
    return np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)


def _key(edges: Array) -> Array:
    return edges[:, 0] << 32 | edges[:, 1]


def _pairs(keys: Array) -> Array:
    return np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1)
