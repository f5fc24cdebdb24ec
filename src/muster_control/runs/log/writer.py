"""Writes a run to the database in small batches and in threads; while that fails, to the server's journal.

Everything is written in order: entries and tracks in one transaction, then actions, then fields of the run. Subscribers
receive entries when the database has them, or while it fails the journal. Memory alone holds tracks meanwhile.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from muster.mission.errors import MusterError
from muster_control.contract import Action, Checkpoint, ConflictError, Entry, Stretch, Tick

if TYPE_CHECKING:
    from muster_control.runs.log.journal import Journal
    from muster_control.store.store import Store

BATCH_S = 0.1
AGAIN_S = 2.0
PATIENCE_S = 2.0
ENTRIES_MOST = 100_000
TRACKS_MOST = 64 * 2**20
"""Seconds between two batches; until a database that refuses is asked again; until one that says nothing counts as one
that refuses; what is kept in memory meanwhile.
"""
_AT_ONCE = 500
_BEHIND = 5000

_log = logging.getLogger("muster.runs")


class LogWriter:
    """Of one run.

    Parameters
    ----------
    journal
        takes entries and actions while the database fails.
    on_entries
        receives each entry once and in order, when the database or the journal has it.
    on_actions
        receives actions when the database has them.
    on_trouble
        receives why the database fails, and an empty text when it works again.
    on_lost
        called if another process has written this log; nothing more is written then.
    """

    def __init__(
        self,
        store: Store,
        run: int,
        journal: Journal,
        *,
        on_entries: Callable[[Sequence[Entry]], None],
        on_actions: Callable[[Sequence[Action]], None],
        on_trouble: Callable[[str], None],
        on_lost: Callable[[str], None],
    ) -> None:
        self._store, self._run, self._journal = store, run, journal
        self._on_entries, self._on_actions = on_entries, on_actions
        self._on_trouble, self._on_lost = on_trouble, on_lost
        self._entries: list[Entry] = []
        self._stretches: list[Stretch] = []
        self._bodies: Mapping[str, Any] | None = None  # after an entry `seq`: written once that entry is, and with it
        self._fields: dict[str, Any] = {}
        self._actions: dict[int, Action] = {}
        self._checkpoint: Checkpoint | None = None
        self._given = self._saved = 0
        self._last_stretch: int | None = None
        self._dropped = 0
        self._wake, self._drained = asyncio.Event(), asyncio.Event()
        self._drained.set()
        self._closing = False
        self.trouble, self._unsaved, self._lost = "", "", False
        self._task = asyncio.create_task(self._go())

    def add(self, entries: Sequence[Entry], bodies: Mapping[str, Any] | None) -> None:
        """Add the entries of a tick, and where bodies are after it."""
        self._entries += entries
        self._bodies = bodies
        if self.trouble:
            self._save(entries)
        self._ask()

    def add_stretch(self, from_s: float, until_s: float, data: bytes) -> None:
        """Add a stretch of tracks; if too many wait the oldest are lost."""
        self._stretches.append(Stretch(run=self._run, seq=0, from_s=from_s, until_s=until_s, data=data))
        while self.trouble and sum(len(one.data) for one in self._stretches) > TRACKS_MOST:
            self._drop_stretch()
        self._ask()

    def set(self, **fields: Any) -> None:
        """Set fields of the run."""
        self._fields |= fields
        self._ask()

    def keep_checkpoint(self, checkpoint: Checkpoint) -> None:
        """Write a checkpoint, after all entries and actions that were added so far; of several that wait the newest."""
        self._checkpoint = checkpoint
        self._ask()

    def keep(self, action: Action) -> None:
        """Write an action and its outcome, after all entries that were added so far."""
        self._actions[action.id] = action
        self._ask()

    def save(self, action: Action) -> asyncio.Future[None]:
        """Write an action now to the journal, and later to the database.

        The future is done when the journal has the action. It raises StoreError if the journal cannot be written.
        """
        self.keep(action)  # first: the journal is emptied when nothing is to be written
        return self._journal.append([action])

    @property
    def behind(self) -> bool:
        """Whether the database is too slow: the caller should wait before it adds more."""
        return len(self._entries) > _BEHIND and not self.trouble

    @property
    def full(self) -> bool:
        """Whether more entries wait than may be kept in memory."""
        return len(self._entries) > ENTRIES_MOST

    async def drained(self) -> None:
        """Wait until all is written, or nothing more will be."""
        await self._drained.wait()

    async def given(self) -> None:
        """Wait until all that was added is written, or the database has failed."""
        while not self._drained.is_set() and (not self.trouble or self._given < self._saved):
            await asyncio.sleep(BATCH_S / 4)

    async def entries(self, after: int, limit: int | None = None) -> list[Entry]:
        """Entries after `after`: from the database, then those not written yet.

        Raises
        ------
        StoreError
            if they are in the database only, and it cannot be read.
        """
        waiting = [entry for entry in self._entries if entry.seq > after and entry.seq <= self._given]
        if not waiting or waiting[0].seq > after + 1:
            kept = await asyncio.to_thread(self._store.log.entries, self._run, after, limit)
            waiting = [*kept, *(entry for entry in waiting if not kept or entry.seq > kept[-1].seq)]
        return waiting[:limit]

    async def close(self) -> bool:
        """Try to write the rest once more; returns whether all was written."""
        self._closing = True
        self._ask()
        return await self._task

    def _ask(self) -> None:
        self._drained.clear()
        self._wake.set()

    async def _go(self) -> bool:
        """Write until `close`; returns whether all was written."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            begun = time.monotonic()
            works = await self._write()
            if works and not (self._entries or self._stretches or self._fields or self._actions or self._checkpoint):
                self._drained.set()
                if not self._lost:
                    self._journal.release(self._run)
            if self._closing and (self._drained.is_set() or not works):
                self._drained.set()
                return works
            if not works:
                self._wake.set()
            pause = (BATCH_S if works else AGAIN_S) - (time.monotonic() - begun)
            if not self._closing:
                await asyncio.sleep(max(0.0, pause))

    async def _write(self) -> bool:
        """Write one batch; returns whether it was written."""
        if self._lost:
            self._forget()
            return True
        entries, stretches = self._batch(), self._stretches[:_AT_ONCE]
        bodies = self._bodies_after(entries)
        fields, actions, checkpoint = dict(self._fields), list(self._actions.values()), self._checkpoint
        whole = len(entries) == len(self._entries)
        trouble = ""
        try:
            if entries or stretches:
                await self._append_patiently(entries, stretches, bodies)
            if whole:
                await self._write_rest(actions, checkpoint, fields)
        except ConflictError as error:  # another try would fail too
            self._lost = True
            self._forget()
            self._on_lost(str(error))
            return True
        except Exception as error:  # keep what cannot be written, and try again
            known = isinstance(error, MusterError)
            trouble = str(error) if known else f"an error of mission control: {type(error).__name__}: {error}"
            if trouble != self.trouble and not known:
                _log.exception("run %d", self._run)
        if trouble:
            self._save(self._entries)
        else:
            self._give(entries)
        self._be_troubled(trouble)
        if self._entries or self._stretches:
            self._wake.set()
        return not trouble

    async def _write_rest(
        self, actions: Sequence[Action], checkpoint: Checkpoint | None, fields: Mapping[str, Any]
    ) -> None:
        """Write what comes after entries: actions, then a checkpoint, then fields of the run."""
        if actions:
            await self._patiently(self._store.actions.keep, actions)
            for one in actions:
                if self._actions[one.id] is one:  # no outcome came meanwhile
                    del self._actions[one.id]
            self._on_actions(actions)
        if checkpoint is not None:
            await self._patiently(self._store.log.add_checkpoint, checkpoint)
            self._checkpoint = None if self._checkpoint is checkpoint else self._checkpoint
        if fields:
            await self._patiently(partial(self._store.runs.set, self._run, **fields))
            self._fields = {key: value for key, value in self._fields.items() if fields.get(key, self) != value}

    def _batch(self) -> list[Entry]:
        """The first entries that wait, cut where the mission's time changes: what happens at once is kept as one."""
        count = _AT_ONCE
        while count < len(self._entries) and self._entries[count].time_s == self._entries[count - 1].time_s:
            count += 1
        return self._entries[:count]

    def _bodies_after(self, entries: Sequence[Entry]) -> Mapping[str, Any] | None:
        """Where bodies are after entries, or after those that were given without any; None if they moved on since."""
        last = entries[-1].seq if entries else self._given
        return None if self._bodies is None or self._bodies["seq"] > last else self._bodies

    async def _append_patiently(
        self, entries: Sequence[Entry], stretches: Sequence[Stretch], bodies: Mapping[str, Any] | None
    ) -> None:
        """Write the first entries and stretches, which are not dropped meanwhile."""
        del self._stretches[: len(stretches)]
        try:
            await self._patiently(self._append, entries, stretches, bodies)
        except BaseException:
            self._stretches[:0] = stretches
            raise
        del self._entries[: len(entries)]

    async def _patiently(self, write: Callable[..., object], *arguments: Any) -> None:
        """Write in a thread; if it is slow, the journal takes the waiting entries meanwhile."""
        writing = asyncio.create_task(asyncio.to_thread(write, *arguments))
        done, _ = await asyncio.wait([writing], timeout=PATIENCE_S)
        if not done:
            self._be_troubled(self.trouble or "the database takes its time")
            self._save(self._entries)
        await writing

    def _save(self, entries: Sequence[Entry]) -> None:
        """Write entries to the journal that it has not yet, and give them to subscribers then."""
        new = [entry for entry in entries if entry.seq > self._saved]
        if new:
            self._saved = new[-1].seq
            tick = Tick(run=self._run, seq=self._saved, bodies=self._bodies_after(new))
            self._journal.append([*new, tick]).add_done_callback(partial(self._on_saved, new))

    def _on_saved(self, entries: Sequence[Entry], saved: asyncio.Future[None]) -> None:
        """Give entries to subscribers; also if the journal could not be written, since the run goes on."""
        error = saved.exception()
        if error is not None and not self._unsaved:
            self._unsaved = str(error)
            self._be_troubled(self.trouble)
        self._give(entries)

    def _be_troubled(self, why: str) -> None:
        """Report why the database fails, and the journal if that does, too; empty if the database works."""
        self._unsaved = self._unsaved if why else ""
        if self._unsaved and self._unsaved not in why:
            why = f"{why}; {self._unsaved}"
        if why != self.trouble:
            self.trouble = why
            _log.warning("run %d: %s", self._run, why or f"the database works again; {self._kept()}")
            self._dropped = 0
            self._on_trouble(why)

    def _drop_stretch(self) -> None:
        """Drop the oldest stretch of tracks."""
        if not self._dropped:
            _log.warning("run %d: more than %d bytes of tracks wait; the oldest are lost", self._run, TRACKS_MOST)
        del self._stretches[0]
        self._dropped += 1

    def _kept(self) -> str:
        return f"all is kept but {self._dropped} stretches of tracks" if self._dropped else "all is kept"

    def _forget(self) -> None:
        """Drop all that is not written."""
        for waiting in (self._entries, self._stretches, self._actions, self._fields):
            waiting.clear()

    def _append(self, entries: Sequence[Entry], stretches: Sequence[Stretch], bodies: Mapping[str, Any] | None) -> None:
        """Append in a thread. Stretches are numbered when they are written, as some may have been dropped."""
        if self._last_stretch is None:
            self._last_stretch = self._store.log.last_stretch(self._run)
        numbered = [replace(one, seq=self._last_stretch + k) for k, one in enumerate(stretches, start=1)]
        time_s = max([*(one.time_s for one in entries), *(one.until_s for one in stretches)])
        self._store.log.append(self._run, time_s, entries, numbered, bodies)
        self._last_stretch += len(numbered)

    def _give(self, entries: Sequence[Entry]) -> None:
        new = [entry for entry in entries if entry.seq > self._given]
        if new:
            self._given = new[-1].seq
            self._on_entries(new)
