"""What stands on the sheets of a plan, as data: for each robot its stops, and the tasks left out with the reasons.

Times, usages, levels and loads are the judge's. A drone that has a height of flight is at no stop lower than that.

Times on sheets: of the clock where the mission says when it starts, else since the start.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from muster.mission.goods import by_commodity
from muster.mission.model import Mission, Point, Robot, Station, Task
from muster.mission.plan import Plan, Unassigned
from muster.mission.values.time_types import clock_text, moment_after
from muster.motion.actions import Impossible
from muster.motion.actions import plan as motion_of
from muster.planning.export_formats import ExportOptions
from muster.verification import RouteFigures, Stop, Verdict
from muster_files.altitudes import altitudes_of, raised_team
from muster_files.earth import Earth, Spot
from muster_files.sheets.instructions import at_station, at_task
from muster_files.sheets.waiting import Waiting
from muster_files.task_times import Stop as OwnedStop
from muster_files.task_times import late_s, stops_of


@dataclass(frozen=True)
class Times:
    """How times are told; `starts_at` is the mission's, a date and time by ISO 8601."""

    starts_at: str | None

    def text(self, seconds: float) -> str:
        """`08:01:45`, of later days `+1 08:01:45`; without a start the time since then, `0:01:45`."""
        return elapsed(seconds) if self.starts_at is None else clock_text(seconds, self.starts_at)

    @property
    def words(self) -> str:
        """What the times are, for a heading."""
        if self.starts_at is None:
            return "Times: hours, minutes, seconds since the start."
        start = datetime.fromisoformat(self.starts_at)
        zone = start.strftime("%z")
        told = f"{start:%Y-%m-%d %H:%M:%S}" + (f" (UTC{zone[:3]}:{zone[3:5]})" if zone else "")
        return f"Times: of the clock; the mission starts {told}."

    def moment(self, seconds: float) -> datetime | None:
        """The date and time so long after the start; None without a start, and after the year 9999."""
        if self.starts_at is None:
            return None
        try:
            return moment_after(seconds, self.starts_at)
        except OverflowError:
            return None


def elapsed(seconds: float) -> str:
    """`1:02:03`: hours, minutes, seconds."""
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


_MOST_ROBOTS = 4  # that are named beside one reason


@dataclass(frozen=True)
class Line:
    """A stop of a robot as its sheet has it.

    `place` is in metres of the map frame, `spot` the same on Earth, where the mission lies there; `others` are the
    other robots of the task's team, `waits_for` the reasons for waiting, `limits` what the task asks of time.
    """

    order: int
    visit: Stop
    place: Point
    spot: Spot | None
    doing: str
    others: tuple[str, ...]
    waits_for: tuple[str, ...]
    limits: tuple[str, ...]
    late_s: float | None


@dataclass(frozen=True)
class Sheet:
    """What one robot does: its figures, its stops, its height of flight above its start, metres; None: none given."""

    robot: Robot
    figures: RouteFigures
    altitude_m: float | None
    lines: tuple[Line, ...]
    start: Spot | None


@dataclass(frozen=True)
class LeftOut:
    """A task in no route, and why, in a few words; empty where the plan does not say why."""

    task: Task
    why: str


@dataclass(frozen=True)
class Sheets:
    """All sheets of a plan, in mission order; `plan` where it is known who made it; `notes` are for the user."""

    mission: Mission
    verdict: Verdict
    plan: Plan | None
    robots: tuple[Sheet, ...]
    left_out: tuple[LeftOut, ...]
    notes: tuple[str, ...]

    @property
    def times(self) -> Times:
        return Times(self.mission.starts_at)

    @property
    def busy(self) -> tuple[Sheet, ...]:
        """The sheets that have stops."""
        return tuple(sheet for sheet in self.robots if sheet.lines)


