"""Records: runs that are over, replayed, compared with the plan, and exported.

A worker makes a record from the log of a run on request; records are not stored.
"""

from __future__ import annotations

import base64
import json
import os
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from muster.mission.values.keywords import require_one_of
from muster_control.contract import OVER, ConflictError
from muster_control.runs.records.record_files import LOG, TRACKS
from muster_control.work.pool import Pool
from muster_control.work.temporary_folders import OF_WORK

if TYPE_CHECKING:
    from muster_control.services.runs import Runs
    from muster_control.store.store import Store

FORMATS = ("csv", "geojson", "gpx", "kml", "json")


class Records:
    """The records of a database; `runs` knows runs that have just ended."""

    def __init__(self, store: Store, pool: Pool, runs: Runs) -> None:
        self._store, self._pool, self._runs = store, pool, runs

    async def page(self, run: int) -> str:
        """The page that `muster replay --html` writes.

        Raises
        ------
        NotFoundError
            if there is no such run; so do the other methods.
        ConflictError
            if the run is not over, or has no log.
        StoreError
            if the log cannot be read.
        """
        return (await self._file(run, "page")).decode()

    async def mcap(self, run: int) -> bytes:
        """The record as an MCAP file (docs/records.md)."""
        return await self._file(run, "mcap")

    async def flown(self, run: int) -> Mapping[str, Any]:
        """What was planned and what was carried out: in all, per robot and task, and the paths."""
        return await self._made(run, "flown")

    async def export(self, run: int, to: str) -> Mapping[str, str]:
        """Tracks and events for other programs: files (base64, by name).

        Raises
        ------
        ParameterError
            if there is no such format.
        WorkError
            if the format needs the mission's place on the earth, and the mission has none.
        """
        require_one_of("to", to, FORMATS)
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
        with TemporaryDirectory(prefix=f"{OF_WORK}{os.getpid()}-", ignore_cleanup_errors=True) as folder:
            return await self._pool.run("record", partial(self._given, run, to, Path(folder)))

    def _given(self, number: int, to: str, folder: Path) -> dict[str, Any]:
        """Read the worker's arguments from the database; log and tracks go by parts into files of a folder."""
        run = self._store.runs.get(number)
        if not self._store.log.entries(number, limit=1):
            raise ConflictError(f"run {number} has no log; expected one of which something was kept")
        with (folder / LOG).open("w", encoding="utf-8") as file:
            for entry in self._store.log.all_entries(number):
                said = {"seq": entry.seq, "time_s": entry.time_s, "kind": entry.kind, "data": dict(entry.data)}
                file.write(json.dumps(said, ensure_ascii=False) + "\n")
        with (folder / TRACKS).open("wb") as file:
            file.writelines(base64.b64encode(one.data) + b"\n" for one in self._store.log.stretches(number))
        version = self._store.missions.get(run.mission, run.mission_version)
        files = {name: base64.b64encode(data).decode() for name, data in version.files.items()}
        return {
            "mission": {"name": version.mission, "text": version.text, "files": files},
            "folder": str(folder),
            "to": to,
        }
