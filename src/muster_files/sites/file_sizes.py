"""The limits of files that are imported: nothing that unpacks or grows may fill the memory.

All readers have their limits from here, in the command, in Python and on a server. A file within all of them is read
in less than 1.5 GB.
"""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path

from muster.mission.texts.text_files import bytes_of
from muster_files.sites.features import refused

MOST_BYTES = 64 * 2**20
"""Of what an archive unpacks to, and of the values that a database gives."""
MOST_MEMBERS = 1_000
"""Of an archive."""
MOST_RATIO = 200
"""Unpacked to packed bytes of an archive that unpacks to more than `_SMALL`; workbooks of numbers have up to 50."""
MOST_ROWS = 1_000_000
MOST_COLUMNS = 16_384
"""As many as spreadsheet programs have."""
MOST_CELLS = 10_000_000
"""Between the first and the last cell of a table, empty ones included."""
MOST_ELEMENTS = 1_000_000
"""Elements and attributes of XML, or objects of JSON."""
MOST_VALUES = 4_000_000
"""Numbers and other values in lists: twice or thrice as many as places."""
DEEPEST_XML = 100
_SMALL = 4 * 2**20
_MIB = 2**20
_BROKEN = (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError, UnicodeDecodeError)
"""What `zipfile` raises for archives that are broken, encrypted, or packed in ways that it does not know."""


def read_bytes(path: Path) -> bytes:
    """The bytes of a file; what stands in the way is a MissionError."""
    data = bytes_of(path)
    if not data:
        raise refused(str(path), None, "", "empty", "a file with tasks, robots, areas or lines")
    return data


def require_few(count: int, what: str, file: str, line: int | None = None, most: int = MOST_ELEMENTS) -> None:
    """Raise MissionError if a file has more than `most` of something."""
    if count > most:
        raise refused(file, line, "", f"more than {most:,} {what}", f"at most {most:,} {what}; or several files")


def require_moderate_json(text: str, file: str) -> None:
    """Raise MissionError if a text of JSON has too many objects or values, before it is parsed."""
    require_few(text.count("{"), "objects", file)
    require_few(text.count(",") + text.count("["), "values", file, most=MOST_VALUES)


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
    try:
        _require_moderate(archive.infolist(), path)
    except BaseException:
        archive.close()
        raise
    return archive


def _require_moderate(members: list[zipfile.ZipInfo], path: Path) -> None:
    file = str(path)
    require_few(len(members), "files in the archive", file, most=MOST_MEMBERS)
    size, packed = sum(m.file_size for m in members), sum(m.compress_size for m in members)
    if size > MOST_BYTES:
        raise refused(file, None, "", f"{size / _MIB:.0f} MiB unpacked", f"at most {MOST_BYTES // _MIB} MiB")
    if size > max(_SMALL, MOST_RATIO * packed):
        told = f"{size / _MIB:.0f} MiB unpacked, packed to {packed / 2**10:.0f} KiB"
        raise refused(file, None, "", told, f"at most {MOST_RATIO} times as much as it is packed to")


def unpacked(archive: zipfile.ZipFile, name: str, path: Path, what: str) -> bytes:
    """A member of an archive; no more is unpacked than its directory says, whatever is packed."""
    try:
        with archive.open(name) as member:
            data = member.read(MOST_BYTES + 1)
    except (*_BROKEN, OSError, ValueError) as error:
        raise refused(str(path), None, name, f"cannot be unpacked ({error})", what) from None
    if len(data) > MOST_BYTES:
        expected = f"at most {MOST_BYTES // _MIB} MiB"
        raise refused(str(path), None, name, f"more than {MOST_BYTES // _MIB} MiB unpacked", expected)
    return data