def sheets_of(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Sheets:
    """The sheets of an admissible plan.

    Raises
    ------
    ParameterError
        if an altitude is for no drone.
    MissingExtraError
        for places on Earth without the extra `map`.
    """
    altitudes = altitudes_of(mission, options)
    notes = raised_team(mission, verdict, altitudes, options)[1] if options.separates else ()
    made = _Maker(mission, verdict, altitudes)
    return Sheets(mission, verdict, plan, tuple(made.sheets()), tuple(_left_out(mission, verdict, plan)), notes)


def _begin(task: Task, robot: Robot) -> Point:
    """Where the robot begins the task: of an area, with the first lane."""
    if task.action is None or task.action.area is None:
        return task.position
    motion = motion_of(task, robot)
    return task.position if isinstance(motion, Impossible) else (*motion.entry[:2], *task.position[2:])


class _Maker:
    """What the sheets of all robots need."""

    def __init__(self, mission: Mission, verdict: Verdict, altitudes: Mapping[str, float]) -> None:
        self._mission, self._verdict, self._altitudes = mission, verdict, altitudes
        self._earth = None if mission.origin_wgs84 is None else Earth.of(mission, "sheets")
        self._tasks = {task.id: task for task in mission.tasks}
        self._stations = {station.id: station for station in mission.stations}
        self._times, self._waiting = Times(mission.starts_at), Waiting(mission, verdict)
        self._stops = {(stop.robot, stop.order): stop for team in stops_of(verdict).values() for stop in team}

    def sheets(self) -> Iterator[Sheet]:
        for robot, figures in zip(self._mission.robots, self._verdict.routes, strict=True):
            altitude = self._altitudes.get(robot.id)
            places = [self._place(robot, stop, altitude) for stop in figures.stops]
            start, *spots = self._spots([robot.position, *places])
            lines = tuple(
                self._line(robot, self._stops[robot.id, order], place, spot, figures.stops[: order - 1])
                for order, (place, spot) in enumerate(zip(places, spots, strict=True), 1)
            )
            yield Sheet(robot, figures, altitude, lines, start)

    def _place(self, robot: Robot, stop: Stop, altitude: float | None) -> Point:
        """Where the stop is, of an area where its first lane begins; for a drone with a height of flight no lower."""
        point = self._stations[stop.name].position if stop.is_station else _begin(self._tasks[stop.name], robot)
        if altitude is None:
            return point
        floor = (*robot.position, 0.0)[2] + altitude
        return (point[0], point[1], max(floor, (*point, 0.0)[2]))

    def _spots(self, points: Sequence[Point]) -> Sequence[Spot | None]:
        return [None] * len(points) if self._earth is None else self._earth.spots(points)

    def _line(self, robot: Robot, stop: OwnedStop, place: Point, spot: Spot | None, before: Sequence[Stop]) -> Line:
        visit = stop.visit
        task = None if visit.is_station else self._tasks[visit.name]
        if task is None:
            doing = self._service(self._stations[visit.name], robot, visit, before)
        else:
            doing = at_task(task, visit)
        return Line(
            order=stop.order,
            visit=visit,
            place=place,
            spot=spot,
            doing=doing,
            others=stop.others,
            waits_for=self._waiting.reasons(robot.id, visit),
            limits=() if task is None else tuple(self._limits(task, visit)),
            late_s=None if task is None else late_s(task, visit.ends_s),
        )

    def _service(self, station: Station, robot: Robot, visit: Stop, before: Sequence[Stop]) -> str:
        load = before[-1].load_after if before else by_commodity(robot.load_at_start)
        unloads = station.unloads and dict(load) != dict(visit.load_after)
        return at_station(station, visit, self._verdict.usage_unit, unloads=unloads)

    def _limits(self, task: Task, visit: Stop) -> Iterator[str]:
        """The window in which work begins, the deadline, and the due time, with lateness."""
        told = self._times.text
        for opens, closes in task.window_s:
            if opens <= visit.starts_s + 1e-6 and (closes is None or visit.starts_s <= closes + 1e-6):
                yield f"window {told(opens)} - {'' if closes is None else told(closes)}".rstrip()
        if task.deadline_s is not None:
            yield f"deadline {told(task.deadline_s)}"
        if task.due_s is not None:
            late = late_s(task, visit.ends_s)
            yield f"due {told(task.due_s)}" + (f", {late:.0f} s late" if late else "")


def _left_out(mission: Mission, verdict: Verdict, plan: Plan | None) -> Iterator[LeftOut]:
    done = {name for route in verdict.routes for name in route.tasks}
    reasons = {} if plan is None else {item.task: item for item in plan.unassigned}
    for task in mission.tasks:
        if task.id not in done:
            yield LeftOut(task, _why(reasons[task.id]) if task.id in reasons else "")


def _why(item: Unassigned) -> str:
    """The reasons, each with the robots that it keeps from the task."""
    by_reason: dict[str, list[str]] = {}
    for reason in item.reasons:
        by_reason.setdefault(reason.reason, []).append(reason.robot)
    if len(by_reason) == 1:
        (only,) = by_reason
        return f"{only}, for every robot" if len(by_reason[only]) > 1 else f"{only} ({by_reason[only][0]})"
    return "; ".join(f"{reason} ({_named(robots)})" for reason, robots in by_reason.items())


def _named(robots: Sequence[str]) -> str:
    more = len(robots) - _MOST_ROBOTS
    return ", ".join(robots[:_MOST_ROBOTS]) + (f" and {more} more" if more > 0 else "")
