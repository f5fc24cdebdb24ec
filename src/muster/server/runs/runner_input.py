"""The first message to a runner. It is read from the database once and kept in memory.

So a runner can be restarted while the database is down.
"""

from __future__ import annotations

import asyncio
import base64
from typing import TYPE_CHECKING, Any

from muster.exchange.mission_control import Entry, MissionVersion, Run
from muster.server.runs.packed_log import PackedLog
from muster.server.runs.runner_process import json_line

if TYPE_CHECKING:
    from muster.server.store.store import Store


class RunnerInput:
    """Of one run."""

    def __init__(self, store: Store, run: Run, lock: str) -> None:
        self._store, self._run, self._lock = store, run, lock
        self._packed_log = PackedLog()
        self._work: dict[str, Any] | None = None
        self._tracked_s = 0.0

    @property
    def known(self) -> bool:
        """Whether the input was read."""
        return self._work is not None

    async def read(self) -> None:
        """Read mission, plan and log from the database.

        Raises
        ------
        StoreError
            if it cannot be read.
        """
        self._packed_log, self._tracked_s, self._work = await asyncio.to_thread(self._read)

    def add(self, entry: Entry) -> None:
        """Add an entry of the runner."""
        self._packed_log.add([entry])

    def tracked(self, until_s: float) -> None:
        """Note up to when the runner has sent tracks."""
        self._tracked_s = max(self._tracked_s, until_s)

    def log(self) -> list[Entry]:
        """All entries."""
        return list(self._packed_log.entries())

    def line(self, run: Run) -> bytes:
        """The message for a run as it is now, including the mission time that subscribers have seen."""
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
        return json_line(message)

    def _read(self) -> tuple[PackedLog, float, dict[str, Any]]:
        run, store, log = self._run, self._store, PackedLog()
        log.add(store.log.entries(run.id))
        version = store.missions.get(run.mission, run.mission_version)
        entry = store.plans.get(run.plan)
        plan = {**entry.plan, "ignored": list(run.settings.get("ignore", entry.ignored))}
        work = {"mission": _mission(version), "plan": plan}
        return log, store.log.tracked_s(run.id), work


def _mission(version: MissionVersion) -> dict[str, Any]:
    files = {name: base64.b64encode(data).decode() for name, data in version.files.items()}
    return {"name": version.mission, "text": version.text, "files": files}
