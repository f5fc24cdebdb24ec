"""The report of a mission carried out, beside what was planned (usage discrepancy, [tcf-thesis], 6.3.1)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import TYPE_CHECKING, Any

from muster.execution.reports.robot_report import RobotReport
from muster.execution.reports.team_report import TeamReport
from muster.mission.objectives import lateness, objective_values
from muster.mission.tables import data_frame, html_line, html_table
from muster.state.orders import OrdersReport
from muster.state.task_ledger import Ledger
from muster.state.traffic_account import TrafficAccount

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True, kw_only=True)
class Account:
    """What is known of a mission that was carried out by those who did it.

    Parameters
    ----------
    objective, objective_planned
        by name, and by the plan that the mission began with, None where that does not tell.
    ledger, lost
        of the tasks; why each task is lost that is.
    robots
        by id what each used, and did at stations.
    planned_so_far
        by robot the usage, in the mission's unit, of the part of the plan that was carried out.
    mission_time_s, reallocations, done_twice
        as in `Report`.
    overtime_s
        by robot how long it was under way after its shift, of those that were.
    back_s
        when robots were back, where that counts for the makespan.
    traffic
        who held up whom in traffic.
    waits_s
        by cause for how long robots waited at tasks, where tasks have rules about time or teams.
    orders
        of a mission in which tasks came on the way.
    """

    objective: str
    objective_planned: float | None
    ledger: Ledger
    lost: Mapping[str, str]
    robots: Mapping[str, RobotReport]
    mission_time_s: float
    reallocations: int
    planned_so_far: Mapping[str, float] = field(default_factory=dict)
    done_twice: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    overtime_s: Mapping[str, float] = field(default_factory=dict)
    back_s: tuple[float, ...] = ()
    traffic: TrafficAccount = field(default_factory=TrafficAccount)
    waits_s: Mapping[str, float] = field(default_factory=dict)
    orders: OrdersReport | None = None


@dataclass(frozen=True)
class TaskReport:
    """Usage for one task done and the way to it: by the plan when its robot left for it, and measured.

    `waiting_s` is for how long its robot waited there. Of a task done by a team `robot` is the first of the `team`, and
    usages and waiting are those of all. `lateness_s` is by how much it ended after its due time.

    Where a simulated world knows, `done_m_off` is how far from its true place it was done, and `within_m` how far at
    most that may be.
    """

    task: str
    robot: str
    usage_planned: float
    usage_flown: float
    waiting_s: float
    team: tuple[str, ...] = ()
    lateness_s: float = 0.0
    done_m_off: float | None = None
    within_m: float | None = None


@dataclass(frozen=True)
class ObjectiveReport:
    """The objective by the plan that the mission began with, None where that does not tell, and as measured."""

    name: str
    planned: float | None
    flown: float


@dataclass(frozen=True, kw_only=True)
class FoundReport:
    """A point of interest that cameras found.

    Parameters
    ----------
    tag
        the id that was decoded.
    position, deviation_m
        x and y in the map frame by all sightings, and the greatest standard deviation along any direction, metres.
    sure_to_m
        the radius about the position within which it is with a probability of 95 %.
    error_m
        how far that is from the nearest such tag of the mission; None where it has none.
    sightings, robots
        in how many images, and of whom.
    found_s
        when it counted as found.
    task
        what became of it, if anything.
    """

    tag: int
    position: tuple[float, ...]
    deviation_m: float
    sure_to_m: float
    error_m: float | None
    sightings: int
    robots: tuple[str, ...]
    found_s: float
    task: str | None


@dataclass(frozen=True, kw_only=True)
class GroundReport:
    """What robots found out that had no map.

    Parameters
    ----------
    explored_m2
        how large the ground is that they saw to be free.
    ways_closed
        how often an obstacle appeared in the way of a robot.
    frontiers, frontiers_seen
        how many frontiers became tasks, and how many of those no robot had to go to, mostly as others saw what lies
        behind; these are in no list of tasks.
    driven_m, with_map_m
        what robots drove from each place to the next at which they arrived, and the shortest ways there by the true
        map; None of real robots, of whose ground nobody has the true map.
    """

    explored_m2: float
    ways_closed: int
    frontiers: int
    frontiers_seen: int
    driven_m: float | None = None
    with_map_m: float | None = None


@dataclass(frozen=True)
class TrafficReport:
    """For how long in all, how often and for how long at most one robot waited in traffic for another.

    `position` is where the robot stood that waited the longest time.
    """

    robot: str
    waits_for: str
    waiting_s: float
    times: int
    longest_s: float
    position: tuple[float, ...]


@dataclass(frozen=True)
class MissedReport:
    """A task that was not begun in time, noticed at `at_s`; `next_s` is when it still could begin, None: never."""

    task: str
    at_s: float
    reason: str
    next_s: float | None


@dataclass(frozen=True, kw_only=True)
class Report:
    """Figures of a mission that was carried out.

    Parameters
    ----------
    mission_time_s
        from the beginning until the last robot was done, at its end if it has one; `starts_s` and `ends_s` are of
        tasks done, by the mission's clock.
    tasks_done, tasks_lost
        in order of completion; and every other task, with the reason. In a simulated world a task is done that was
        done within its tolerance of its true place. A standing fleet lists the tasks that it remembers, and the last
        20 that were lost before.
    contacts, min_distance_m
        how often two robots touched, and the least distance between their centres, None for one robot; both None where
        nobody measured it.
    waiting_s
        seconds that robots waited, in all: at tasks done, in traffic, and for slots at stations.
    traffic
        who held up whom in traffic, the longest waiting first.
    waiting_by_cause_s
        seconds that robots waited, by cause: `traffic`; `slot` at stations; and at tasks, done or not, where a task has
        a rule about time or teams: `prerequisite`, `window`, `lag`, `team`, `start` (of a task that begins with it),
        `dependant` (so that another task can begin soon enough after it).
    lateness_s
        by how much tasks done ended after their due times, in all.
    missed
        tasks that were not begun in time.
    deadlines_missed_s, within_exceeded_s
        by task done how long after its deadline it ended, and by how much too long after a prerequisite, or what it
        delivers was taken on board, it began.
    shifts_exceeded_s
        by robot how long after its shift, or its longest duty, it was under way.
    reallocations
        how often the rest was planned again.
    objective
        of the plan; `average` is of the usages with which robots came to tasks, `makespan` the end of the last task.
    tasks
        of tasks that robots take for done, in order of completion.
    done_twice
        by task that several robots have begun, as they could not hear each other, these robots.
    found
        what cameras found, in order of time.
    orders
        figures of tasks that came while it was carried out; None: none did.
    tasks_forgotten
        how many tasks done, cancelled and lost are not listed, as a standing fleet keeps its last ones alone; sums
        such as `waiting_s`, and the objective, are of all.
    ground
        what robots found out that had no map; None: they had it.
    team
        what became of the processes of robots that agreed without a centre; None: a plan was carried out.
    remarks
        what else a person should hear of.
    """

    mission_time_s: float
    tasks_done: tuple[str, ...]
    tasks_lost: tuple[tuple[str, str], ...]
    contacts: int | None
    min_distance_m: float | None
    waiting_s: float
    reallocations: int
    robots: tuple[RobotReport, ...]
    starts_s: dict[str, float]
    ends_s: dict[str, float]
    objective: ObjectiveReport
    tasks: tuple[TaskReport, ...]
    done_twice: dict[str, tuple[str, ...]] = field(default_factory=dict)
    found: tuple[FoundReport, ...] = ()
    waiting_by_cause_s: dict[str, float] = field(default_factory=dict)
    lateness_s: float = 0.0
    missed: tuple[MissedReport, ...] = ()
    deadlines_missed_s: dict[str, float] = field(default_factory=dict)
    within_exceeded_s: dict[str, float] = field(default_factory=dict)
    shifts_exceeded_s: dict[str, float] = field(default_factory=dict)
    traffic: tuple[TrafficReport, ...] = ()
    orders: OrdersReport | None = None
    tasks_forgotten: dict[str, int] = field(default_factory=dict)
    ground: GroundReport | None = None
    team: TeamReport | None = None
    remarks: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """What `muster simulate --format json` prints."""
        lost = [{"task": task, "reason": reason} for task, reason in self.tasks_lost]
        rows: dict[str, list[dict[str, Any]]] = {
            name: [asdict(row) for row in getattr(self, name)]
            for name in ("robots", "tasks", "found", "missed", "traffic")
        }
        for row in rows["tasks"]:
            row["team"] = list(row["team"])
        names = {"tasks_done": list(self.tasks_done), "remarks": list(self.remarks)}
        return asdict(self) | names | {"tasks_lost": lost, **rows}

    def __repr__(self) -> str:
        return f"<Report: {self._summary}>"

    def _repr_html_(self) -> str:
        tasks = [
            (t.task, ", ".join(t.team) or t.robot, self.starts_s[t.task], self.ends_s[t.task], t.waiting_s)
            for t in self.tasks
        ]
        columns = ("task", "robot", "starts (s)", "ends (s)", "waits (s)")
        lost = html_table("Tasks lost", ("task", "reason"), self.tasks_lost) if self.tasks_lost else ""
        return html_line(self._summary) + html_table("Tasks done", columns, tasks) + lost

    @property
    def _summary(self) -> str:
        done, lost = len(self.tasks_done), len(self.tasks_lost)
        objective = f"{self.objective.name} {self.objective.flown:.2f}"
        return f"{done} tasks done, {lost} lost, {self.mission_time_s:.1f} s, {objective}"

    def to_frame(self) -> DataFrame:
        """A DataFrame with a row for each task done: robot, usage planned and measured, times; needs `frames`."""
        rows = (
            {**asdict(row), "starts_s": self.starts_s[row.task], "ends_s": self.ends_s[row.task]} for row in self.tasks
        )
        return data_frame(rows, (*(f.name for f in fields(TaskReport)), "starts_s", "ends_s"))


def report_of(account: Account, *, contacts: int | None = None, min_distance_m: float | None = None) -> Report:
    """The report of a mission, over or not.

    Parameters
    ----------
    contacts, min_distance_m
        as a world has measured them: robots do not know how near they were.
    """
    ledger = account.ledger
    done = sorted(ledger.ends_s, key=lambda task: ledger.ends_s[task])
    return Report(
        mission_time_s=account.mission_time_s,
        tasks_done=tuple(done),
        tasks_lost=(*ledger.lost_and_forgotten.items(), *account.lost.items()),
        contacts=contacts,
        min_distance_m=min_distance_m,
        waiting_s=ledger.waiting_s + account.traffic.waiting_s + _slot_wait_s(account),
        reallocations=account.reallocations,
        robots=tuple(account.robots.values()),
        starts_s={task: ledger.starts_s[task] for task in done},
        ends_s={task: ledger.ends_s[task] for task in done},
        objective=_objective(account),
        tasks=tuple(_task(ledger, task) for task in done),
        waiting_by_cause_s=_waiting_by_cause(account),
        traffic=_traffic(account.traffic),
        lateness_s=ledger.retired.lateness_s + sum(ledger.late_s(task) for task in done),
        missed=tuple(MissedReport(one.task, one.at_s, one.reason, one.next_s) for one in ledger.missed),
        deadlines_missed_s={task: ledger.overdue_s(task) for task in done if ledger.overdue_s(task) > 0},
        within_exceeded_s={task: ledger.begun_too_late_s(task) for task in done if ledger.begun_too_late_s(task) > 0},
        shifts_exceeded_s=dict(account.overtime_s),
        done_twice=dict(account.done_twice),
        orders=account.orders,
        tasks_forgotten=_forgotten(ledger),
    )


def _task(ledger: Ledger, task: str) -> TaskReport:
    return TaskReport(
        task,
        ledger.done_by[task],
        *ledger.usage[task],
        ledger.waited_s(task),
        team=ledger.members(task) if ledger.tasks[task].is_for_team else (),
        lateness_s=ledger.late_s(task),
    )


def _traffic(account: TrafficAccount) -> tuple[TrafficReport, ...]:
    rows = [
        TrafficReport(robot, other, pair.waiting_s, pair.times, pair.longest_s, pair.place)
        for robot, others in account.pairs.items()
        for other, pair in others.items()
    ]
    return tuple(sorted(rows, key=lambda row: (-row.waiting_s, row.robot, row.waits_for)))


def _waiting_by_cause(account: Account) -> dict[str, float]:
    causes = dict(account.waits_s)
    if account.traffic.pairs:
        causes["traffic"] = account.traffic.waiting_s
    if _slot_wait_s(account) > 0:
        causes["slot"] = _slot_wait_s(account)
    return dict(sorted(causes.items()))


def _slot_wait_s(account: Account) -> float:
    return sum(row.slot_wait_s for row in account.robots.values())


def _forgotten(ledger: Ledger) -> dict[str, int]:
    """How many forgotten tasks are in no list."""
    sums = ledger.retired
    counts = {"done": sums.done, "cancelled": sums.cancelled, "lost": sums.lost - len(ledger.lost_and_forgotten)}
    return {name: count for name, count in counts.items() if count}


def _objective(account: Account) -> ObjectiveReport:
    ledger, sums = account.ledger, account.ledger.retired
    arrivals = [ledger.arrival_usage[task] for task in ledger.ends_s]
    late = lateness((ledger.tasks[task].priority, end, ledger.tasks[task].due_s) for task, end in ledger.ends_s.items())
    ends_s = [*ledger.ends_s.values(), sums.last_end_s, *account.back_s]
    usages = [row.usage_flown for row in account.robots.values()]
    flown = objective_values(usages, arrivals, ends_s, late + sums.lateness)
    if sums.done:
        flown["average"] = (sum(arrivals) + sums.arrival_usage) / (len(arrivals) + sums.done)
    return ObjectiveReport(account.objective, account.objective_planned, flown[account.objective])
