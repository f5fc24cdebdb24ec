"""What helps when no robot gets on: a new plan, and in the end to give up what robots wait for in vain."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from muster.execution.record import Tell
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.timing.beginning import Beginning
from muster.execution.timing.punctuality import Punctuality
from muster.state.task_events import Standstill
from muster.state.task_ledger import Ledger


class Deadlocks:
    """Notices that robots wait for each other for ever, which a plan from elsewhere can make them do.

    Parameters
    ----------
    ledger, crew, beginning, punctuality
        of the executor.
    ask
        receives events that ask for a new plan.
    """

    def __init__(
        self,
        ledger: Ledger,
        crew: Mapping[str, RobotState],
        beginning: Beginning,
        punctuality: Punctuality,
        ask: Tell,
    ) -> None:
        self._ledger, self._crew, self._ask = ledger, crew, ask
        self._beginning, self._punctuality = beginning, punctuality
        self._stood_still_at = -1  # when so many tasks had ended
        self._tried_left_out_at = 0

    @property
    def _present(self) -> list[RobotState]:
        return [state for state in self._crew.values() if not state.out]

    def look(self, now: float) -> bool:
        """Where nobody gets on ask for a new plan, and then for one without tasks that are given up; whether it did."""
        if self._punctuality.waits_for_clock(now):
            return False
        waiting = [state.route[0] for state in self._present if state.activity is Activity.WAITING]
        if not waiting or not all(_stands_still(state, now) for state in self._present):
            return False
        ended = len(self._ledger.ends_s)
        if self._stood_still_at == ended:
            return self._give_up(waiting, now)
        self._stood_still_at = ended
        wait = self._beginning.wait(waiting[0], now)
        missing, words = self._ledger.missing(waiting[0]), "" if wait is None else wait.words
        self._ask(Standstill(task=waiting[0], waits_for=tuple(missing), words=words))
        return True

    def _give_up(self, tasks: Iterable[str], now: float) -> bool:
        """The new plan stands still too: the tasks at which robots wait are given up, with what they waited for."""
        given_up = False
        for task in dict.fromkeys(tasks):
            wait = self._beginning.wait(task, now)
            if wait is not None and task not in self._ledger.barred:
                rule = {"start": "relation"}.get(wait.cause, wait.cause)
                reason = f"{rule}: {wait.words}; no new plan brings that about"
                self._ask(Standstill(task=task, words=wait.words, given_up=reason))
                given_up = True
        return given_up

    def left_out_to_try(self, left_out: Iterable[str]) -> list[str]:
        """When no robot has a task any more: the tasks left out that are worth one more plan, as another has ended."""
        ended = len(self._ledger.ends_s)
        if self._tried_left_out_at == ended or any(state.route for state in self._present):
            return []
        self._tried_left_out_at = ended
        worth = set(left_out) - self._ledger.barred.keys()
        return [task.id for task in self._ledger.open if task.id in worth]


def _stands_still(state: RobotState, now: float) -> bool:
    """Whether a robot waits at a task, or has nothing to do and does not stand aside for others."""
    if state.activity is Activity.WAITING:
        return True
    return state.activity is Activity.IDLE and not state.route and not state.calls and state.aside_until_s <= now
