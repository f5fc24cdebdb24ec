"""The overseer looks at the crew now and then: what the monitor notices of robots becomes changes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from muster.execution.changes import SILENT, STUCK, Change, Changes
from muster.execution.dispatch import Dispatch, Tell
from muster.execution.monitor import Limits, exceeds, held_up, is_silent, is_stuck, seems_late, stands_in_the_way
from muster.execution.robot_state import MOVING, Activity, Hand
from muster.execution.task_ledger import Ledger


@dataclass
class Overseer:
    """Notices missed telemetry, way points refused, no progress, and too little capacity.

    Parameters
    ----------
    crew, ledger, dispatch, changes
        of the executor.
    capacity
        how much a robot can use; None: any amount.
    limits
        how long what may last.
    tell
        is told what happens that asks for no new plan.
    look_s
        when the next look is due.
    """

    crew: Mapping[str, Hand]
    ledger: Ledger
    dispatch: Dispatch
    changes: Changes
    capacity: Callable[[Hand], float | None]
    limits: Limits
    tell: Tell
    look_s: float

    def look(self, now: float) -> Iterator[Change]:
        """Look at all that take part, if that is due; yields what asks for a new plan."""
        if now < self.look_s:
            return
        self.look_s = now + self.limits.look_every_s
        if any(seems_late(hand, now, self.limits) for hand in self._present):
            for hand in held_up(self._present):
                hand.nearest_s = now
        for hand in self._present:
            if is_silent(hand, now, self.limits):
                yield from self.changes.put_out(hand, SILENT, now)
            elif hand.refused and hand.activity in MOVING:
                yield from self._let_refuse(hand, now)
            elif is_stuck(hand, now, self.limits):
                yield from self._free_or_put_out(hand, now)
            elif hand.activity is Activity.DRIVING and self.capacity(hand) is not None:
                yield from self._notice_capacity(hand, now)

    @property
    def _present(self) -> list[Hand]:
        return [hand for hand in self.crew.values() if not hand.out]

    def _free_or_put_out(self, hand: Hand, now: float) -> Iterator[Change]:
        """A robot that does not get on is sent again, and out the next time; not if a broken one stands in its way."""
        broken = [other for other in self.crew.values() if other.out]
        blocking = next((one for one in broken if stands_in_the_way(one, hand.robot, hand.points_left)), None)
        if blocking is not None and hand.activity is Activity.RETURNING:
            self.dispatch.end_here(hand, now)
        elif blocking is not None:
            yield from self._give_up_blocked(hand, blocking, now)
        elif hand.stuck_before:
            yield from self.changes.put_out(hand, STUCK, now, "no progress")
        else:
            self.tell("robot_sent_again", {"robot": hand.robot.id, "reason": "no progress"})
            self.dispatch.again(hand, now)

    def _let_refuse(self, hand: Hand, now: float) -> Iterator[Change]:
        """A robot that will not get to where it was sent: others do the task, or it ends where it is."""
        if hand.activity is Activity.RETURNING:
            self.dispatch.end_here(hand, now)
        else:
            yield from self.dispatch.refuse(hand, hand.route[0], hand.refused, now)

    def _give_up_blocked(self, hand: Hand, blocking: Hand, now: float) -> Iterator[Change]:
        """No robot gets to a task at which a broken one stands, if it is as large as the one that tried."""
        task, points, reason = hand.route[0], hand.points_left, f"unreachable: {blocking.robot.id} stands there, out"
        for other in self._present:
            able = set(self.ledger.tasks[task].requires) <= set(other.robot.skills)
            if other is not hand and able and stands_in_the_way(blocking, other.robot, points):
                self.ledger.refuse(task, other.robot.id, reason)
        self.ledger.blocked_by[task] = blocking.robot.id
        return self.dispatch.refuse(hand, task, reason, now)

    def _notice_capacity(self, hand: Hand, now: float) -> Iterator[Change]:
        """A robot that cannot do the task it is on its way to, or all the rest of its route, by what it has used."""
        task, capacity, after = hand.route[0], self.capacity(hand), hand.used_after(now)
        if exceeds(after + hand.home_usage, capacity):
            reason = f"capacity: {after + hand.home_usage:.2f} used with it, of {capacity:.2f}"
            yield from self.dispatch.refuse(hand, task, reason, now)
        elif hand.warned_of != task and exceeds(after + self.dispatch.ahead[hand.robot.id].get(task, 0.0), capacity):
            hand.warned_of = task
            yield Change("robot_runs_low", {"robot": hand.robot.id, "capacity": capacity})
