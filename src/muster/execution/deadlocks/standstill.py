"""Whether a team as a whole gets on: where traffic leads robots, single ones may move to and fro for ever."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from muster.execution.robots.robot_state import MOVING, Activity, RobotState

_NEARER_M = 1.0
_BUSY = (Activity.WORKING, Activity.WAITING, Activity.QUEUEING, Activity.SERVED)


@dataclass
class Standstill:
    """Since when no robot of a team has come nearer to where it goes than ever before, nor done anything there."""

    since_s: float = 0.0
    _done: dict[str, tuple[object, ...]] = field(default_factory=dict)
    _least_m: dict[str, float] = field(default_factory=dict)  # left of the way to the current goal

    def look(self, crew: Collection[RobotState], now: float) -> None:
        """See how far all are; a team of which nobody is under way, or somebody is at work, does not stand still."""
        present = [state for state in crew if not state.out]
        idle = not any(state.activity in MOVING for state in present)
        if idle or any(state.activity in _BUSY for state in present):
            self.since_s = now
        for state in present:
            self._see(state, now)

    def _see(self, state: RobotState, now: float) -> None:
        robot, done = state.robot.id, (state.activity, state.at_home, tuple(state.route))
        left_m = state.way_left_m if state.activity in MOVING else 0.0
        if done != self._done.get(robot):
            self._done[robot], self._least_m[robot], self.since_s = done, left_m, now
        elif left_m < self._least_m[robot] - _NEARER_M:
            self._least_m[robot], self.since_s = left_m, now
