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
        called when all tasks are done, in a thread, so that users see robots, and may cancel what they do at last.
    halt
        ends waiting of `at_end`: set where the run is broken off.
    before_order
        see `Live`.
    """

    real = True
    _busy = "all tasks are done, and robots do what they do at the end"

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
        halt: threading.Event | None = None,
        before_order: BeforeOrderAt | None = None,
    ) -> None:
        there = with_reported_starts(mission, fleet) if state is None else mission
        request = replace(request or RunRequest(world=OPEN_FLEET), ignore=plan.ignored)
        super().__init__(
            there, plan, fleet, request, recorder=recorder, state=state, wall=wall, before_order=before_order
        )
        self._at_end, self._paused, self._over = at_end, False, False
        self._halt = threading.Event() if halt is None else halt
        self._last: threading.Thread | None = None  # what robots do without the plan
        self._failed: Exception | None = None
        for line in elsewhere(mission, there) if state is None else ():
            self.executor.emit(Elsewhere(what=line))

    @property
    def starts_at(self) -> str | None:
        """The start of the mission as its file has it, moved to when it began."""
        return self.start.mission.starts_at

    @property
    def next_s(self) -> float:
        return self.time_s

    @property
    def done(self) -> bool:
        """Whether the mission is over, and robots have done what they do at the end."""
        return self._over

    def go_on(self) -> None:
        """Receive telemetry for a while, and send robots on unless the run is paused."""
        if self._last is not None:
            self._await_last(self._last)
            return
        self.hear(self.time_s + LOOK_S)
        if self._paused:
            self.tell_places()
            return
        self.look()
        if self.executor.done:
            self.stop()
            self._let_last(self._at_end)

    def report(self, event: Event) -> None:
        self._require_plan("a run of a plan")
        self.executor.come_to(self.time_s)
        self.executor.report(event)

    def replan(self) -> None:
        """Nothing: the rest is planned again at the next look at the robots."""

    def break_off(self, reason: str) -> Report:
        self._end_last()
        self.stop()
        if self.executor.done:
            return self._end()
        self._tell_final_states()
        return self.tell_report(broken_off(self.result(), self.executor.account, reason))

    def _let_last(self, act: Callable[[], None]) -> None:
        """Do something with the robots in a thread; the run is over when it has returned."""

        def guarded() -> None:
            try:
                act()
            except Exception as error:  # raised again by the thread of the run
                self._failed = error

        self._last = threading.Thread(target=guarded)
        self._last.start()

    def _await_last(self, thread: threading.Thread) -> None:
        thread.join(LOOK_S)
        self.executor.set_clock(self.time_s)
        self.tell_places()
        if not thread.is_alive():
            self._end()

    def _end_last(self) -> None:
        self._halt.set()
        if self._last is not None:
            self._last.join()

    def _require_plan(self, expected: str) -> None:
        if self._last is not None:
            raise ParameterError(f"{self._busy}; expected {expected}")

    def _end(self) -> Report:
        """Tell where robots are, and what it took."""
        if self._failed is not None:
            raise self._failed
        self._over = True
        self._tell_final_states()
        return self.tell_report(self.result())

    def _tell_final_states(self) -> None:
        """Log where each robot is at the end, what it does, and whether it still flies, drives or is armed."""
        self.executor.emit(final_states_event(final_states_of(self._robots, self.start.mission)))

    def pause(self) -> None:
        self._require_plan("cancel: then robots stay where they are")
        super().pause()
        self._paused = True

    def resume(self) -> None:
        super().resume()
        self._paused = False

    def snapshot(self) -> None:
        """Nothing: robots say themselves where they are."""

    def close(self) -> None:
        """Stop the robots, whatever ended the run."""
        self._end_last()
        try:
            self.stop()
        finally:
            self._robots.close()


class RecoveryRun(RealRun):
    """A run that brings robots home, whatever run they were in before, and does no task."""

    _busy = "robots are brought home"

    def __init__(self, mission: Mission, plan: Plan, fleet: Fleet, recorder: Recorder, **how: Any) -> None:
        state = how.pop("state", None)
        super().__init__(mission, plan, fleet, recorder, state=state or MissionState(mission, plan.ignored), **how)
        self._mission, self._wall = mission, how.get("wall")
        self._ending = getattr(how["request"].settings, "at_end", "hold")
        self._lost: Mapping[str, str] = {}

    def go_on(self) -> None:
        """See how far robots are."""
        if self._last is None:
            self._let_last(self._bring)
        super().go_on()

    def break_off(self, reason: str) -> Report:
        self._end_last()
        self.stop()
        return self._end()

    def _require_plan(self, expected: str) -> None:
        raise ParameterError(f"{self._busy}; expected {expected}")

    def _bring(self) -> None:
        self._lost = bring_home(self._mission, self._robots, self._halt, at_end=self._ending, wall=self._wall)
        if not hasattr(self._robots, "recover"):
            self._at_end()

    def _end(self) -> Report:
        if self._failed is not None:
            raise self._failed
        self._over = True
        for robot, why in self._lost.items():
            self.executor.emit(Elsewhere(what=f"{robot} is not home: {why}"))
        self._tell_final_states()
        return self.tell_report(without_tasks(self.result(), self._mission, ()))
