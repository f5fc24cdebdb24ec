"""Records: runs that are over, to be replayed, compared with what was planned, taken away.

A record is made from the log by a worker when somebody asks for it: nothing is kept twice.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from muster.exchange.mission_control import OVER, ConflictError, Run
from muster.mission.errors import ParameterError
from muster.mission.near_matches import did_you_mean
from muster.server.work.pool import Pool

if TYPE_CHECKING:
    from muster.server.services.runs import Runs
    from muster.server.store.store import Store

FORMATS = ("csv", "geojson", "gpx", "kml", "json")


class Records:
    """Of all runs of a database; `runs` knows of those that have just ended."""

    def __init__(self, store: Store, pool: Pool, runs: Runs) -> None:
        self._store, self._pool, self._runs = store, pool, runs

    async def list(self, limit: int = 200) -> Sequence[Run]:
        """Runs that are over, the newest first."""
        return await self._runs.over(limit)

    async def page(self, run: int) -> str:
        """The page that `muster replay --html` writes.

        Raises
        ------
        NotFoundError
            if there is no such run. So do the others.
        ConflictError
            if it is not over, or nothing of it was kept.
        StoreError
            if the database refuses what it is made from.
        """
        return (await self._file(run, "page")).decode()

    async def mcap(self, run: int) -> bytes:
        """The record as an MCAP file (docs/records.md)."""
        return await self._file(run, "mcap")

    async def flown(self, run: int) -> Mapping[str, Any]:
        """What was planned beside what was flown: of the whole, of each robot and task, and where the ways led."""
        return await self._made(run, "flown")

    async def export(self, run: int, to: str) -> Mapping[str, str]:
        """Tracks and events for other tools: files by their names, in base64.

        Raises
        ------
        ParameterError
            if there is no such format.
        WorkError
            if it needs the mission's place on the earth, and that is not known.
        """
        if to not in FORMATS:
            raise ParameterError(f"to: {to}; expected {', '.join(FORMATS)}{did_you_mean(to, FORMATS)}")
        files: Mapping[str, str] = (await self._made(run, to))["files"]
        return files

    async def _file(self, run: int, to: str) -> bytes:
        (data,) = (await self._made(run, to))["files"].values()
        return base64.b64decode(data)

    async def _made(self, run: int, to: str) -> Mapping[str, Any]:
        state = (await self._runs.get(run)).state
        if state not in OVER:
            raise ConflictError(f"run {run} is {state}; expected one that is over")
        await self._runs.kept(run)
        return await self._pool.run("record", partial(self._given, run, to))

    def _given(self, number: int, to: str) -> dict[str, Any]:
        """What the worker needs, from the database."""
        run = self._store.runs.get(number)
        entries = self._store.log.entries(number)
        if not entries:
            raise ConflictError(f"run {number} has no log; expected one of which something was kept")
        version = self._store.missions.get(run.mission, run.mission_version)
        files = {name: base64.b64encode(data).decode() for name, data in version.files.items()}
        return {
            "mission": {"name": version.mission, "text": version.text, "files": files},
            "log": [{"seq": e.seq, "time_s": e.time_s, "kind": e.kind, "data": dict(e.data)} for e in entries],
            "stretches": [base64.b64encode(one.data).decode() for one in self._store.log.stretches(number)],
            "to": to,
        }
