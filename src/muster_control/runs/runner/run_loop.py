"""The loop of a runner: advances the run by the wall clock, executes commands at once, and sends what happens."""

from __future__ import annotations

import base64
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from muster.execution import RobotStatus, Status
from muster.mission.errors import MusterError, ParameterError
from muster.mission.system.clock import Clock, SystemClock
from muster.state import checkpoint_of
from muster_control.runs.log.checkpoints import Schedule, packed_state
from muster_control.runs.runner.log_recorder import LogRecorder
from muster_control.runs.runner.pacing import Pace
from muster_control.runs.runner.pipe import Inbox, Outbox
from muster_control.runs.runner.user_events import event_given

if TYPE_CHECKING:
    from muster_control.runs.runner.local_journal import LocalJournal
    from muster_control.runs.runner.real_run import RealRun
    from muster_control.runs.runner.simulated_run import SimulatedRun

STATES_S, STATUS_S = 0.095, 0.5
"""Seconds of the wall clock between two tellings of where robots are, and what they do."""
HEAR_S = 0.05
STEPS_FIRST_S = 0.5
"""After orders time goes on for so many seconds of the wall clock, if it is behind its pace, before more are heard."""
CANCELLED = "not done when the run was cancelled"


class RunLoop:
    """Carries a run to its end.

    Parameters
    ----------
    world_run, recorder
        the run in its world, simulated or with real robots, and the recorder of its log.
    inbox, outbox
        messages from and to the server.
    speed
        times real time; None: as fast as possible.
    starts_at
        when the mission starts, from which clock times in events are counted; None: it does not say so.
    ended
        tells whether the server is gone.
    paused, cancelled
        whether users had paused or cancelled the run when it was interrupted.
    checkpoint
        the entry of the last checkpoint, 0 for none.
    obeyed
        the actions that were executed before, by a log that the server did not have.
    """

    def __init__(
        self,
        world_run: SimulatedRun | RealRun,
        recorder: LogRecorder,
        inbox: Inbox,
        outbox: Outbox | LocalJournal,
        *,
        speed: float | None,
        starts_at: str | None,
        ended: Callable[[], bool],
        paused: bool = False,
        cancelled: bool = False,
        checkpoint: int = 0,
        obeyed: Collection[int] = (),
        clock: Clock | None = None,
    ) -> None:
        self._world_run, self._recorder, self._inbox, self._outbox = world_run, recorder, inbox, outbox
        recorder.state = world_run.state
        self._clock, self._ended, self._starts_at = clock or SystemClock(), ended, starts_at
        self._pace = Pace(self._clock, speed, world_run.time_s)
        self._paused, self._cancelled, self._must_replan = paused, cancelled, False
        self._schedule, self._kept = Schedule(self._clock, checkpoint), (-1, -1.0)
        self._steps_until = -1e9
        self._obeyed = set(obeyed)
        self._told: Mapping[str, Any] | None = None
        self._states_at = self._status_at = -1e9

    def run(self) -> None:
        """Advance until the run is over, or the server is gone."""
        self._pace.set(self._pace.speed, self._world_run.time_s)
        if self._cancelled:  # the log has no report, or the run would not be resumed
            self._world_run.break_off(CANCELLED)
        elif self._paused:
            self._world_run.pause()
        self._keep()
        self._tell(at_once=True)
        while not self._over and not self._ended():
            orders = self._waiting_orders()
            if orders:
                self._obey_all(orders)
            elif self._outbox.full and not self._world_run.real:
                time.sleep(HEAR_S)
            elif self._world_run.real or not (self._paused or self._pace.wait_s(self._world_run.next_s) > 0):
                self._world_run.go_on()
                self._keep()
                self._tell()
        self._keep()
        self._tell(at_once=True)

    @property
    def _over(self) -> bool:
        return self._cancelled or self._world_run.done

    @property
    def _wait_s(self) -> float | None:
        """Seconds to wait for a command before time goes on; None: until one comes."""
        if self._world_run.real:
            return 0.0  # receiving telemetry takes time
        return None if self._paused else self._pace.wait_s(self._world_run.next_s)

    def _waiting_orders(self) -> list[Mapping[str, Any]]:
        """The commands that wait, or arrive before time goes on.

        After commands time goes on first for a while: planning for them may have taken longer than the pace allows.
        """
        wait_s = self._wait_s
        if wait_s == 0 and self._clock.now() < self._steps_until and not self._world_run.real:
            return []
        orders, order = [], self._inbox.take(wait_s)
        while order is not None:
            orders.append(order)
            order = self._inbox.take(0.0)
        return orders

    def _obey_all(self, orders: Sequence[Mapping[str, Any]]) -> None:
        """Execute commands in order, then plan the rest once for all of them."""
        for order in orders:
            if order["id"] not in self._obeyed and not self._over:
                self._obey(order)
        if self._must_replan and not self._over:
            self._must_replan = False
            self._world_run.replan()
        self._steps_until = self._clock.now() + STEPS_FIRST_S
        self._keep()
        self._tell(at_once=True)

    def _obey(self, asked: Mapping[str, Any]) -> None:
        """Execute a command; its log entry comes before those of its consequences."""
        self._obeyed.add(asked["id"])
        self._recorder.hold()
        try:
            self._do(asked["verb"], asked["data"])
            outcome = "done"
        except MusterError as error:
            outcome = str(error)
        said = {"action": asked["id"], "verb": asked["verb"], "data": asked["data"], "who": asked["who"]}
        self._recorder.write_first(self._world_run.time_s, "command", said | {"outcome": outcome})

    def _keep(self) -> None:
        """End a tick: say where bodies are after its entries and tracks, and send a checkpoint if one is due.

        The server takes the entries of a tick all or none: a command with what follows from it.
        """
        seq = self._recorder.seq
        if self._kept != (seq, self._recorder.tracked_s):
            self._kept = seq, self._recorder.tracked_s
            bodies = self._world_run.snapshot()
            self._outbox.send({"type": "tick", "bodies": None if bodies is None else {**bodies, "seq": seq}})
        if self._schedule.take(seq):
            data = base64.b64encode(packed_state(checkpoint_of(self._recorder.state))).decode()
            self._outbox.send({"type": "checkpoint", "seq": seq, "data": data})

    def _do(self, verb: str, data: Mapping[str, Any]) -> None:
        if verb == "pause":
            self._require(not self._paused, "the run is paused already")
            self._world_run.pause()
            self._paused = True
        elif verb == "resume":
            self._require(self._paused, "the run is not paused")
            self._paused = False
            self._world_run.resume()
            self._pace.set(self._pace.speed, self._world_run.time_s)
        elif verb == "speed":
            self._require(not self._world_run.real, "real robots have their own speed")
            self._pace.set(data["speed"], self._world_run.time_s)
        elif verb == "cancel":
            self._cancelled = True
            self._world_run.break_off(CANCELLED)
        else:
            self._report(data["orders"] if verb == "orders" else [data])

    def _report(self, events: Sequence[Mapping[str, Any]]) -> None:
        """Let events happen now; what does not fit is left out.

        Raises
        ------
        ParameterError
            if any does not fit: how many of several, and why the first.
        """
        refused: list[str] = []
        for event in events:
            try:
                self._world_run.report(event_given(event, self._world_run.time_s, self._starts_at))
                self._must_replan = True
            except ParameterError as error:
                refused.append(str(error))
        if refused:
            raise ParameterError(refused[0] if len(events) == 1 else f"{len(refused)} refused, the first: {refused[0]}")

    def _require(self, holds: bool, otherwise: str) -> None:
        if not holds:
            raise ParameterError(otherwise)

    def _tell(self, *, at_once: bool = False) -> None:
        """Send states and status at their intervals."""
        now = self._clock.now()
        if at_once or now - self._states_at >= STATES_S:
            self._states_at = now
            robots = {name: _state(row) for name, row in self._recorder.rows.items()}
            said = {"type": "states", "time_s": round(self._world_run.time_s, 3), "sent_at": round(time.time(), 4)}
            self._outbox.send_if_room(said | {"robots": robots})
        if at_once or now - self._status_at >= STATUS_S:
            self._status_at = now
            status = _status(self._world_run.status)
            if status != self._told:
                self._told = status
                self._outbox.send({"type": "status", "time_s": round(self._world_run.time_s, 3), **status})


def _state(row: Sequence[float]) -> list[float]:
    x, y, z, heading, *velocity = row
    return [round(value, 4) for value in (x, y, z, heading, sum(v * v for v in velocity) ** 0.5)]


def _status(status: Status) -> dict[str, Any]:
    return {"robots": {name: _robot(robot) for name, robot in status.robots.items()}, "tasks": dict(status.tasks)}


def _robot(robot: RobotStatus) -> dict[str, Any]:
    left = robot.usage_left
    return {
        "activity": robot.activity,
        "out": robot.out,
        "task": robot.task,
        "waits_for": list(robot.waits_for),
        "waits": robot.waits,
        "team": list(robot.team),
        "route": list(robot.route),
        "used": round(robot.used, 3),
        "usage_left": None if left is None else round(left, 3),
        "charge": None if robot.charge is None else round(robot.charge, 3),
        "available": robot.available,
        "held_up_by": robot.held_up_by,
        "station": robot.station,
        "on_board": dict(robot.on_board),
    }
