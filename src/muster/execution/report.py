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
    """Usage for one task done and the way to it: by the plan when its robot left for it, and measured."""

    task: str
    robot: str
    usage_planned: float
    usage_flown: float


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
    tasks
        of tasks done, in order of completion; not in `as_dict`.
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
    tasks: tuple[TaskReport, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """What `muster simulate --format json` prints."""
        data = asdict(self)
        del data["tasks"]
        data["tasks_lost"] = [{"task": task, "reason": reason} for task, reason in self.tasks_lost]
        return data | {"tasks_done": list(self.tasks_done), "robots": list(data["robots"])}


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
        tasks=tuple(TaskReport(task, ledger.done_by[task], *ledger.usage[task]) for task in done),
    )
