"""Merges concurrent edits: an editor in the browser changes a text while another text is sent to it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, repeat

_UTF_16 = ("utf-16-le", "surrogatepass")  # in which the editor counts


def applied(text: str, sections: Sequence[int], inserted: Sequence[Sequence[str]]) -> str | None:
    """A text with a change set of CodeMirror, or None where that is of a text of another length.

    `sections` are pairs of an old and a new length, the latter -1 where nothing changes; `inserted` are new lines.
    """
    units = text.encode(*_UTF_16)
    if 2 * sum(sections[::2]) != len(units):
        return None
    pieces, at = [], 0
    for old, new, lines in zip(sections[::2], sections[1::2], chain(inserted, repeat(())), strict=False):
        pieces.append(units[2 * at : 2 * (at + old)] if new < 0 else "\n".join(lines).encode(*_UTF_16))
        at += old
    return b"".join(pieces).decode(*_UTF_16)


def merged(before: str, here: str, there: str) -> str | None:
    """The merge of two changes of a text; None if both changed the same place."""
    (start, end, new), (start_there, end_there, new_there) = _change(before, here), _change(before, there)
    if end <= start_there:
        return before[:start] + new + before[end:start_there] + new_there + before[end_there:]
    if end_there <= start:
        return before[:start_there] + new_there + before[end_there:start] + new + before[end:]
    return None


def _change(before: str, after: str) -> tuple[int, int, str]:
    """The smallest replaced piece of a text: its start, its end, and its replacement."""
    start = _alike(before, after)
    same = _alike(before[start:][::-1], after[start:][::-1])
    return start, len(before) - same, after[start : len(after) - same]


def _alike(one: str, other: str) -> int:
    """The length of the common prefix of two texts."""
    ends = min(len(one), len(other))
    return next((k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), ends)
