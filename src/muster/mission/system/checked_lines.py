"""Lines of journals with checksums: a line that a crash has cut short, or a disk has damaged, is noticed."""

from __future__ import annotations

from zlib import crc32


def checked_line(text: bytes) -> bytes:
    """Return a text without line ends as a line: its CRC 32 in hexadecimal digits, a space, the text, a line end."""
    return b"%08x %s\n" % (crc32(text), text)


def text_of(line: bytes) -> bytes | None:
    """Return the text of a line without its line end; None if the line is damaged."""
    checksum, _, text = line.partition(b" ")
    return text if checksum == b"%08x" % crc32(text) else None
