"""Runs: plans carried out in simulated worlds or by real robots, watched, controlled, and resumed after a crash."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from muster.mission.errors import MusterError
from muster.running.robot_claims import claims_as_far_as_known, claims_of_request
from muster.running.run_request import RunRequest
from muster_control.contract import PAGE_ROWS, Action, BusyError, ConflictError, Entry, Run, StoreError, User
from muster_control.runs.log.journal import Journal
from muster_control.runs.log.journal_replay import TOO_LATE, replay
from muster_control.runs.run_session import RunSession
from muster_control.runs.run_settings import new_request, require_action
from muster_control.runs.subscribers import Subscribers
from muster_control.services.actions import Actions, Refused, ignore_refusal, outcome_of
from muster_control.services.database_lock import journal_of, lock_of_runs
from muster_control.services.repeated_requests import made_once
from muster_control.settings import Settings
from muster_control.store.actions import new_action
from muster_control.store.request_keys import RequestKey
from muster_control.work.temporary_folders import OF_RUNS, sweep

if TYPE_CHECKING:
    from muster_control.store.store import Store

PATIENCE_S = 0.7
"""Seconds that a command to a run waits for the database; after that the journal takes it."""

_ENDS_WITHIN_S = 30.0
"""Seconds within which a server ends that has lost the database to another one."""
_STOPS = ("run.pause", "run.cancel")

_log = logging.getLogger("muster.runs")


class Runs:
    """The runs of a database, and the sessions of those that are under way."""

    def __init__(self, store: Store, settings: Settings, refused: Refused = ignore_refusal) -> None:
        self._store, self._settings = store, settings
        self._actions = Actions(store, refused)
        self._lock = lock_of_runs(settings)
        self._sessions: dict[int, RunSession] = {}
        self._tasks: dict[int, asyncio.Task[None]] = {}
        self._beginning: list[frozenset[str]] = []  # robots of runs that are being started
        self._slow: set[asyncio.Task[object]] = set()
        self._journal_path = journal_of(settings)
        self._opened_journal: Journal | None = None

    async def start_up(self) -> None:
        """Fold the journal of the last server into the database, and resume the runs that it left unfinished.

        Raises
        ------
        StoreError
            if the journal cannot be opened, or the database not be used.
        """
        self._opened_journal = await asyncio.to_thread(Journal, self._journal_path, _ENDS_WITHIN_S)
        await asyncio.to_thread(replay, self._journal, self._store)
        await asyncio.to_thread(sweep, OF_RUNS)
        unfinished = await asyncio.to_thread(self._store.runs.unfinished)
        for k, run in enumerate(unfinished):
            later = next((other for other in unfinished[k + 1 :] if _claims(run) & _claims(other)), None)
            if later is None:
                self._open_session(run)
            else:  # it started after this run had ended, which could not be written
                await self._leave(run, f"run {later.id}, which began later, commands its robots")

    async def close(self) -> None:
        """End all runners; the runs resume when a server starts again. Real robots are stopped."""
        await asyncio.gather(*(session.close() for session in self._sessions.values()))
        await asyncio.gather(*self._tasks.values())
        await asyncio.gather(*self._slow, return_exceptions=True)
        journal, self._opened_journal = self._opened_journal, None
        if journal is not None:
            await journal.close()

    async def start(
        self,
        who: User,
        plan: int,
        world: str = "kinematic",
        speed: float | None = 1.0,
        settings: Mapping[str, Any] | None = None,
        *,
        request: RequestKey | None = None,
    ) -> Run:
        """Start to carry out a plan. A repeated request returns the run of the first.

        Raises
        ------
        ForbiddenError, NotFoundError, ParameterError
            if the user may only watch; there is no such plan; the world, speed or a setting is wrong.
        ConflictError
            if another run commands some of the robots (`claims_of`), the plan was cut short and that is not accepted,
            or another request had the key.
        BusyError
            if the most runs are under way.
        """
        start = partial(self._start, who, plan, world, speed, dict(settings or {}), request)
        return await made_once(self._store, request, start, self.get)

    async def _start(
        self,
        who: User,
        plan: int,
        world: str,
        speed: float | None,
        settings: Mapping[str, Any],
        request: RequestKey | None,
    ) -> Run:
        asked = {"plan": plan, "world": world, "speed": speed, "settings": settings}
        async with self._written_if_refused(who, "run.start", asked):
            asked_for, claims = await asyncio.to_thread(self._asked, world, speed, settings)
            speed = 1.0 if asked_for.is_real else asked_for.speed
            self._require_unclaimed(claims)
            if self.under_way + len(self._beginning) >= self._settings.runs:
                raise BusyError(f"{self.under_way} runs are under way; expected fewer than {self._settings.runs}")
            self._beginning.append(claims)
            try:
                run = await asyncio.to_thread(self._add, who, plan, world, speed, settings, request)
                return self._open_session(run).run
            finally:
                self._beginning.remove(claims)

    def _asked(self, world: str, speed: float | None, settings: Mapping[str, Any]) -> tuple[RunRequest, frozenset[str]]:
        """The request of a run, and the robots that it claims; this may load the package of a fleet."""
        request = new_request(world, self._settings.bridges, settings, speed)
        return request, claims_of_request(request)

    async def list(
        self, limit: int = PAGE_ROWS, before: int | None = None, mission: str | None = None
    ) -> Sequence[Run]:
        """Runs, of one mission or all, newest first; ids below `before`, if given."""
        runs = await asyncio.to_thread(self._store.runs.list, limit, before, mission)
        return [self._newest(run) for run in runs]

    def present(self) -> Sequence[Run]:
        """Runs under way, newest first, without asking the database."""
        return [
            self._sessions[run].shown for run in sorted(self._sessions, reverse=True) if not self._sessions[run].over
        ]

    async def over(
        self, limit: int = PAGE_ROWS, before: int | None = None, mission: str | None = None
    ) -> Sequence[Run]:
        """Runs that are over, as `list`, including those whose end is not written yet."""
        ended = {
            run: session.run
            for run, session in self._sessions.items()
            if session.over and (before is None or run < before) and mission in (None, session.run.mission)
        }
        kept = await asyncio.to_thread(partial(self._store.runs.list, limit, before, mission, over=True))
        found = {run.id: run for run in kept} | ended
        return [found[run] for run in sorted(found, reverse=True)[:limit]]

    async def get(self, run: int) -> Run:
        """A run as it is now.

        Raises
        ------
        NotFoundError
        """
        session = self._sessions.get(run)
        return session.shown if session is not None else await asyncio.to_thread(self._store.runs.get, run)

    async def act(self, who: User, run: int, verb: str, data: Mapping[str, Any] | None = None) -> Action:
        """Command a run: `pause`, `resume`, `speed` {speed}, `cancel`, `event` {one without at_s}, `orders` {orders}.

        Subscribers receive the outcome, and the action has it later. The action is written before the command takes
        effect: to the database, or if that fails or is slow to the journal, as robots may have to be stopped. Commands
        of one run take effect in the order in which they were given.

        Raises
        ------
        ForbiddenError, NotFoundError, ParameterError
        ConflictError
            if the run is over.
        StoreError
            if neither the database nor the journal can be written; `pause` and `cancel` take effect all the same.
        """
        async with self._written_if_refused(who, f"run.{verb}", {"run": run, "data": dict(data or {})}):
            said = require_action(verb, data or {})
            await self.require_under_way(run)
            session = self._sessions[run]
        # to its end also if the client leaves meanwhile: what is written is to be done now, not at the next start
        return await asyncio.shield(self._taken(new_action(who, f"run.{verb}", said, run), session))

    async def _taken(self, action: Action, session: RunSession) -> Action:
        """Write an action, and pass it to the runner; see `act`."""
        async with session.in_order:  # a lock is acquired in the order of the calls
            if await self._is_added(action, session):
                action = action.as_kept()
                asked = session.ask(action)
            else:
                saved = session.log_writer.save(action)  # further actions may follow before it is synced
        if not action.kept:
            await self._saved(saved, action, session)
            asked = session.ask(action)
        if not asked:
            late = replace(action, outcome=TOO_LATE)
            session.log_writer.keep(late)
            if await self._patiently(self._store.actions.keep, [late]) and session.run.id not in self._sessions:
                self._journal.release(session.run.id)  # the log's writer has ended with the run
            raise ConflictError(f"run {action.run} is over: {session.run.state}; expected one that is under way")
        return action

    async def require_under_way(self, run: int) -> None:
        """Raise NotFoundError or ConflictError unless a run is under way."""
        state = (await self.get(run)).state
        if run not in self._sessions or self._sessions[run].over:
            raise ConflictError(f"run {run} is over: {state}; expected one that is under way")

    async def entries(self, run: int, after: int = 0, limit: int | None = None) -> Sequence[Entry]:
        """The log of a run after an entry.

        Raises
        ------
        NotFoundError
        """
        session = self._sessions.get(run)
        if session is not None:
            return await session.log_writer.entries(after, limit)
        await asyncio.to_thread(self._store.runs.get, run)
        return await asyncio.to_thread(self._store.log.entries, run, after, limit)

    async def kept(self, run: int) -> None:
        """Wait until all of a run's log is in the database.

        Raises
        ------
        StoreError
            if it cannot be written.
        """
        session = self._sessions.get(run)
        if session is not None:
            await session.log_writer.given()
            if session.log_writer.trouble:
                raise StoreError(f"run {run} is not kept yet: {session.log_writer.trouble}")

    def subscribers(self, run: int) -> Subscribers | None:
        """What watchers of a run are told; None where it is not under way."""
        session = self._sessions.get(run)
        return None if session is None else session.subscribers

    def pid(self, run: int) -> int | None:
        """The process id of a run's runner; None if there is none."""
        session = self._sessions.get(run)
        return None if session is None else session.pid

    @property
    def under_way(self) -> int:
        """How many runs are under way."""
        return len(self.present())

    @property
    def watchers(self) -> int:
        """How many WebSockets and pages watch runs."""
        return sum(session.subscribers.watchers for session in self._sessions.values())

    @property
    def troubles(self) -> Sequence[str]:
        """Why logs of runs are not being written, one line per run."""
        live = tuple(self._sessions.items())
        return tuple(f"run {run}: {each.log_writer.trouble}" for run, each in live if each.log_writer.trouble)

    def statuses(self) -> Sequence[str]:
        """The newest `status` message of each run under way."""
        texts = (session.subscribers.newest("status") for session in tuple(self._sessions.values()))
        return tuple(text for text in texts if text)

    @asynccontextmanager
    async def _written_if_refused(self, who: User, verb: str, asked: Mapping[str, Any]) -> AsyncIterator[None]:
        """Write a refused action; the block writes its action itself if it succeeds.

        The user gets the reason also if the database fails or is slow.

        Raises
        ------
        ForbiddenError
            if the user may only watch.
        """
        self._actions.require_command(who, verb)
        try:
            yield
        except MusterError as error:
            with suppress(MusterError):  # `_written` logs it
                await self._patiently(self._store.actions.add, who, verb, asked, None, outcome_of(error))
            raise

    def _require_unclaimed(self, claims: frozenset[str]) -> None:
        """Raise ConflictError if another run commands some of these robots, or starts to."""
        others = [(f"run {run}", _claims(each.run)) for run, each in self._sessions.items() if not each.over]
        for whose, theirs in [*others, *(("another run", theirs) for theirs in self._beginning)]:
            if both := claims & theirs:
                what = ", ".join(sorted(both))
                raise ConflictError(f"{whose} commands robots on {what}; expected others, or that it is over")

    def _add(
        self,
        who: User,
        plan: int,
        world: str,
        speed: float | None,
        settings: Mapping[str, Any],
        request: RequestKey | None,
    ) -> Run:
        entry = self._store.plans.get(plan)
        if entry.plan.get("cut_short") and not settings.get("accept_partial"):
            raise ConflictError(f"plan {plan}: planning was cut short; expected a whole plan, or accept_partial: true")
        return self._store.runs.add(
            entry.mission,
            entry.mission_version,
            plan,
            world,
            settings,
            speed,
            who.name,
            by=who,
            request=request,
        )

    def _open_session(self, run: Run) -> RunSession:
        session = self._sessions[run.id] = RunSession(
            self._store, run, self._journal, str(self._lock), self._settings.memory_mb
        )
        task = self._tasks[run.id] = asyncio.create_task(session.go())
        task.add_done_callback(lambda _: self._forget(run.id))
        return session

    async def _leave(self, run: Run, why: str) -> None:
        """Give a run up instead of resuming it."""
        _log.warning("run %d: not gone on with: %s", run.id, why)
        with suppress(StoreError):  # the next start tries again
            await asyncio.to_thread(self._store.runs.set, run.id, state="failed", remark=why)

    def _forget(self, run: int) -> None:
        self._sessions.pop(run, None)
        self._tasks.pop(run, None)

    def _newest(self, run: Run) -> Run:
        session = self._sessions.get(run.id)
        return run if session is None else session.shown

    @property
    def _journal(self) -> Journal:
        if self._opened_journal is None:
            self._opened_journal = Journal(self._journal_path)
        return self._opened_journal

    async def _is_added(self, action: Action, session: RunSession) -> bool:
        """Write an action to the database; returns False if that fails or is slow."""
        if session.log_writer.trouble or self._slow:
            return False
        await self._journal.flushed()  # which has those that were asked for before
        return await self._patiently(self._store.actions.keep, [action])

    async def _saved(self, saved: asyncio.Future[None], action: Action, session: RunSession) -> None:
        """Wait until the journal has an action.

        Raises
        ------
        StoreError
            if it cannot be written. What stops robots is done all the same.
        """
        try:
            await saved
        except StoreError as error:
            why = f"neither the database nor the journal takes it: {error}"
            if action.verb in _STOPS and session.ask(action):
                raise StoreError(f"{why}; it takes effect, and is lost if the server ends") from None
            session.log_writer.keep(replace(action, outcome=f"refused: {why}"))
            raise StoreError(f"{why}; refused") from None

    async def _patiently(self, write: Callable[..., object], *what: Any) -> bool:
        """Write an action; False if the database fails, or takes longer than PATIENCE_S and goes on writing."""
        writing = asyncio.create_task(asyncio.to_thread(write, *what))
        writing.add_done_callback(self._written)
        done, _ = await asyncio.wait([writing], timeout=PATIENCE_S)
        if not done:
            self._slow.add(writing)
            return False
        try:
            writing.result()
        except StoreError:
            return False
        return True

    def _written(self, writing: asyncio.Task[object]) -> None:
        self._slow.discard(writing)
        if not writing.cancelled() and (error := writing.exception()) is not None:
            _log.warning("an action was not written down: %s", error)


def _claims(run: Run) -> frozenset[str]:
    return claims_as_far_as_known(run.world, run.settings)
