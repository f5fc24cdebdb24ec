"""Supervision of the robots at intervals: findings of the monitor become changes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from muster.execution.changes import SILENT, STUCK, Change, Changes
from muster.execution.dispatch import Dispatch, Emit
from muster.execution.monitor import Limits, exceeds, held_up, is_silent, is_stuck, seems_late, stands_in_the_way
from muster.execution.robot_state import MOVING, Activity, RobotState
from muster.execution.task_ledger import Ledger


@dataclass
class Supervisor:
    """Notices missed telemetry, way points refused, no progress, and too little capacity.

    Parameters
    ----------
    crew, ledger, dispatch, changes
        of the executor.
    capacity
        how much a robot can use; None: any amount.
    limits
        how long what may last.
    emit
        receives every event that asks for no new plan.
    look_s
        when the next look is due.
    """

    crew: Mapping[str, RobotState]
    ledger: Ledger
    dispatch: Dispatch
    changes: Changes
    capacity: Callable[[RobotState], float | None]
    limits: Limits
    emit: Emit
    look_s: float

    def look(self, now: float) -> Iterator[Change]:
        """Check all robots that take part, if that is due; yields changes that require a new plan."""
        if now < self.look_s:
            return
        self.look_s = now + self.limits.look_every_s
        if any(seems_late(state, now, self.limits) for state in self._present):
            for state in held_up(self._present):
                state.nearest_s = now
        for state in self._present:
            if is_silent(state, now, self.limits):
                yield from self.changes.exclude(state, SILENT, now)
            elif state.refused and state.activity in MOVING:
                yield from self._let_refuse(state, now)
            elif is_stuck(state, now, self.limits):
                yield from self._free_or_put_out(state, now)
            elif state.activity is Activity.DRIVING and self.capacity(state) is not None:
                yield from self._notice_capacity(state, now)

    @property
    def _present(self) -> list[RobotState]:
        return [state for state in self.crew.values() if not state.out]

    def _free_or_put_out(self, state: RobotState, now: float) -> Iterator[Change]:
        """A robot without progress is sent again, and excluded the next time; not if a failed robot blocks it."""
        broken = [other for other in self.crew.values() if other.out]
        blocking = next((one for one in broken if stands_in_the_way(one, state.robot, state.points_left)), None)
        if blocking is not None and state.activity is Activity.RETURNING:
            self.dispatch.end_here(state, now)
        elif blocking is not None:
            yield from self._give_up_blocked(state, blocking, now)
        elif state.stuck_before:
            yield from self.changes.exclude(state, STUCK, now, "no progress")
        else:
            self.emit("robot_sent_again", {"robot": state.robot.id, "reason": "no progress"})
            self.dispatch.again(state, now)

    def _let_refuse(self, state: RobotState, now: float) -> Iterator[Change]:
        """A robot cannot reach its way point: other robots do the task, or it ends where it is."""
        if state.activity is Activity.RETURNING:
            self.dispatch.end_here(state, now)
        else:
            yield from self.dispatch.refuse(state, state.route[0], state.refused, now)

    def _give_up_blocked(self, state: RobotState, blocking: RobotState, now: float) -> Iterator[Change]:
        """A failed robot stands at a task: robots as large as the one that tried cannot reach it."""
        task, points, reason = state.route[0], state.points_left, f"unreachable: {blocking.robot.id} stands there, out"
        for other in self._present:
            able = set(self.ledger.tasks[task].requires) <= set(other.robot.skills)
            if other is not state and able and stands_in_the_way(blocking, other.robot, points):
                self.ledger.refuse(task, other.robot.id, reason)
        self.ledger.blocked_by[task] = blocking.robot.id
        return self.dispatch.refuse(state, task, reason, now)

    def _notice_capacity(self, state: RobotState, now: float) -> Iterator[Change]:
        """The capacity of a robot is too small for its current task, or for the rest of its route."""
        task, capacity, after = state.route[0], self.capacity(state), state.used_after(now)
        if exceeds(after + state.home_usage, capacity):
            reason = f"capacity: {after + state.home_usage:.2f} used with it, of {capacity:.2f}"
            yield from self.dispatch.refuse(state, task, reason, now)
        elif state.warned_of != task and exceeds(after + self.dispatch.ahead[state.robot.id].get(task, 0.0), capacity):
            state.warned_of = task
            yield Change("robot_runs_low", {"robot": state.robot.id, "capacity": capacity})
