"""A Dask scheduler that somebody has started, and how it is reached: by TLS, with a key that nobody else has.

Whoever reaches a scheduler's port has its workers, and whoever asks it, run programs. So both sides show a certificate; one file with
a key and its certificate serves both, and those who may read it are those who may run programs.
"""

from __future__ import annotations

import os
import ssl
import stat
from pathlib import Path
from typing import Any, Literal, TypeAlias

from ..base.files import cannot_be_read
from ..engine import InputError

ANSWER_S = 10.0  # for a scheduler to answer
TLS = "tls://"

Tls: TypeAlias = "str | Literal[False] | None"  # as ``There`` takes it


def distributed() -> Any:
    """The package. Raises InputError where it is missing."""
    try:
        import distributed as package
    except ImportError as error:
        raise InputError(
            "studies.no_distributed",
            "the workers of a scheduler need Dask (Debian: python3-distributed): {reason}; without it: processes of this "
            "machine, by --workers",
            reason=error,
        ) from None
    return package


class There:
    """A scheduler that the user has started, at an ``address`` such as tls://10.0.0.1:8786.

    ``tls``: the path of a PEM file with a key and its certificate, which the scheduler and its workers have, too; None: the one
    of Dask's own configuration; False: none, as is asked for by whoever knows that everybody who reaches the scheduler can
    run programs. Raises InputError where there is no key, or others may read it."""

    def __init__(self, address: str, tls: Tls | None = None) -> None:
        self.address = address
        if tls is False:
            self._security: dict[str, Any] = {}
            return
        if not str(address).startswith(TLS):
            raise InputError(
                "studies.no_tls",
                "the scheduler {address} is asked for without TLS: whoever reaches its port can run programs as you and as its "
                "workers; start it with a key and give its address as tls://, or give --without-tls",
                address=address,
            )
        if tls is None:
            self._security = {"require_encryption": True}
            self._check_configured()
        else:
            path = os.path.abspath(tls)
            check_key(path)
            names = ("tls_ca_file", "tls_client_cert", "tls_client_key")
            self._security = {**dict.fromkeys(names, path), "require_encryption": True}

    def _check_configured(self) -> None:
        key = distributed().Security().tls_client_key
        if key is None:
            raise InputError(
                "studies.no_tls_key",
                "the scheduler {address} wants a key: give the file of it by --tls FILE",
                address=self.address,
            )
        if "\n" not in key:  # else it is the key itself
            check_mode(key)

    def client(self) -> Any:
        """A client. Raises OSError, ValueError, TimeoutError where none answers."""
        package = distributed()

        # Dask has no types.
        class Client(package.Client):  # type: ignore[misc, name-defined]
            def start(self, **options: Any) -> None:
                try:
                    super().start(**options)
                except BaseException:
                    # Dask leaves its thread running, or closes it when the program ends: then it waits in vain.
                    self.status = "connecting"
                    self.close(timeout=ANSWER_S)
                    raise

        security = package.Security(**self._security)
        return Client(self.address, timeout=ANSWER_S, set_as_default=False, security=security)


def check_mode(path: Path | str) -> None:
    """Raises InputError for a file that is not there, or that others than its owner may read or write."""
    try:
        state = os.stat(path)
    except OSError as error:
        raise cannot_be_read(path, error) from None
    if not stat.S_ISREG(state.st_mode) or state.st_mode & 0o077 or state.st_uid != os.geteuid():
        raise InputError(
            "studies.key_of_others",
            "{file}: is a key that others may read or change; make it a file of your own, and chmod 600 it",
            file=path,
        )


def check_key(path: Path | str) -> None:
    """Raises InputError for a file that is no key with its certificate, or not the user's alone."""
    check_mode(path)
    try:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.load_cert_chain(path, password="")
        context.load_verify_locations(path)
    except ssl.SSLError as error:
        raise InputError(
            "studies.no_pem",
            "{file}: is no PEM file with a key (without a password) and its certificate: {reason}",
            file=path,
            reason=str(error),
        ) from None
    except OSError as error:
        raise cannot_be_read(path, error) from None
