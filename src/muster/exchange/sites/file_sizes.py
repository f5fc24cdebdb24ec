"""Files of bounded size: a file, and what unpacks from an archive, may not fill the memory."""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path

from muster.exchange.sites.features import refused

MOST_BYTES = 256 * 2**20
_EXPECTED = f"at most {MOST_BYTES // 2**20} MiB"
_BROKEN = (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError, UnicodeDecodeError)
"""What `zipfile` raises for archives that are broken, encrypted, or packed in ways that it does not know."""


def read_bytes(path: Path) -> bytes:
    """The bytes of a file; what stands in the way is a MissionError."""
    try:
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise refused(str(path), None, "", f"{size / 2**20:.0f} MiB", _EXPECTED)
        data = path.read_bytes()
    except OSError as error:
        raise refused(str(path), None, "", error.strerror or str(error), "a file to read") from None
    if not data:
        raise refused(str(path), None, "", "empty", "a file with tasks, robots, areas or lines")
    return data


def open_archive(path: Path, what: str) -> zipfile.ZipFile:
    """A ZIP archive whose content, unpacked, is not too large.

    Raises
    ------
    MissionError
        if it is none, or too large; `what` says what was expected.
    """
    read_bytes(path)
    try:
        archive = zipfile.ZipFile(path)
    except (*_BROKEN, OSError, ValueError) as error:
        raise refused(str(path), None, "", f"no ZIP archive ({error})", what) from None
    unpacked = sum(member.file_size for member in archive.infolist())
    if unpacked > MOST_BYTES:
        archive.close()
        raise refused(str(path), None, "", f"{unpacked / 2**20:.0f} MiB unpacked", _EXPECTED)
    return archive


def unpacked(archive: zipfile.ZipFile, name: str, path: Path, what: str) -> bytes:
    """A member of an archive; no more is unpacked than its directory says, whatever is packed."""
    try:
        with archive.open(name) as member:
            data = member.read(MOST_BYTES + 1)
    except (*_BROKEN, OSError, ValueError) as error:
        raise refused(str(path), None, name, f"cannot be unpacked ({error})", what) from None
    if len(data) > MOST_BYTES:
        raise refused(str(path), None, name, f"more than {MOST_BYTES // 2**20} MiB unpacked", _EXPECTED)
    return data
