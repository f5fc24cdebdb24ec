"""The first message to a runner: mission, plan, the last checkpoint of the run, and the entries after it.

It is read from the database once and kept in memory, so that a runner can be restarted while the database is away. Each
new checkpoint takes the place of the entries before it.
"""

from __future__ import annotations

import asyncio
import base64
import logging
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster_control.contract import Checkpoint, Entry, MissionVersion, Run
from muster_control.runs.log.checkpoints import unpacked_state
from muster_control.runs.runner_process import json_line

if TYPE_CHECKING:
    from muster_control.store.store import Store

_log = logging.getLogger("muster.runs")


class RunnerInput:
    """What a runner of one run needs to begin, or to go on."""

    def __init__(self, store: Store, run: Run, lock: str) -> None:
        self._store, self._run, self._lock = store, run, lock
        self.checkpoint: Checkpoint | None = None
        self.log: list[Entry] = []
        self.bodies: Mapping[str, Any] | None = None
        self._work: dict[str, Any] | None = None
        self._tracked_s = 0.0

    @property
    def journal(self) -> Path:
        """The file that a runner of real robots keeps while the run is under way."""
        return Path(f"{self._lock}-{self._run.id}.journal")

    @property
    def known(self) -> bool:
        """Whether the input was read."""
        return self._work is not None

    @property
    def goes_on(self) -> bool:
        """Whether anything has happened in the run yet."""
        return bool(self.log) or self.checkpoint is not None

    async def read(self) -> None:
        """Read mission, plan, checkpoint and the entries after it from the database.

        Raises
        ------
        StoreError
            if it cannot be read.
        """
        await asyncio.to_thread(self._read)

    def add(self, entry: Entry) -> None:
        """Add an entry of the runner."""
        self.log.append(entry)

    def replace_log(self, checkpoint: Checkpoint) -> None:
        """Keep a checkpoint in place of the entries before it."""
        self.checkpoint = checkpoint
        self.log = [entry for entry in self.log if entry.seq > checkpoint.seq]

    def tracked(self, until_s: float) -> None:
        """Note up to when the runner has sent tracks."""
        self._tracked_s = max(self._tracked_s, until_s)

    def line(self, run: Run, cancelled: bool) -> bytes:
        """The message for a run as it is now, including the mission time that subscribers have seen."""
        assert self._work is not None
        checkpoint = self.checkpoint
        message = {
            **self._work,
            "run": run.id,
            "world": run.world,
            "settings": dict(run.settings),
            "speed": run.speed,
            "paused": run.state == "paused",
            "cancelled": cancelled,
            "seq": self.log[-1].seq if self.log else 0 if checkpoint is None else checkpoint.seq,
            "checkpoint": None if checkpoint is None else base64.b64encode(checkpoint.data).decode(),
            "log": [{"seq": e.seq, "time_s": e.time_s, "kind": e.kind, "data": dict(e.data)} for e in self.log],
            "bodies": self.bodies,
            "until_s": max(self._tracked_s, run.time_s) if self.goes_on else 0.0,
            "tracked_s": self._tracked_s,
            "lock": self._lock,
            "journal": str(self.journal),
            "at": None if run.at is None else run.at.isoformat(),
        }
        return json_line(message)

    def _read(self) -> None:
        run, store = self._run, self._store
        self.checkpoint = next(filter(_is_intact, store.log.checkpoints(run.id)), None)
        self.log = store.log.entries(run.id, 0 if self.checkpoint is None else self.checkpoint.seq)
        self.bodies, self._tracked_s = store.log.bodies(run.id), store.log.tracked_s(run.id)
        version = store.missions.get(run.mission, run.mission_version)
        entry = store.plans.get(run.plan)
        plan = {**entry.plan, "ignored": list(run.settings.get("ignore", entry.ignored))}
        self._work = {"mission": _mission(version), "plan": plan}


def _is_intact(checkpoint: Checkpoint) -> bool:
    """Whether a checkpoint can be read; the one before it, and the entries since then, say the same."""
    try:
        unpacked_state(checkpoint.data)
    except (zlib.error, ValueError) as error:
        _log.warning("run %d: its checkpoint of entry %d is damaged: %s", checkpoint.run, checkpoint.seq, error)
        return False
    return True


def _mission(version: MissionVersion) -> dict[str, Any]:
    files = {name: base64.b64encode(data).decode() for name, data in version.files.items()}
    return {"name": version.mission, "text": version.text, "files": files}
