"""A plan carried out by real robots from where they stand; after a crash, the rest of it. Or they are brought home."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from muster.execution import Recorder, Report, broken_off
from muster.execution.final_state import final_states_of
from muster.execution.fleet import Fleet
from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.mission.system.clock import Clock
from muster.running.bring_home import bring_home, without_tasks
from muster.running.fleet_clock import BeforeOrderAt
from muster.running.journal import final_states_event
from muster.running.live import Live, elsewhere, with_reported_starts
from muster.running.run_request import OPEN_FLEET, RunRequest
from muster.state import MissionState
from muster.state.robot_events import Elsewhere

_BUSY = "robots are brought home"
LOOK_S = 0.1
"""Seconds between two looks at the robots, where nothing is heard before."""


class RealRun(Live):
    """A run that `RunLoop` carries to its end.

    Parameters
    ----------
    request
        how the plan is carried out; by default as `RunRequest` says. A run that resumes keeps its start.
    state
        what is known of a run that goes on after a crash.
    wall
        the wall clock; see `Live`.
    at_end
        called when all tasks are done.
    before_order
        see `Live`.
    """

    real = True

    def __init__(
        self,
        mission: Mission,
        plan: Plan,
        fleet: Fleet,
        recorder: Recorder,
        *,
        request: RunRequest | None = None,
        state: MissionState | None = None,
        wall: Clock | None = None,
        at_end: Callable[[], None] = lambda: None,
        before_order: BeforeOrderAt | None = None,
    ) -> None:
        there = with_reported_starts(mission, fleet) if state is None else mission
        request = replace(request or RunRequest(world=OPEN_FLEET), ignore=plan.ignored)
        super().__init__(
            there, plan, fleet, request, recorder=recorder, state=state, wall=wall, before_order=before_order
        )
        self._at_end, self._paused = at_end, False
        for line in elsewhere(mission, there) if state is None else ():
            self.executor.emit(Elsewhere(what=line))

    @property
    def starts_at(self) -> str | None:
        """The start of the mission as its file has it, moved to when it began."""
        return self.start.mission.starts_at

    @property
    def next_s(self) -> float:
        return self.time_s

    def go_on(self) -> None:
        """Receive telemetry for a while, and send robots on unless the run is paused."""
        self.hear(self.time_s + LOOK_S)
        if self._paused:
            self.tell_places()
            return
        self.look()
        if self.done:
            self.stop()
            self._at_end()
            self._tell_final_states()
            self.tell_report(self.result())

    def report(self, event: Event) -> None:
        self.executor.come_to(self.time_s)
        self.executor.report(event)

    def replan(self) -> None:
        """Nothing: the rest is planned again at the next look at the robots."""

    def break_off(self, reason: str) -> Report:
        self.stop()
        self._tell_final_states()
        return self.tell_report(broken_off(self.result(), self.executor.account, reason))

    def _tell_final_states(self) -> None:
        """Log where each robot is at the end, what it does, and whether it still flies, drives or is armed."""
        self.executor.emit(final_states_event(final_states_of(self._robots, self.start.mission)))

    def pause(self) -> None:
        super().pause()
        self._paused = True

    def resume(self) -> None:
        super().resume()
        self._paused = False

    def snapshot(self) -> None:
        """Nothing: robots say themselves where they are."""

    def close(self) -> None:
        """Stop the robots, whatever ended the run."""
        try:
            self.stop()
        finally:
            self._robots.close()


class RecoveryRun(RealRun):
    """A run that brings robots home, whatever run they were in before, and does no task.

    They are brought home in a thread, so that users see them, and may cancel that: then robots stay where they are.
    """

    def __init__(self, mission: Mission, plan: Plan, fleet: Fleet, recorder: Recorder, **how: Any) -> None:
        state, wall = how.pop("state", None), how.get("wall")
        super().__init__(mission, plan, fleet, recorder, state=state or MissionState(mission, plan.ignored), **how)
        ending = getattr(how["request"].settings, "at_end", "hold")
        self._mission, self._halt, self._over = mission, threading.Event(), False
        self._lost: Mapping[str, str] = {}
        self._failed: Exception | None = None

        def bring() -> None:
            try:
                self._lost = bring_home(mission, fleet, self._halt, at_end=ending, wall=wall)
            except Exception as error:  # raised again by the thread of the run
                self._failed = error

        self._thread = threading.Thread(target=bring)

    @property
    def done(self) -> bool:
        """Whether robots are home, or stay where they are."""
        return self._over

    def go_on(self) -> None:
        """See how far robots are."""
        if self._thread.ident is None:
            self._thread.start()
        self._thread.join(LOOK_S)
        self.executor.set_clock(self.time_s)
        self.tell_places()
        if not self._thread.is_alive():
            self._end()

    def report(self, event: Event) -> None:
        raise ParameterError(f"{_BUSY}; expected a run of a plan")

    def pause(self) -> None:
        raise ParameterError(f"{_BUSY}; expected cancel: then robots stay where they are")

    def break_off(self, reason: str) -> Report:
        self._halt.set()
        if self._thread.ident is not None:
            self._thread.join()
        self.stop()
        return self._end()

    def close(self) -> None:
        """Stop the robots, whatever ended the run."""
        self._halt.set()
        if self._thread.ident is not None:
            self._thread.join()
        super().close()

    def _end(self) -> Report:
        if self._failed is not None:
            raise self._failed
        self._over = True
        if not hasattr(self._robots, "recover"):
            self._at_end()
        for robot, why in self._lost.items():
            self.executor.emit(Elsewhere(what=f"{robot} is not home: {why}"))
        self._tell_final_states()
        return self.tell_report(without_tasks(self.result(), self._mission, ()))
