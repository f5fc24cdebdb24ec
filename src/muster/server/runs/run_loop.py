"""A run as its process leads it: it goes on by the wall clock, obeys at once, and tells what happens."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from muster.execution import Report, RobotStatus, Status
from muster.mission.clock import Clock, SystemClock
from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import Event
from muster.server.runs.log_recorder import RESUMED, DivergedError, Scribe
from muster.server.runs.pacing import Pace
from muster.server.runs.pipe import Inbox, Outbox
from muster.server.runs.user_events import event_given

STATES_S, STATUS_S, SHARE_S = 0.095, 0.5, 0.5
"""Seconds of the wall clock between two tellings of where robots are, what they do, how far a crash is made good."""
HEAR_S = 0.05
STEPS_FIRST_S = 0.5
"""After orders time goes on for so many seconds of the wall clock, if it is behind its pace, before more are heard."""
CANCELLED = "not done when the run was cancelled"


class Course(Protocol):
    """What is carried out: in a simulated world, or by real robots."""

    real: bool

    @property
    def time_s(self) -> float: ...
    @property
    def next_s(self) -> float: ...
    @property
    def done(self) -> bool: ...
    @property
    def status(self) -> Status: ...
    def go_on(self) -> None: ...
    def report(self, event: Event) -> None: ...
    def replan(self) -> None: ...
    def break_off(self, reason: str) -> Report: ...
    def pause(self) -> None: ...
    def resume(self) -> None: ...
    def close(self) -> None: ...


class Performance:
    """Carries a course to its end.

    Parameters
    ----------
    course, scribe
        what is carried out, and who writes it down.
    inbox, outbox
        of the server.
    speed
        times real time; None: as fast as it goes.
    ended
        whether the server is gone.
    """

    def __init__(
        self,
        course: Course,
        scribe: Scribe,
        inbox: Inbox,
        outbox: Outbox,
        *,
        speed: float | None,
        ended: Callable[[], bool],
        clock: Clock | None = None,
    ) -> None:
        self._course, self._scribe, self._inbox, self._outbox = course, scribe, inbox, outbox
        self._clock, self._ended = clock or SystemClock(), ended
        self._pace = Pace(self._clock, speed, course.time_s)
        self._paused = self._cancelled = self._must_replan = False
        self._steps_until = -1e9
        self._obeyed: set[int] = set()
        self._told: Mapping[str, Any] | None = None
        self._states_at = self._status_at = self._share_at = -1e9

    def catch_up(self, log: Sequence[Mapping[str, Any]], until_s: float) -> None:
        """Make good a crash: what the log says comes about once more, up to a time of the mission's clock.

        Raises
        ------
        DivergedError
            if it does not come about as the log says.
        """
        for entry in log:
            if entry["kind"] == "command":
                self._go_to(entry["time_s"], until_s)
                self._obey(_asked(entry["data"]), more=entry["data"].get("more", False))
        self._go_to(until_s, until_s)
        if self._scribe.catching_up:
            raise DivergedError("simulated again, it ends before the log does")
        if log and not self._over:  # a report is the last entry
            self._scribe.write(self._course.time_s, RESUMED, {"how": "simulated again up to here"})

    def recall(self, log: Sequence[Mapping[str, Any]]) -> None:
        """What users asked for before a crash, where nothing is simulated again."""
        for entry in log:
            if entry["kind"] == "command":
                self._obeyed.add(entry["data"]["action"])
                if entry["data"]["outcome"] == "done":
                    self._recall(entry["data"]["verb"])
        if self._cancelled:  # the log has no report, or nobody would go on
            self._course.break_off(CANCELLED)
        elif self._paused:
            self._course.pause()

    def _recall(self, verb: str) -> None:
        if verb in ("pause", "resume"):
            self._paused = verb == "pause"
        self._cancelled = self._cancelled or verb == "cancel"

    def perform(self) -> None:
        """Go on until it is over, or the server is gone."""
        self._pace.set(self._pace.speed, self._course.time_s)
        self._tell(at_once=True)
        while not self._over and not self._ended():
            orders = self._waiting_orders()
            if orders:
                self._obey_all(orders)
            elif self._outbox.full and not self._course.real:
                time.sleep(HEAR_S)
            elif self._course.real or not (self._paused or self._pace.wait_s(self._course.next_s) > 0):
                self._course.go_on()
                self._tell()
        self._tell(at_once=True)

    @property
    def _over(self) -> bool:
        return self._cancelled or self._course.done

    @property
    def _wait_s(self) -> float | None:
        """For how long to listen before time goes on; None: as long as it takes."""
        if self._course.real:
            return 0.0  # robots are heard meanwhile, which takes its time
        return None if self._paused else self._pace.wait_s(self._course.next_s)

    def _waiting_orders(self) -> list[Mapping[str, Any]]:
        """All that users have asked for by now, waited for until time goes on.

        After orders time goes on first, for a while: planning for them may have taken longer than the pace allows.
        """
        wait_s = self._wait_s
        if wait_s == 0 and self._clock.now() < self._steps_until and not self._course.real:
            return []
        orders, order = [], self._inbox.take(wait_s)
        while order is not None:
            orders.append(order)
            order = self._inbox.take(0.0)
        return [order for order in orders if order["id"] not in self._obeyed]

    def _obey_all(self, orders: Sequence[Mapping[str, Any]]) -> None:
        """Do what users asked for, in order; the rest is planned again once for all of it."""
        for order, *later in (orders[k:] for k in range(len(orders))):
            self._obey(order, more=bool(later))
        self._steps_until = self._clock.now() + STEPS_FIRST_S
        self._tell(at_once=True)

    def _go_to(self, time_s: float, until_s: float) -> None:
        while not self._over and self._course.time_s < time_s - 1e-9:
            self._course.go_on()
            if self._clock.now() - self._share_at >= SHARE_S:
                self._share_at = self._clock.now()
                self._outbox.say({"type": "resuming", "share": round(self._course.time_s / max(until_s, 1e-9), 3)})

    def _obey(self, asked: Mapping[str, Any], *, more: bool) -> None:
        """Do what a user asked for; the log has it before what follows from it.

        Parameters
        ----------
        more
            whether the rest is planned again only after what is asked for next; the log keeps that, for crashes.
        """
        if asked["id"] in self._obeyed or self._over:
            return
        self._obeyed.add(asked["id"])
        self._scribe.hold()
        try:
            self._do(asked["verb"], asked["data"])
            outcome = "done"
        except MusterError as error:
            outcome = str(error)
        said = {"action": asked["id"], "verb": asked["verb"], "data": asked["data"], "who": asked["who"]}
        said |= {"outcome": outcome} | ({"more": True} if more else {})
        self._scribe.write_first(self._course.time_s, "command", said)
        if self._must_replan and not more and not self._over:
            self._must_replan = False
            self._course.replan()

    def _do(self, verb: str, data: Mapping[str, Any]) -> None:
        if verb == "pause":
            self._require(not self._paused, "the run is paused already")
            self._paused = True
            self._course.pause()
        elif verb == "resume":
            self._require(self._paused, "the run is not paused")
            self._paused = False
            self._course.resume()
            self._pace.set(self._pace.speed, self._course.time_s)
        elif verb == "speed":
            self._require(not self._course.real, "real robots have their own speed")
            self._pace.set(data["speed"], self._course.time_s)
        elif verb == "cancel":
            self._cancelled = True
            self._course.break_off(CANCELLED)
        else:
            self._course.report(event_given(data, self._course.time_s))
            self._must_replan = True

    def _require(self, holds: bool, otherwise: str) -> None:
        if not holds:
            raise ParameterError(otherwise)

    def _tell(self, *, at_once: bool = False) -> None:
        """Where robots are and what they do, now and then."""
        now = self._clock.now()
        if (at_once or now - self._states_at >= STATES_S) and not self._scribe.catching_up:
            self._states_at = now
            robots = {name: _state(row) for name, row in self._scribe.rows.items()}
            said = {"type": "states", "time_s": round(self._course.time_s, 3), "sent_at": round(time.time(), 4)}
            self._outbox.say_if_room(said | {"robots": robots})
        if (at_once or now - self._status_at >= STATUS_S) and not self._scribe.catching_up:
            self._status_at = now
            status = _status(self._course.status)
            if status != self._told:
                self._told = status
                self._outbox.say({"type": "status", "time_s": round(self._course.time_s, 3), **status})


def _asked(command: Mapping[str, Any]) -> dict[str, Any]:
    """What was asked for, by its entry in the log."""
    return {"id": command["action"], "verb": command["verb"], "data": command["data"], "who": command["who"]}


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
        "route": list(robot.route),
        "used": round(robot.used, 3),
        "usage_left": None if left is None else round(left, 3),
        "charge": None if robot.charge is None else round(robot.charge, 3),
        "available": robot.available,
    }
