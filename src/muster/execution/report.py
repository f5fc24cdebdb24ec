"""The report: what carrying a mission out took, beside what was planned (the thesis' usage discrepancy, 6.3.1)."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from muster.execution.executor import Executor


@dataclass(frozen=True)
class RobotReport:
    """Usage of one robot in the mission's unit: of the plan that it began with, and measured. 0 planned: it joined."""

    robot: str
    usage_planned: float
    usage_flown: float


@dataclass(frozen=True)
class TaskReport:
    """Usage for one task done and the way to it: by the plan when its robot left for it, and measured.

    `waiting_s` is for how long its robot waited there, for prerequisites.
    """

    task: str
    robot: str
    usage_planned: float
    usage_flown: float
    waiting_s: float


@dataclass(frozen=True)
class ObjectiveReport:
    """The objective by the plan that the mission began with, None where that does not tell, and as measured."""

    name: str
    planned: float | None
    flown: float


@dataclass(frozen=True, kw_only=True)
class Report:
    """Figures of a mission that was carried out.

    Parameters
    ----------
    mission_time_s
        from the beginning until the last robot was done, at its end if it has one; `starts_s` and `ends_s` are of
        tasks done, by the mission's clock.
    tasks_done, tasks_lost
        in order of completion; and every other task, with the reason.
    contacts, min_distance_m
        how often two robots touched, and the least distance between their centres; None for one robot.
    waiting_s
        seconds that robots waited at tasks, in all.
    reallocations
        how often the rest was planned again.
    objective
        of the plan; `average` is of the usages with which robots came to tasks, `makespan` the mission time.
    tasks
        of tasks done, in order of completion.
    """

    mission_time_s: float
    tasks_done: tuple[str, ...]
    tasks_lost: tuple[tuple[str, str], ...]
    contacts: int
    min_distance_m: float | None
    waiting_s: float
    reallocations: int
    robots: tuple[RobotReport, ...]
    starts_s: dict[str, float]
    ends_s: dict[str, float]
    objective: ObjectiveReport
    tasks: tuple[TaskReport, ...]

    def as_dict(self) -> dict[str, Any]:
        """What `muster simulate --format json` prints."""
        lost = [{"task": task, "reason": reason} for task, reason in self.tasks_lost]
        rows = {name: [asdict(row) for row in getattr(self, name)] for name in ("robots", "tasks")}
        return asdict(self) | {"tasks_done": list(self.tasks_done), "tasks_lost": lost, **rows}


def report_of(executor: Executor, *, contacts: int, min_distance_m: float | None) -> Report:
    """The report of a mission, over or not.

    Parameters
    ----------
    contacts, min_distance_m
        as the world has measured them: robots do not know how near they were.
    """
    ledger = executor.ledger
    done = sorted(ledger.ends_s, key=lambda task: ledger.ends_s[task])
    end = executor.now_s if executor.ended_s is None else executor.ended_s
    return Report(
        mission_time_s=end - executor.begun_s,
        tasks_done=tuple(done),
        tasks_lost=tuple(executor.lost().items()),
        contacts=contacts,
        min_distance_m=min_distance_m,
        waiting_s=ledger.waiting_s,
        reallocations=len(executor.revisions),
        robots=tuple(
            RobotReport(name, executor.usage_planned.get(name, 0.0), hand.used) for name, hand in executor.crew.items()
        ),
        starts_s={task: ledger.starts_s[task] for task in done},
        ends_s={task: ledger.ends_s[task] for task in done},
        objective=_objective(executor, end - executor.begun_s),
        tasks=tuple(
            TaskReport(task, ledger.done_by[task], *ledger.usage[task], ledger.waited_s(task)) for task in done
        ),
    )


def _objective(executor: Executor, mission_time_s: float) -> ObjectiveReport:
    plan, ledger = executor.planned, executor.ledger
    name = plan.objective or executor.mission.rules.objective
    usages = [hand.used for hand in executor.crew.values()]
    arrivals = [ledger.arrival_usage[task] for task in ledger.ends_s]
    flown = {
        "total+max": sum(usages) + max(usages, default=0.0),
        "total": sum(usages),
        "max": max(usages, default=0.0),
        "average": sum(arrivals) / len(arrivals) if arrivals else 0.0,
        "makespan": mission_time_s,
    }
    return ObjectiveReport(name, plan.objective_value, flown[name])
