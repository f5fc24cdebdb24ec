"""One run, as the server has it: its runner, started again after a crash; its log, its state, its watchers."""

from __future__ import annotations

import asyncio
import base64
import json
import logging
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from datetime import UTC, datetime
from functools import partial
from typing import TYPE_CHECKING, Any

from muster.exchange.mission_control import OVER, Action, Entry, Run, RunState, StoreError
from muster.running.worlds import WORLDS
from muster.server.runs.crash_history import Deaths
from muster.server.runs.log_lines import line_of
from muster.server.runs.log_writer import Journal
from muster.server.runs.runner_input import Brief
from muster.server.runs.runner_process import Child
from muster.server.runs.subscribers import Feed
from muster.server.runs.unsaved_actions import number_at

if TYPE_CHECKING:
    from muster.server.store.store import Store

TOO_LATE = "the run was over before"
"""The outcome of what was asked for and not done any more."""
NOTED_S = 1.0
"""Seconds of the wall clock between two times of the mission that are kept where nothing happens."""
_AGAIN_S = 0.2
_TIME = re.compile(r'"time_s":([0-9.e+-]+)')

_log = logging.getLogger("muster.runs")


class Carrying:
    """A run that is under way.

    Parameters
    ----------
    run
        as the database has it.
    lock
        a file in which a runner of real robots locks its run, so that never two command them.
    memory_mb
        what a runner of a simulated world may have.
    """

    def __init__(self, store: Store, run: Run, lock: str, memory_mb: int) -> None:
        self._store, self.run, self._brief = store, run, Brief(store, run, lock)
        self._memory_mb = memory_mb
        self._asked: dict[int, Action] = {}
        self._child: Child | None = None
        self._mission: Mapping[str, Any] | None = None
        self._noted_at = -NOTED_S
        self._closing = self._cancelled = self._reported = False
        self._failed = self._trouble = self._resuming = ""
        self._ended_at: datetime | None = None
        self._texts: dict[int, str] = {}
        self.journal = Journal(store, run.id, on_entries=self._kept, on_trouble=self._troubled, on_lost=self._give_up)
        self.feed = Feed(self._hello, self._read_texts)

    @property
    def over(self) -> bool:
        """Whether nothing more happens in it."""
        return self.run.state in OVER

    @property
    def pid(self) -> int | None:
        """Of its runner."""
        return None if self._child is None else self._child.pid

    async def go(self) -> None:
        """Carry it to its end, or until `close`."""
        try:
            await self._go()
        except Exception as error:
            _log.exception("run %d", self.run.id)
            self._failed = f"an error of mission control: {type(error).__name__}: {error}"
        if not self._closing:
            await self.journal.given()
            self._become_over()
        self.feed.end()
        if not self._closing:
            await self.journal.drained()
        await self.journal.close()

    def ask(self, action: Action) -> bool:
        """Have something done that a user asks for; False if the run is over, so that nobody does it."""
        if self.over:
            return False
        self._asked[action.id] = action
        if self._child is not None:
            self._child.say(_asked(action))
        return True

    async def close(self) -> None:
        """The server ends: the runner too; the run goes on when the server is there again."""
        self._closing = True
        self.journal.set(time_s=self.run.time_s)
        if self._child is not None:
            await self._child.end()
        if self.over:  # what the database still refuses is lost, except that the log tells it again
            await self.journal.close()

    async def _go(self) -> None:
        deaths = Deaths(real=self.run.world not in WORLDS)
        while not self._closing:
            begin = await self._begin_when_it_can_be_read()
            if begin is None:
                return
            self._child = await Child.start(f"run {self.run.id}", self._memory_mb)
            deaths.born()
            try:
                if self._closing:
                    return
                await self._led(self._child, begin)
            finally:
                await self._child.end()
            if self._reported or self._failed or self._closing:
                return
            await self.journal.given()
            reached = (self.run.time_s, self.feed.seq - self.run.resumed)  # that it resumed is no progress
            if deaths.too_often(reached, killed=self._child.killed):
                words, at_s = self._child.last_words or "without a word", f"{self.run.time_s:.1f} s"
                self._failed = f"its process ended {deaths.count} times in a row, at {at_s} of the mission: {words}"
                return
            await asyncio.sleep(_AGAIN_S)

    async def _led(self, child: Child, begin: bytes) -> None:
        """Tell a runner what to do, and hear it to its end."""
        child.say_line(begin)
        for action in self._asked.values():
            child.say(_asked(action))
        async for text in child.heard():
            await self._hear(text)

    async def _begin_when_it_can_be_read(self) -> bytes | None:
        """As `_begin`, however long the database is gone; None also if the server closes meanwhile."""
        while not self._closing:
            try:
                return await self._begin()
            except StoreError as error:
                _log.warning("run %d: %s", self.run.id, error)
                await asyncio.sleep(_AGAIN_S)
        return None

    async def _begin(self) -> bytes | None:
        """What the runner is told first, a line; None where the log says that it is over."""
        if not self._brief.known:
            unsettled = await asyncio.to_thread(self._store.actions.unsettled, self.run.id)
            await self._brief.read()
            self._recall(await asyncio.to_thread(self._brief.log), unsettled)
        self._texts.clear()
        return None if self._reported else await asyncio.to_thread(self._brief.line, self.run)

    def _recall(self, log: Sequence[Entry], unsettled: Sequence[Action]) -> None:
        """After a crash of the server the log counts; what users asked for is settled by it, or still to be done."""
        self.run = replace(self.run, resumed=0)
        for entry in log:
            self._fold(entry)
        if log:
            self.feed.publish([(entry.seq, _entry_text(entry)) for entry in log[-100:]])
        applied = {entry.data["action"]: entry for entry in log if entry.kind == "command"}
        for action in unsettled:
            said = applied.get(action.id) or applied.get(number_at(action.at))
            if said is None:
                self._asked.setdefault(action.id, action)
            else:
                self._write_outcome(action.id, action, said.data["outcome"], said.time_s)
        self._asked = {action.id: action for action in sorted(self._asked.values(), key=lambda action: action.at)}

    async def _hear(self, text: str) -> None:
        """Take a line of the runner. States and status go to watchers as they are."""
        for kind in ("states", "status"):
            if text.startswith(f'{{"type":"{kind}"'):
                self.feed.tell(kind, text)
                self._note_time(text)
                return
        said = json.loads(text)
        if said["type"] == "entry":
            self._take(said, text)
            while self.journal.behind:
                await asyncio.sleep(0.05)
        elif said["type"] == "stretch":
            self._brief.tracked(said["until_s"])
            self.journal.add_stretch(said["from_s"], said["until_s"], base64.b64decode(said["data"]))
        elif said["type"] == "mission":
            self._mission = said["mission"]
            self.feed.ready()
        elif said["type"] == "resuming":
            self._resuming = f"resuming ({said['share']:.0%})"
            self._tell_run()
        elif said["type"] == "going":
            self._resuming = ""
            self._change(state="running" if self.run.state == "starting" else self.run.state)
        elif said["type"] == "failed":
            self._failed = said["reason"]

    def _note_time(self, text: str) -> None:
        """Keep now and then how far watchers have seen it go: a run that is resumed goes on from there."""
        self.run = replace(self.run, time_s=max(self.run.time_s, float(_TIME.search(text)[1])))  # type: ignore[index]
        now = asyncio.get_running_loop().time()
        if now >= self._noted_at + NOTED_S:
            self._noted_at = now
            self.journal.set(time_s=self.run.time_s)

    def _take(self, said: Mapping[str, Any], text: str) -> None:
        seq, time_s = said["seq"], said["time_s"]
        entry = Entry(
            run=self.run.id, seq=seq, time_s=time_s, kind=said["kind"], data=said["data"], at=datetime.now(UTC)
        )
        self._texts[seq] = text
        self._reported |= entry.kind == "report"
        self._brief.add(entry)
        self.journal.add(entry)
        if self.journal.full and self._child is not None:
            self._failed = f"its log could not be kept: {self._trouble}"
            self._child.dismiss()

    def _kept(self, entries: Sequence[Entry]) -> None:
        """Entries are in the database, or cannot be: watchers are told."""
        for entry in entries:
            self._fold(entry)
        self.feed.publish([(entry.seq, self._texts.pop(entry.seq, "") or _entry_text(entry)) for entry in entries])
        for entry in entries:
            if entry.kind == "command":
                self._settle(entry)

    def _fold(self, entry: Entry) -> None:
        """What an entry says of the run."""
        self.run = replace(self.run, time_s=max(self.run.time_s, entry.time_s))
        if entry.kind == "report":
            self._reported = True
            self._ended_at = entry.at
            self.run = replace(self.run, report=entry.data)
        elif entry.kind == "resumed":
            self._change(resumed=self.run.resumed + 1)
        elif entry.kind == "command" and entry.data["outcome"] == "done":
            self._obeyed(entry.data["verb"], entry.data["data"])

    def _obeyed(self, verb: str, data: Mapping[str, Any]) -> None:
        states: dict[str, RunState] = {"pause": "paused", "resume": "running"}
        if verb in states:
            self._change(state=states[verb])
        elif verb == "speed":
            self._change(speed=data["speed"])
        elif verb == "cancel":
            self._cancelled = True

    def _settle(self, entry: Entry) -> None:
        """What came of an action is known."""
        number = entry.data["action"]
        self._write_outcome(number, self._asked.pop(number, None), entry.data["outcome"], entry.time_s)

    def _write_outcome(self, number: int, action: Action | None, outcome: str, applied_s: float | None = None) -> None:
        if number > 0:
            self.journal.later(partial(self._store.actions.settle, number, outcome, applied_s))
        elif action is not None:  # the database refused it when it was asked for
            action = replace(action, outcome=outcome, applied_s=applied_s)
            self.journal.later(partial(self._store.actions.keep, action))
        self.feed.tell_action({"id": number, "outcome": outcome})

    def _become_over(self) -> None:
        state: RunState = "failed" if self._failed else "cancelled" if self._cancelled else "ended"
        for action in self._asked.values():
            self._write_outcome(action.id, action, TOO_LATE)
        self._asked.clear()
        self._resuming = ""
        self._change(state=state, ended_at=self._ended_at or datetime.now(UTC))

    def _troubled(self, why: str) -> None:
        self._trouble = f"this run is not being kept: {why}" if why else ""
        self._change()

    def _give_up(self, why: str) -> None:
        """Somebody else carries the run out: nothing of it is done or written here any more, its end neither."""
        _log.error("run %d: given up: %s", self.run.id, why)
        self._closing = True
        self._trouble = f"given up here: {why}"
        self._change()
        if self._child is not None:
            self._child.dismiss()

    def _change(self, **fields: Any) -> None:
        """Fields of the run are others, and so may its remark be."""
        remark = "; ".join(part for part in (self._failed, self._trouble) if part)
        fields["remark"] = remark
        new = {key: value for key, value in fields.items() if getattr(self.run, key) != value}
        if new:
            self.run = replace(self.run, **new)
            kept = dict(new)
            if "remark" in kept:
                kept["remark"] = self._failed  # what is written is kept
            self.journal.set(**kept)
        self._tell_run()

    def _tell_run(self) -> None:
        run = self.run
        said = {"state": run.state, "speed": run.speed, "time_s": run.time_s, "remark": self._resuming or run.remark}
        self.feed.tell("run", json.dumps({"type": "run", **said}, ensure_ascii=False, separators=(",", ":")))

    def _hello(self) -> Mapping[str, Any]:
        run = replace(self.run, remark=self._resuming or self.run.remark)
        return {"run": plain_run(run), "mission": self._mission}

    async def _read_texts(self, after: int) -> list[tuple[int, str]]:
        return [(entry.seq, _entry_text(entry)) for entry in await self.journal.entries(after, 500)]


def plain_run(run: Run) -> dict[str, Any]:
    """A run as JSON has it."""
    times = {name: None if at is None else at.isoformat() for name, at in (("at", run.at), ("ended_at", run.ended_at))}
    return {**asdict(run), **times}


def _asked(action: Action) -> dict[str, Any]:
    verb = action.verb.removeprefix("run.")
    return {"type": "action", "id": action.id, "verb": verb, "data": dict(action.data), "who": action.who}


def _entry_text(entry: Entry) -> str:
    said = {"type": "entry", "seq": entry.seq, "time_s": entry.time_s, "kind": entry.kind, "data": dict(entry.data)}
    line = line_of(entry.kind, entry.data)
    return json.dumps(said | {"line": line}, ensure_ascii=False, separators=(",", ":"))
