"""Reads and writes files, with errors of one line."""

from __future__ import annotations

from pathlib import Path

from muster.mission.errors import Finding, MissionError
from muster.mission.texts.near_matches import near_file

LARGEST_FILE = 32 * 2**20
"""Bytes of a file of another program, and of all files that are uploaded with one mission."""
_CHUNK = 2**20
_FIRST_BYTES = 8192
_LARGEST_TEXT = 256 * 2**20
"""Bytes of a mission, a plan or a table: a travel table of 5,000 places has as many."""


def read_text(path: Path, most: int = _LARGEST_TEXT) -> str:
    """The text of an input file; what stands in the way is a MissionError, not an OSError."""
    data = bytes_of(path, most)
    try:
        return data.decode("utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        line = 1 + data.count(b"\n", 0, error.start)
        raise MissionError(
            [Finding(str(path), line, "", f"byte {error.start} is not UTF-8", "a text in UTF-8")]
        ) from None


def first_lines(path: Path) -> str:
    """Return the text at the beginning of a file; nothing of a file that cannot be read, which its reader refuses."""
    try:
        with path.open("rb") as file:
            return file.read(_FIRST_BYTES).decode("utf-8-sig", errors="replace")
    except OSError:
        return ""


def bytes_of(path: Path, most: int = LARGEST_FILE) -> bytes:
    """The bytes of an input file of bounded size; what stands in the way is a MissionError."""
    try:
        with path.open("rb") as file:
            data = bytearray()
            while len(data) <= most and (chunk := file.read(_CHUNK)):  # asked for all at once, room for all is taken
                data += chunk
        if len(data) <= most:
            return bytes(data)
        limit = f"{most // 2**20} MiB"
        raise MissionError([Finding(str(path), None, "", f"more than {limit}", f"at most {limit}")])
    except OSError as error:
        near = near_file(path) if isinstance(error, FileNotFoundError) else ""
        expected = f"a file to read{near}"
        raise MissionError([Finding(str(path), None, "", error.strerror or str(error), expected)]) from None
    except ValueError as error:
        raise MissionError([Finding(str(path), None, "", str(error), "a file to read")]) from None


def write_text(path: Path, text: str) -> None:
    """Write a file in UTF-8; an error names it."""
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file; an error names it."""
    try:
        path.write_bytes(content)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None
