"""The team's shared key and its file: 64 hexadecimal digits that only the file's owner may read."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from muster.mission.errors import Finding, InputError

KEY_BYTES = 32

_FORM = f"{2 * KEY_BYTES} hexadecimal digits"


def new_key() -> bytes:
    """A random key."""
    return secrets.token_bytes(KEY_BYTES)


def write_key(path: str | Path, key: bytes) -> None:
    """Write a key to a new file that only its owner can read.

    Raises
    ------
    InputError
        if the file exists, or cannot be made.
    """
    try:
        file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise _error(path, "it exists", "the name of a new file: keys are not overwritten") from None
    except OSError as error:
        raise _error(path, str(error.strerror), "a file that can be made") from None
    with os.fdopen(file, "w", encoding="ascii") as out:
        out.write(key.hex() + "\n")


def read_key(path: str | Path) -> bytes:
    """The key of a file.

    A file that others may read is refused: the key may have leaked and must be replaced.

    Raises
    ------
    InputError
        if the file cannot be read, others may read it, or it holds no key.
    """
    try:
        with Path(path).open("rb") as file:
            mode = os.fstat(file.fileno()).st_mode & 0o777
            text = file.read(4 * KEY_BYTES).strip()
    except OSError as error:
        raise _error(path, str(error.strerror), f"a key file: {_FORM}") from None
    if mode & 0o077:
        raise _error(path, f"mode {mode:04o}, others than its owner may use it", "mode 0600, and a key nobody has read")
    try:
        key = bytes.fromhex(text.decode("ascii"))
    except ValueError:
        raise _error(path, "other characters", _FORM) from None
    if len(key) != KEY_BYTES:
        raise _error(path, f"{2 * len(key)} digits", _FORM)
    return key


def _error(path: str | Path, value: str, expected: str) -> InputError:
    return InputError([Finding(str(path), None, "key", value, expected)])
