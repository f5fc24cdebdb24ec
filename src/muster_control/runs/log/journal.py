"""The journal of a server: what it has accepted and the database has not, synced to a local file before it is answered.

Each line is a CRC 32, a space, and an action, an entry of a run's log or the end of its tick, as JSON. Items that are
appended while others are being synced are synced together (group commit). The file is emptied when the database has all
of it.
"""

from __future__ import annotations

import asyncio
import fcntl
import json
import logging
import os
import shutil
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict
from datetime import datetime
from pathlib import Path

from muster.mission.system.checked_lines import checked_line, text_of
from muster_control.contract import Action, Entry, StoreError, Tick
from muster_control.store.columns import as_json

Item = Action | Entry | Tick
_KINDS: dict[str, type[Item]] = {"action": Action, "entry": Entry, "tick": Tick}

_PAUSE_S = 0.1

_log = logging.getLogger("muster.runs")


class Journal:
    """The journal of one server, which locks its file.

    Parameters
    ----------
    path
        the file; it is created, for this user only, if it does not exist.
    patience_s
        seconds to wait for another server that has the file: one that has lost the database ends within a few.

    Raises
    ------
    StoreError
        if the file cannot be opened, or another server has it.
    """

    def __init__(self, path: Path, patience_s: float = 0.0) -> None:
        self.path = path
        self._file = _opened(path, time.monotonic() + patience_s)
        self._thread = ThreadPoolExecutor(1, "muster-journal")  # the other threads may all wait for the database
        self._waiting: list[tuple[bytes, asyncio.Future[None]]] = []
        self._writing: asyncio.Task[None] | None = None
        self._runs: set[int | None] = set()

    def read(self) -> list[Item]:
        """Return all intact items, in order. A damaged line is reported in the server's log and left out.

        A power cut damages the last line, which was not answered yet. If another line is damaged, a copy of the file
        is kept beside it.
        """
        lines = self.path.read_bytes().split(b"\n")
        end = lines.pop()
        items = [_item(line) for line in lines]
        damaged = [k for k, item in enumerate(items, start=1) if item is None]
        if end:
            _log.warning(
                "%s: its last line is incomplete and left out; the %d before it are read", self.path, len(items)
            )
        if damaged:
            copy = self.set_aside()
            _log.error(
                "%s: line %d is damaged and left out, of %d; %s is a copy", self.path, damaged[0], len(items), copy
            )
        return [item for item in items if item is not None]

    def set_aside(self) -> Path:
        """Copy the file to one beside it, and return that."""
        copy = self.path.with_name(f"{self.path.name}-{datetime.now():%Y%m%dT%H%M%S}")
        shutil.copy(self.path, copy)
        return copy

    def append(self, items: Sequence[Item]) -> asyncio.Future[None]:
        """Append items; return a future that is done when they are synced. Futures are done in the order of the calls.

        The future raises StoreError if the items cannot be written; the file is as before then.
        """
        synced = asyncio.get_running_loop().create_future()
        self._runs |= {item.run for item in items}
        self._waiting.append((b"".join(map(_line, items)), synced))
        if self._writing is None:
            self._writing = asyncio.create_task(self._write())
        return synced

    async def flushed(self) -> None:
        """Wait until all that was appended is synced, or refused."""
        if self._writing is not None:
            await asyncio.shield(self._writing)

    def release(self, run: int) -> None:
        """Note that the database has all of a run; empty the file if that holds for every run."""
        if run not in self._runs:
            return
        self._runs.discard(run)
        if not self._runs:
            self._thread.submit(self._empty)

    def empty(self) -> None:
        """Empty the file, whose items are in the database."""
        self._thread.submit(self._empty).result()

    async def close(self) -> None:
        """Close the file when all is synced."""
        await self.flushed()
        await asyncio.to_thread(self._thread.shutdown)
        os.close(self._file)

    async def _write(self) -> None:
        """Write and sync what waits, until nothing does."""
        while self._waiting:
            batch, self._waiting = self._waiting, []
            data = b"".join(data for data, _ in batch)
            refused: StoreError | None = None
            try:
                await asyncio.wrap_future(self._thread.submit(self._sync, data))
            except OSError as error:
                refused = StoreError(f"{self.path}: {error.strerror}; free some space, or make the folder writable")
            except RuntimeError:  # its thread is no more
                refused = StoreError(f"{self.path}: is closed, as the server ends; ask again when it is started")
            for _, synced in batch:
                if refused is not None:
                    synced.set_exception(refused)
                else:
                    synced.set_result(None)
        self._writing = None

    def _sync(self, data: bytes) -> None:
        """Append data and sync it; after a failure the file is as before."""
        size = os.fstat(self._file).st_size
        try:
            written = 0
            while written < len(data):
                written += os.write(self._file, data[written:])
            os.fdatasync(self._file)
        except OSError:
            with suppress(OSError):
                os.ftruncate(self._file, size)
            raise

    def _empty(self) -> None:
        with suppress(OSError):  # what the database has already is passed over when the journal is read
            os.ftruncate(self._file, 0)
            os.fdatasync(self._file)


def _opened(path: Path, until: float) -> int:
    """Open and lock the file, and sync its folder, so that the file outlives a power cut."""
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o600)
    except OSError as error:
        raise StoreError(f"{path}: {error.strerror}; expected a folder that can be written") from None
    try:
        _lock(file, until)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError as error:
        os.close(file)
        why = "in use by another server" if isinstance(error, BlockingIOError) else str(error.strerror)
        raise StoreError(f"{path}: {why}; expected one server a database, and a folder that can be synced") from None
    return file


def _lock(file: int, until: float) -> None:
    """Lock a file; raises BlockingIOError if another process has it at a moment of the monotonic clock."""
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            if time.monotonic() >= until:
                raise
        time.sleep(_PAUSE_S)


def _line(item: Item) -> bytes:
    kind = next(name for name, of in _KINDS.items() if isinstance(item, of))
    plain = asdict(item)
    if plain.get("at"):
        plain["at"] = plain["at"].isoformat()
    return checked_line(as_json({kind: plain}).encode())


def _item(line: bytes) -> Item | None:
    """The item of a line; None if the line is damaged."""
    text = text_of(line)
    if text is None:
        return None
    ((kind, plain),) = json.loads(text).items()
    if plain.get("at"):
        plain["at"] = datetime.fromisoformat(plain["at"])
    return _KINDS[kind](**plain)
