"""When work on a task may begin: as the rules let it, and with the robots that must be there.

Tasks that are one unit begin at the same moment, when each of them may.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster.execution.robots.robot_state import Activity, RobotState
from muster.mission.model import Robot
from muster.mission.system.clock import TIME_ROUNDING_S
from muster.model.rules.prerequisite import waits_for_dependants
from muster.model.rules.team import waits_for_team, waits_to_start_with
from muster.model.rules.times import rounded
from muster.model.under_way import Missed, UnderWay, Wait
from muster.state.task_ledger import Ledger


@dataclass(frozen=True)
class Beginning:
    """Says whether work may begin.

    Parameters
    ----------
    ledger, crew
        of the executor.
    hold_until_s
        when a task should begin, if one that depends on it must begin soon after it; see `Forecast`.
    alone
        whether the crew is the whole team: else who belongs to a task is for the other robots to say.
    """

    ledger: Ledger
    crew: Mapping[str, RobotState]
    hold_until_s: Callable[[str, float], float]
    alone: bool = True

    @property
    def model(self) -> UnderWay:
        """What rules ask of the tasks as they are now."""
        return self.ledger.model

    def must_ask(self, task: str, robot: Robot) -> bool:
        """Whether a robot stops at a task before it begins: whether it may is not known when it sets out."""
        return bool(self.model.limits(robot).spans) or self.model.is_bound(task) or self.ledger.must_be_followed(task)

    def wait(self, task: str, now: float) -> Wait | None:
        """Why robots must wait at a task now; None: work may begin."""
        return next(self._waits(task, now), None)

    def earliest_s(self, task: str, now: float) -> float:
        """When work may begin at the earliest, as far as that is known; inf if more than the clock delays it."""
        return max((wait.until_s for wait in self._waits(task, now)), default=now)

    def missed(self, task: str, now: float) -> Missed | None:
        """Why a task can never begin any more; None: it still can."""
        unit = self.ledger.unit(task)
        return next((found for name in unit for found in self.model.missed(name, now, self.ledger.ends_s)), None)

    def in_time_until_s(self, task: str, now: float) -> float:
        """Until when a task that is not missed now cannot be: until then no time that limits it is over."""
        unit = self.ledger.unit(task)
        limits = [limit for name in unit for limit in self.model.time_limits_s(name, now, self.ledger.ends_s)]
        return min((limit for limit in limits if limit >= now), default=math.inf)

    def present(self, task: str) -> list[RobotState]:
        """The robots that wait at a task."""
        return [state for state in self.assigned(task) if _waits_at(state, task)]

    def assigned(self, task: str) -> list[RobotState]:
        """The robots that have a task in their routes."""
        return [state for state in self.crew.values() if not state.out and task in state.route]

    def _waits(self, task: str, now: float) -> Iterator[Wait]:
        unit = self.ledger.unit(task)
        yield from self.model.waits(unit, now, self.ledger.ends_s)
        if self.alone:
            yield from self._absent(task, unit)
        opens = self.model.next_begin_s(unit, now)
        yield from self._rests(unit, now if math.isinf(opens) else opens)
        hold = self.hold_until_s(task, now)
        if hold > now + TIME_ROUNDING_S:
            yield Wait("dependant", waits_for_dependants(self.ledger.dependants_soon_after(unit)), hold)

    def _rests(self, unit: Sequence[str], now: float) -> Iterator[Wait]:
        """A robot would have to rest before the work is done: all begin when each of them works through."""
        for name in unit:
            here = self.present(name)
            lasts_s = max((state.work_s for state in here), default=0.0)
            for state in here:
                begins = state.limits.set_out(now, lasts_s)
                if begins > now + TIME_ROUNDING_S:
                    word = state.limits.words["spans"]
                    yield Wait("shift", f"waits for {word}: {state.robot.id} works from {rounded(begins)} on", begins)

    def _absent(self, task: str, unit: Sequence[str]) -> Iterator[Wait]:
        for name in sorted(unit, key=lambda other: other != task):
            cause = "team" if name == task else "start"
            here = self.present(name)
            absent = [state.robot.id for state in self.assigned(name) if state not in here]
            need = self.model.lacking(self.ledger.tasks[name], [state.robot for state in here])
            if absent or need:
                who = ", ".join(absent) or need
                yield Wait(cause, waits_for_team(who) if name == task else waits_to_start_with(name, who))


def _waits_at(state: RobotState, task: str) -> bool:
    return state.activity is Activity.WAITING and state.route[:1] == [task]
