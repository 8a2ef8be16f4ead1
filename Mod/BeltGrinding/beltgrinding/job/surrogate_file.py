"""The files of surrogates of the contact and of their databases, numpy archives both; a surrogate as the engine takes it."""

from __future__ import annotations

import hashlib
import io
import json
import math
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Array, Floats, Json
from ..base.regular_files import read_regular
from ..engine import InputError

LEAST_CONTACTS = 20
LARGEST = 4 << 30  # bytes, unpacked
WHEEL = (  # what a surrogate holds for: keys of a contact's wheel
    "outer_radius_mm",
    "width_mm",
    "crown_radius_mm",
    "rim_thickness_mm",
    "youngs_modulus_MPa",
    "poissons_ratio",
    "belt_tension_N_per_mm",
    "belt_bending_N_mm",
)

DATABASE = {"gap": 3, "coverage": 3, "pressure": 3, "approach": 1, "force": 1, "ds": 0}
REGRESSION = ("vectors", "coefficients", "mean", "deviation", "rho", "gamma", "scale")


@dataclass(frozen=True, kw_only=True)
class Surrogate:
    """A trained surrogate, as core takes it in place of a compliance."""

    model: Literal["surrogate"] = "surrogate"
    name: str
    cell: float  # mm
    rim_thickness: float  # mm
    regression: dict[str, Any]  # as core.train_regression gives it


def arguments(path: Path | str, wheel: Json) -> Surrogate:
    """The Surrogate of a file. ``wheel``: the one that it is asked
    for, keys of ``WHEEL``. Raises InputError if it was trained for another.
    """
    surrogate, digest = load(path)
    if wheel["profile_mm"]:
        raise InputError(
            "job.surrogate_profile",
            "{file}: a surrogate knows no profiled wheels; choose another model",
            file=path,
        )
    for key in WHEEL:
        trained, asked = surrogate["wheel"][key], float(wheel[key])
        if not np.isclose(trained, asked, rtol=1e-6, atol=1e-9):
            raise InputError(
                "job.surrogate_of_other_wheel",
                "{file}: this surrogate was trained for a wheel with {key} = {trained:g}, not "
                "{asked:g}; train another one (beltgrind surrogate)",
                file=path,
                key=key,
                trained=trained,
                asked=asked,
            )
    error = _number(surrogate["report"].get("held_out_L1_mean"))
    name = (
        f"surrogate: support-vector regression, {len(surrogate['coefficients'])} vectors, "
        f"held-out error {100 * error:.1f} % (L1), file {digest[:16]}"
    )
    return core_arguments(surrogate, name)


def core_arguments(surrogate: Json, name: str) -> Surrogate:
    """The Surrogate of what ``load`` gives, by the name that results have."""
    return Surrogate(
        name=name,
        cell=float(surrogate["cell"]),
        rim_thickness=surrogate["wheel"]["rim_thickness_mm"],
        regression={key: surrogate[key] for key in REGRESSION},
    )


def save(surrogate: Json, path: Path | str) -> None:
    """Writes a surrogate. Raises InputError."""
    arrays = {key: np.asarray(surrogate[key]) for key in (*REGRESSION, "cell")}
    _write(path, arrays, {"wheel": surrogate["wheel"], "report": surrogate["report"]})


def load(path: Path | str) -> tuple[dict[str, Any], str]:
    """(surrogate, SHA-256 of its file). Raises InputError."""
    content, arrays, about = _read(path, (*REGRESSION, "cell"))
    numbers = {}
    _check_wheel(path, about)
    for key in ("rho", "gamma", "scale", "cell"):
        if arrays[key].ndim != 0:
            raise InputError(
                "job.archive_no_number", "{file}: '{key}' is no single number", file=path, key=key
            )
        numbers[key] = float(arrays[key])
    report = about.get("report")
    surrogate = {
        **arrays,
        **numbers,
        "wheel": about["wheel"],
        "report": report if isinstance(report, dict) else {},
    }
    return surrogate, hashlib.sha256(content).hexdigest()


def save_database(database: Json, path: Path | str) -> None:
    """Writes a database. Raises InputError."""
    about = {key: database[key] for key in ("wheel", "source", "seconds")}
    _write(path, {key: np.asarray(database[key]) for key in DATABASE}, about)


def load_database(path: Path | str) -> dict[str, Any]:
    """A database from its file. Raises InputError naming what is missing or does not fit."""
    _, arrays, about = _read(path, DATABASE)
    _check_wheel(path, about)
    shape = arrays["gap"].shape
    for key, dimensions in DATABASE.items():
        if (
            arrays[key].ndim != dimensions
            or arrays[key].shape != shape[: 3 if dimensions == 3 else dimensions]
        ):
            raise InputError(
                "job.archive_shape",
                "{file}: '{key}' has the shape {shape}",
                file=path,
                key=key,
                shape=arrays[key].shape,
            )
        if key != "gap" and not np.isfinite(arrays[key]).all():
            raise InputError(
                "job.archive_not_finite",
                "{file}: '{key}' holds a value that is not finite",
                file=path,
                key=key,
            )
    if len(arrays["force"]) < LEAST_CONTACTS:
        raise InputError(
            "job.database_too_small",
            "{file}: a database needs at least {least} contacts",
            file=path,
            least=LEAST_CONTACTS,
        )
    return {
        **arrays,
        "wheel": about["wheel"],
        "source": str(about.get("source", "its own")),
        "seconds": _number(about.get("seconds", 0.0)),
    }


def _number(value: Any) -> float:
    """A number for a person to read; NaN where the file has none."""
    return float(value) if isinstance(value, (int, float)) else math.nan


def _check_wheel(path: Path | str, about: Json) -> None:
    wheel = about.get("wheel")
    if not isinstance(wheel, dict) or not all(
        isinstance(wheel.get(key), (int, float)) for key in WHEEL
    ):
        raise InputError(
            "job.archive_no_wheel",
            "{file}: 'about' does not say the wheel: {keys}",
            file=path,
            keys=", ".join(WHEEL),
        )


def _write(path: Path | str, arrays: Mapping[str, Array], about: Json) -> None:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, about=np.array(json.dumps(about, allow_nan=False)), **arrays)
    try:
        write_whole(Path(path), buffer.getvalue())
    except OSError as error:
        raise cannot_be_written(path, error) from None


def _read(
    path: Path | str, names: Iterable[str]
) -> tuple[bytes, dict[str, Floats], dict[str, Any]]:
    """(bytes, arrays by name, about) of an archive."""
    content = read_regular(path, LARGEST)
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as packed:
            if sum(one.file_size for one in packed.infolist()) > LARGEST:
                raise InputError(
                    "job.archive_too_large", "{file}: holds too much for a surrogate", file=path
                )
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:
            arrays = {name: np.array(archive[name]) for name in names}
            about = json.loads(str(archive["about"]))
    except InputError:  # which is a ValueError
        raise
    except KeyError as error:
        raise InputError(
            "job.archive_lacks", "{file}: {reason}", file=path, reason=error.args[0]
        ) from None
    except (ValueError, zipfile.BadZipFile, EOFError, AttributeError, NotImplementedError):
        raise InputError(
            "job.no_archive",
            "{file}: this is no archive of a surrogate or of its database",
            file=path,
        ) from None
    if not all(array.dtype.kind in "fiu" for array in arrays.values()) or not isinstance(
        about, dict
    ):
        raise InputError(
            "job.no_archive",
            "{file}: this is no archive of a surrogate or of its database",
            file=path,
        )
    return content, {name: array.astype(float) for name, array in arrays.items()}, about
