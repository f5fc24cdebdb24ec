"""A plan carried out by real robots from where they stand; after a crash, the rest of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from muster.execution import Recorder, Report, broken_off
from muster.execution.final_state import final_states_of
from muster.execution.fleet import Fleet
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.mission.system.clock import Clock
from muster.running.live import Live, elsewhere, with_reported_starts
from muster.running.run_request import OPEN_FLEET, RunRequest
from muster.state import MissionState
from muster.state.robot_events import Elsewhere, FinalStates

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
    ) -> None:
        there = with_reported_starts(mission, fleet) if state is None else mission
        request = replace(request or RunRequest(world=OPEN_FLEET), ignore=plan.ignored)
        super().__init__(there, plan, fleet, request, recorder=recorder, state=state, wall=wall)
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
        states = final_states_of(self._robots, self.start.mission)
        robots = [{"robot": one.robot, "moving": one.moving, "words": str(one)} for one in states]
        self.executor.emit(FinalStates(robots=tuple(robots)))

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
