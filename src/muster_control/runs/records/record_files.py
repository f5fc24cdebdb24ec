"""The files by which a worker reads the log and the tracks of a run, one entry and one stretch at a time."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from muster_control.runs.log.tracks import Steps

LOG, TRACKS = "log.jsonl", "tracks.base64"
"""A line is an entry; a line is a stretch."""


def read_log(folder: Path) -> Iterator[Mapping[str, Any]]:
    """Yield the entries of a log."""
    with (folder / LOG).open(encoding="utf-8") as file:
        yield from map(json.loads, file)


def read_tracks(folder: Path) -> Iterator[Steps]:
    """Yield the stretches of tracks."""
    from muster_control.runs.log.tracks import unpacked  # NumPy makes a server large, which reads no tracks itself

    with (folder / TRACKS).open("rb") as file:
        yield from (unpacked(base64.b64decode(line)) for line in file)
