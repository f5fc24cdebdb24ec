"""Handles of a job and of a run on a server: progress, result, control."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from muster.mission.errors import MusterError
from muster.mission.model import Task
from muster.mission.yaml_writer import plain
from muster_control.client.connection import Connection
from muster_control.client.reading import read
from muster_control.client.server_plan import ServerPlan
from muster_control.contract import JOB_OVER, OVER, Action, Entry, Job, Run

if TYPE_CHECKING:
    from muster.execution import Report

_FIRST_LOOK_S, _LONGEST_LOOK_S = 0.02, 0.5


Seen = TypeVar("Seen", Job, Run)


class Handle(Generic[Seen]):
    """A job or a run at a server; `seen` is its last known state."""

    seen: Seen
    _kind: type[Seen]
    _at: ClassVar[str]
    _over: ClassVar[tuple[str, ...]]

    def __init__(self, connection: Connection, seen: Seen) -> None:
        self._connection = connection
        self.seen = seen

    @property
    def id(self) -> int:
        return self.seen.id

    @property
    def over(self) -> bool:
        """Whether it has ended."""
        return self.seen.state in self._over

    def look(self) -> Seen:
        """Ask the server for its state."""
        return self._note(self._connection.get(f"{self._at}/{self.id}"))

    def _note(self, data: Any) -> Seen:
        self.seen = read(self._kind, data)
        return self.seen


class RunningJob(Handle[Job]):
    """A job at a server; `seen` is its last known state."""

    _kind = Job
    _at, _over = "/jobs", JOB_OVER

    def wait(
        self,
        on_progress: Callable[[Mapping[str, Any]], None] | None = None,
        on_look: Callable[[], None] | None = None,
    ) -> ServerPlan:
        """Wait for the plan.

        Parameters
        ----------
        on_progress
            is called with the job's progress whenever there is a newer one.
        on_look
            is called before each look at the job, at least twice a second; it may stop or cancel the job.

        Raises
        ------
        MusterError
            if the job fails, or is cancelled.
        """
        shown, pause_s = None, _FIRST_LOOK_S
        while not self.over:
            if on_look is not None:
                on_look()
            time.sleep(pause_s)
            pause_s = min(1.5 * pause_s, _LONGEST_LOOK_S)
            progress = self.look().progress
            if on_progress is not None and progress is not None and progress != shown:
                on_progress(progress)
                shown = progress
        if self.seen.state != "done" or self.seen.result is None:
            raise MusterError(self.seen.error or f"job {self.id} was {self.seen.state}")
        return ServerPlan.of(self._connection.get(f"/plans/{self.seen.result['plan']}"))

    def stream(self) -> Iterator[Job]:
        """Yield each change of state until it has ended."""
        for message in self._connection.stream(f"/jobs/{self.id}/stream"):
            yield self._note(message)

    def stop(self) -> Job:
        """End planning with the best plan so far; a job that has not begun is cancelled."""
        return self._note(self._connection.post(f"/jobs/{self.id}/stop", {}))

    def cancel(self) -> Job:
        """Cancel it; there is no plan then."""
        return self._note(self._connection.delete(f"/jobs/{self.id}"))


class RunningRun(Handle[Run]):
    """A run at a server; `seen` is its last known state."""

    _kind = Run
    _at, _over = "/runs", OVER

    def wait(self) -> Run:
        """Wait for its end; returns its last state."""
        pause_s = _FIRST_LOOK_S
        while self.look().state not in OVER:
            time.sleep(pause_s)
            pause_s = min(1.5 * pause_s, _LONGEST_LOOK_S)
        return self.seen

    def stream(self, after: int = 0) -> Iterator[dict[str, Any]]:
        """Yield its messages (docs/mission-control-api.md); of the log those with a greater `seq` than `after`."""
        yield from self._connection.stream(f"/runs/{self.id}/stream", after=after)

    def events(self, after: int = 0) -> Iterator[Entry]:
        """Yield the entries of its log so far."""
        for entry in self._connection.pages(f"/runs/{self.id}/events", after=after):
            yield read(Entry, entry)

    def act(self, verb: str, **data: Any) -> Action:
        """Send a command: pause, resume, speed, cancel, event, orders."""
        return read(Action, self._connection.post(f"/runs/{self.id}/actions", {"verb": verb, "data": data}))

    def order(self, *tasks: Task, cancel: Iterable[str] = ()) -> Action:
        """Order tasks, and cancel others; they are planned for together. `events` tells the outcome."""
        orders = [{"new_task": plain(task)} for task in tasks] + [{"cancel_task": task} for task in cancel]
        return read(Action, self._connection.post(f"/runs/{self.id}/orders", {"orders": orders}))

    def pause(self) -> Action:
        return self.act("pause")

    def resume(self) -> Action:
        return self.act("resume")

    def cancel(self) -> Action:
        return self.act("cancel")

    def report(self) -> Report:
        """The report of the run; `as_dict()` is what `muster simulate --format json` prints.

        Raises
        ------
        ConflictError
            if the run has not ended.
        """
        return report_from(self._connection.get(f"/runs/{self.id}/report"))


def report_from(data: Mapping[str, Any]) -> Report:
    """The report of a run in plain data."""
    from muster.execution import Report

    lost = [(item["task"], item["reason"]) for item in data["tasks_lost"]]
    return read(Report, {**data, "tasks_lost": lost})
