"""Checkpoints of a run: when one is due, and how it is packed."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping
from typing import Any

from muster.mission.system.clock import Clock

MOST_ENTRIES, MOST_S = 2_000, 300.0
"""Entries, and seconds of the wall clock with entries, after which a checkpoint is due."""


def packed_state(state: Mapping[str, Any]) -> bytes:
    """Return the data of a checkpoint."""
    return zlib.compress(json.dumps(state, ensure_ascii=False, separators=(",", ":")).encode(), level=1)


def unpacked_state(data: bytes) -> Mapping[str, Any]:
    """Return what `packed_state` has packed."""
    state: Mapping[str, Any] = json.loads(zlib.decompress(data))
    return state


class Schedule:
    """Says when a checkpoint is due, so that a bounded part of the log follows the last one.

    Parameters
    ----------
    clock
        the wall clock.
    seq
        the entry of the last checkpoint, 0 for none.
    """

    def __init__(self, clock: Clock, seq: int) -> None:
        self._clock = clock
        self._seq, self._at = seq, clock.now()

    def take(self, seq: int) -> bool:
        """Return whether a checkpoint of an entry is due; then the next one is counted from here."""
        more = seq - self._seq
        if more < MOST_ENTRIES and not (more and self._clock.now() - self._at >= MOST_S):
            return False
        self._seq, self._at = seq, self._clock.now()
        return True
