"""What a runner is told first. It is read from the database once; then the next runner is told it from memory.

So a runner that dies while the database is gone is followed by another, which goes on.
"""

from __future__ import annotations

import asyncio
import base64
from typing import TYPE_CHECKING, Any

from muster.exchange.mission_control import Entry, MissionVersion, Run
from muster.server.runs.packed_log import Memory
from muster.server.runs.runner_process import line_to_say

if TYPE_CHECKING:
    from muster.server.store.store import Store


class Brief:
    """Of one run."""

    def __init__(self, store: Store, run: Run, lock: str) -> None:
        self._store, self._run, self._lock = store, run, lock
        self._memory = Memory()
        self._work: dict[str, Any] | None = None
        self._tracked_s = 0.0

    @property
    def known(self) -> bool:
        """Whether it was read."""
        return self._work is not None

    async def read(self) -> None:
        """What the database has: mission, plan, and what was logged before a crash.

        Raises
        ------
        StoreError
            if it cannot be read.
        """
        self._memory, self._tracked_s, self._work = await asyncio.to_thread(self._read)

    def add(self, entry: Entry) -> None:
        """An entry that the runner has told."""
        self._memory.add([entry])

    def tracked(self, until_s: float) -> None:
        """Up to when the runner has told tracks."""
        self._tracked_s = max(self._tracked_s, until_s)

    def log(self) -> list[Entry]:
        """All entries."""
        return list(self._memory.entries())

    def line(self, run: Run) -> bytes:
        """What is said; the run is as it is now: what watchers have seen of it is not to happen once more."""
        assert self._work is not None
        log = self.log()
        message = {
            **self._work,
            "run": run.id,
            "world": run.world,
            "settings": dict(run.settings),
            "speed": run.speed,
            "log": [{"seq": e.seq, "time_s": e.time_s, "kind": e.kind, "data": dict(e.data)} for e in log],
            "until_s": max(self._tracked_s, run.time_s) if log else 0.0,
            "tracked_s": self._tracked_s,
            "lock": self._lock,
        }
        return line_to_say(message)

    def _read(self) -> tuple[Memory, float, dict[str, Any]]:
        run, store, memory = self._run, self._store, Memory()
        memory.add(store.log.entries(run.id))
        version = store.missions.get(run.mission, run.mission_version)
        entry = store.plans.get(run.plan)
        plan = {**entry.plan, "ignored": list(run.settings.get("ignore", entry.ignored))}
        work = {"mission": _mission(version), "plan": plan}
        return memory, store.log.tracked_s(run.id), work


def _mission(version: MissionVersion) -> dict[str, Any]:
    files = {name: base64.b64encode(data).decode() for name, data in version.files.items()}
    return {"name": version.mission, "text": version.text, "files": files}
