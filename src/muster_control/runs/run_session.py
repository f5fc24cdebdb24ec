"""The session of a run on the server: its runner, which is restarted after a crash, its log, state and subscribers."""

from __future__ import annotations

import asyncio
import base64
import json
import logging
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from muster.running.worlds import WORLDS
from muster.state.words import words_of
from muster_control.contract import OVER, Action, Checkpoint, Entry, Run, RunState, StoreError
from muster_control.runs.crash_history import CrashHistory
from muster_control.runs.log.journal import Journal
from muster_control.runs.log.journal_replay import TOO_LATE
from muster_control.runs.log.writer import LogWriter
from muster_control.runs.runner_input import RunnerInput
from muster_control.runs.runner_process import RunnerProcess
from muster_control.runs.subscribers import Subscribers
from muster_control.store.actions import id_at

if TYPE_CHECKING:
    from muster_control.store.store import Store

NOTED_S = 1.0
"""Seconds of the wall clock between two writes of the mission time while nothing happens."""
_AGAIN_S = 0.2
_TIME = re.compile(r'"time_s":([0-9.e+-]+)')

_log = logging.getLogger("muster.runs")


class RunSession:
    """The session of a run that is under way.

    Parameters
    ----------
    run
        as stored in the database.
    journal
        takes what the database cannot be told.
    lock
        a file that a runner of real robots locks, so that two runners never command them.
    memory_mb
        the memory of a runner of a simulated world.
    """

    def __init__(self, store: Store, run: Run, journal: Journal, lock: str, memory_mb: int) -> None:
        self._store, self.run, self._runner_input = store, run, RunnerInput(store, run, lock)
        self._memory_mb = memory_mb
        self._pending: dict[int, Action] = {}
        self.in_order = asyncio.Lock()  # held from the request of an action until the runner has it
        self._runner: RunnerProcess | None = None
        self._mission: Mapping[str, Any] | None = None
        self._noted_at = -NOTED_S
        self._closing = self._cancelled = self._reported = False
        self._failed = self._trouble = ""
        self._share = None if run.state == "starting" else 0.0  # of going on after a crash, while that lasts
        self._checkpoint: tuple[int, bytes] | None = None  # of an entry that is not written yet
        self._ended_at: datetime | None = None
        self._texts: dict[int, str] = {}
        self._tick: list[tuple[Mapping[str, Any], str]] = []  # entries of the tick that has not ended yet
        self.log_writer = LogWriter(
            store,
            run.id,
            journal,
            on_entries=self._on_written,
            on_actions=self._on_kept,
            on_trouble=self._on_trouble,
            on_lost=self._give_up,
        )
        self.subscribers = Subscribers(self._hello, self._read_texts)

    @property
    def over(self) -> bool:
        """Whether the run is over."""
        return self.run.state in OVER

    @property
    def shown(self) -> Run:
        """The run as users see it: also whether it is resuming."""
        if self._share is None or self.over:
            return self.run
        return replace(self.run, state="resuming", share=self._share)

    @property
    def pid(self) -> int | None:
        """The process id of the runner."""
        return None if self._runner is None else self._runner.pid

    async def go(self) -> None:
        """Carry the run to its end, or until `close`."""
        try:
            await self._go()
        except Exception as error:
            _log.exception("run %d", self.run.id)
            self._failed = f"an error of mission control: {type(error).__name__}: {error}"
        if not self._closing:
            await self.log_writer.given()
            self._finish()
        self.subscribers.end()
        if not self._closing:
            await self.log_writer.drained()
            self._runner_input.journal.unlink(missing_ok=True)
        await self.log_writer.close()

    def ask(self, action: Action) -> bool:
        """Pass a user's action to the runner; False if the run is over."""
        if self.over:
            return False
        self._pending[action.id] = action
        if self._runner is not None:
            self._runner.send(_order(action))
        return True

    async def close(self) -> None:
        """End the runner because the server ends; the run resumes at the next start."""
        self._closing = True
        self.log_writer.set(time_s=self.run.time_s)
        if self._runner is not None:
            await self._runner.end()
        if self.over:  # what cannot be written now is lost, except what the log tells
            await self.log_writer.close()

    async def _go(self) -> None:
        crashes = CrashHistory(real=self.run.world not in WORLDS)
        while not self._closing:
            begin = await self._begin_when_it_can_be_read()
            if begin is None:
                return
            self._runner = await RunnerProcess.start(f"run {self.run.id}", self._memory_mb)
            crashes.started()
            try:
                if self._closing:
                    return
                await self._supervise(self._runner, begin)
            finally:
                await self._runner.end()
            if self._reported or self._failed or self._closing:
                return
            await self.log_writer.given()
            if crashes.too_often(self.run.time_s, killed=self._runner.killed):
                words, at_s = self._runner.last_words or "without a word", f"{self.run.time_s:.1f} s"
                self._failed = f"its process ended {crashes.count} times in a row, at {at_s} of the mission: {words}"
                return
            await asyncio.sleep(_AGAIN_S)

    async def _supervise(self, runner: RunnerProcess, begin: bytes) -> None:
        """Start a runner's work, and handle its messages until it ends."""
        runner.send_line(begin)
        for action in self._pending.values():
            runner.send(_order(action))
        async for text in runner.messages():
            await self._handle(text)

    async def _begin_when_it_can_be_read(self) -> bytes | None:
        """As `_begin`, repeated while the database fails; None also if the server closes."""
        while not self._closing:
            try:
                return await self._begin()
            except StoreError as error:
                _log.warning("run %d: %s", self.run.id, error)
                await asyncio.sleep(_AGAIN_S)
        return None

    async def _begin(self) -> bytes | None:
        """The first line for the runner; None if the run is over by its log."""
        if not self._runner_input.known:
            unsettled = await asyncio.to_thread(self._store.actions.unsettled, self.run.id)
            await self._runner_input.read()
            self._restore(unsettled)
        self._texts.clear()
        self._tick.clear()
        if self._reported:
            return None
        if self._runner_input.goes_on:
            self._resume(0.0)
        return await asyncio.to_thread(self._runner_input.line, self.run, self._cancelled)

    def _resume(self, share: float) -> None:
        """Publish which share of going on is done."""
        self._share = share
        self._publish_run()

    def _restore(self, unsettled: Sequence[Action]) -> None:
        """Restore the state from checkpoint and log after a restart of the server; actions are settled or pending."""
        log, checkpoint = self._runner_input.log, self._runner_input.checkpoint
        self.run = replace(self.run, **({"resumed": 0} if checkpoint is None else checkpoint.facts))
        for entry in log:
            self._apply(entry)
        self.subscribers.seq = 0 if checkpoint is None else checkpoint.seq
        if log:
            self.subscribers.publish([(entry.seq, _entry_text(entry)) for entry in log[-100:]])
        applied = {entry.data["action"]: entry for entry in log if entry.kind == "command"}
        for action in unsettled:
            said = applied.get(action.id) or applied.get(-id_at(action.at))  # as logs of older Musters have it
            if said is None:
                self._pending.setdefault(action.id, action)
            else:
                self._write_outcome(action, said.data["outcome"], said.time_s)
        self._pending = {action.id: action for action in sorted(self._pending.values(), key=lambda action: action.at)}

    async def _handle(self, text: str) -> None:
        """Handle a message of the runner. Subscribers receive states and status unchanged."""
        for kind in ("states", "status"):
            if text.startswith(f'{{"type":"{kind}"'):
                self.subscribers.tell(kind, text)
                self._note_time(text)
                return
        said = json.loads(text)
        if said["type"] == "entry":
            self._tick.append((said, text))
        elif said["type"] == "tick":
            self._end_tick(said["bodies"])
            while self.log_writer.behind:
                await asyncio.sleep(0.05)
        elif said["type"] in ("checkpoint", "stretch"):
            self._take_state(said["type"], said)
        elif said["type"] == "mission":
            self._mission = said["mission"]
            self.subscribers.ready()
        elif said["type"] == "resuming" and self._share is not None:
            self._resume(said["share"])
        elif said["type"] == "going":
            self._share = None
            self._change(state="running" if self.run.state == "starting" else self.run.state)
        elif said["type"] == "failed":
            self._end_tick(self._runner_input.bodies)
            self._failed = said["reason"]

    def _end_tick(self, bodies: Mapping[str, Any] | None) -> None:
        """Add the entries of a tick, all at once; those of a tick that a crash cuts short never were."""
        entries = [self._entry(said, text) for said, text in self._tick]
        self._tick.clear()
        self._runner_input.bodies = bodies
        self.log_writer.add(entries, bodies)
        if self.log_writer.full and self._runner is not None:
            self._failed = f"its log could not be kept: {self._trouble}"
            self._runner.dismiss()

    def _take_state(self, kind: str, said: Mapping[str, Any]) -> None:
        """Take a checkpoint, or tracks."""
        if kind == "checkpoint":
            self._checkpoint = said["seq"], base64.b64decode(said["data"])
            self._keep_checkpoint()
        else:
            self._runner_input.tracked(said["until_s"])
            self.log_writer.add_stretch(said["from_s"], said["until_s"], base64.b64decode(said["data"]))

    def _note_time(self, text: str) -> None:
        """Store the mission time that subscribers have seen now and then: a resumed run continues from there."""
        self.run = replace(self.run, time_s=max(self.run.time_s, float(_TIME.search(text)[1])))  # type: ignore[index]
        now = asyncio.get_running_loop().time()
        if now >= self._noted_at + NOTED_S:
            self._noted_at = now
            self.log_writer.set(time_s=self.run.time_s)

    def _entry(self, said: Mapping[str, Any], text: str) -> Entry:
        """Return an entry of the log that the runner said, which its input has from now on, too."""
        seq, time_s = said["seq"], said["time_s"]
        entry = Entry(
            run=self.run.id, seq=seq, time_s=time_s, kind=said["kind"], data=said["data"], at=datetime.now(UTC)
        )
        self._texts[seq] = text
        self._reported |= entry.kind == "report"
        self._runner_input.add(entry)
        return entry

    def _on_written(self, entries: Sequence[Entry]) -> None:
        """Publish entries that are written, or cannot be."""
        for entry in entries:
            self._apply(entry)
        texts = [(entry.seq, self._texts.pop(entry.seq, "") or _entry_text(entry)) for entry in entries]
        self.subscribers.publish(texts)
        for entry in entries:
            if entry.kind == "command":
                self._settle(entry)
        self._keep_checkpoint()

    def _keep_checkpoint(self) -> None:
        """Keep a checkpoint once all entries before it are published, and their actions are settled."""
        if self._checkpoint is None or self._checkpoint[0] > self.subscribers.seq:
            return
        (seq, data), self._checkpoint = self._checkpoint, None
        facts = {key: getattr(self.run, key) for key in ("state", "speed", "resumed")}
        checkpoint = Checkpoint(run=self.run.id, seq=seq, data=data, facts=facts)
        self._runner_input.replace_log(checkpoint)
        self.log_writer.keep_checkpoint(checkpoint)

    def _apply(self, entry: Entry) -> None:
        """Apply an entry to the state of the run."""
        self.run = replace(self.run, time_s=max(self.run.time_s, entry.time_s))
        if entry.kind == "report":
            self._reported = True
            self._ended_at = entry.at
            self.run = replace(self.run, report=entry.data)
        elif entry.kind == "resumed":
            self._change(resumed=self.run.resumed + 1)
        elif entry.kind == "command" and entry.data["outcome"] == "done":
            self._apply_command(entry.data["verb"], entry.data["data"])

    def _apply_command(self, verb: str, data: Mapping[str, Any]) -> None:
        states: dict[str, RunState] = {"pause": "paused", "resume": "running"}
        if verb in states:
            self._change(state=states[verb])
        elif verb == "speed":
            self._change(speed=data["speed"])
        elif verb == "cancel":
            self._cancelled = True

    def _settle(self, entry: Entry) -> None:
        """Write the outcome of an action."""
        action = self._pending.pop(entry.data["action"], None)
        if action is not None:
            self._write_outcome(action, entry.data["outcome"], entry.time_s)

    def _write_outcome(self, action: Action, outcome: str, applied_s: float | None = None) -> None:
        self.log_writer.keep(replace(action, outcome=outcome, applied_s=applied_s))
        self.subscribers.publish_action({"id": action.id, "outcome": outcome, "kept": action.kept})

    def _on_kept(self, actions: Sequence[Action]) -> None:
        """Publish that the database has actions that only the journal had."""
        for action in actions:
            if action.id in self._pending:
                self._pending[action.id] = action.as_kept()
            if not action.kept and action.outcome:
                self.subscribers.publish_action({"id": action.id, "outcome": action.outcome, "kept": True})

    def _finish(self) -> None:
        state: RunState = "failed" if self._failed else "cancelled" if self._cancelled else "ended"
        for action in self._pending.values():
            self._write_outcome(action, TOO_LATE)
        self._pending.clear()
        self._share = None
        self._change(state=state, ended_at=self._ended_at or datetime.now(UTC))

    def _on_trouble(self, why: str) -> None:
        self._trouble = f"not all of this run is in the database yet: {why}" if why else ""
        self._change()

    def _give_up(self, why: str) -> None:
        """Give the run up, as another server carries it out: nothing of it is written here any more."""
        _log.error("run %d: given up: %s", self.run.id, why)
        self._closing = True
        self._trouble = f"given up here: {why}"
        self._change()
        if self._runner is not None:
            self._runner.dismiss()

    def _change(self, **fields: Any) -> None:
        """Change fields of the run, and its remark."""
        remark = "; ".join(part for part in (self._failed, self._trouble) if part)
        fields["remark"] = remark
        new = {key: value for key, value in fields.items() if getattr(self.run, key) != value}
        if new:
            self.run = replace(self.run, **new)
            kept = dict(new)
            if "remark" in kept:
                kept["remark"] = self._failed  # the rest of the remark is about what is not written
            self.log_writer.set(**kept)
        self._publish_run()

    def _publish_run(self) -> None:
        run = self.shown
        said = {key: getattr(run, key) for key in ("state", "speed", "time_s", "remark", "share")}
        self.subscribers.tell("run", json.dumps({"type": "run", **said}, ensure_ascii=False, separators=(",", ":")))

    def _hello(self) -> Mapping[str, Any]:
        return {"run": plain_run(self.shown), "mission": self._mission}

    async def _read_texts(self, after: int) -> list[tuple[int, str]]:
        return [(entry.seq, _entry_text(entry)) for entry in await self.log_writer.entries(after, 500)]


def plain_run(run: Run) -> dict[str, Any]:
    """A run as plain data."""
    times = {name: None if at is None else at.isoformat() for name, at in (("at", run.at), ("ended_at", run.ended_at))}
    return {**asdict(run), **times}


def _order(action: Action) -> dict[str, Any]:
    verb = action.verb.removeprefix("run.")
    return {"type": "action", "id": action.id, "verb": verb, "data": dict(action.data), "who": action.who}


def _entry_text(entry: Entry) -> str:
    said = {"type": "entry", "seq": entry.seq, "time_s": entry.time_s, "kind": entry.kind, "data": dict(entry.data)}
    return json.dumps(said | words_of(entry.kind, entry.data), ensure_ascii=False, separators=(",", ":"))
