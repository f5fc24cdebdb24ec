"""The problem: a mission, an objective and the rules in force, compiled to arrays for the core."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.declared_rules import rules_in_order
from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import as_it_holds, ignored_rules
from muster.mission.model import OBJECTIVES, Mission, Point, Robot, Station, Task
from muster.mission.plan import tie_order
from muster.mission.supported_features import require_supported
from muster.mission.system.garbage import collector_paused
from muster.mission.value_types import shown
from muster.model.core_arrays import core_arrays
from muster.model.lengths import Measured
from muster.model.measured_energy import Drains, EnergyLeft
from muster.model.parts import Begun, Parts, Service
from muster.model.plan_model import PlanModel
from muster.model.rules import Rule, all_rules
from muster.model.subproblem import cut_down
from muster.model.task_geometry import TaskGeometry
from muster.model.travel import require_room, straight_table, travel_table
from muster.model.waiting import NO_WAITING, Waiting
from muster.model.work_times import work_times
from muster.motion.actions import duration_of
from muster.motion.leg_times import LegTimes
from muster.motion.map_world import body_of

if TYPE_CHECKING:
    from muster.model.map_travel import MapTravel
    from muster.motion.paths.robot_paths import RobotPaths

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]

_RETURN_ASKED = {"makespan-return": "objective makespan: makespan_includes_return"}


@dataclass(frozen=True, eq=False)
class Problem:
    """What an allocator solves. Immutable.

    Robots (m) and tasks (n) stand in the order that breaks ties, so that the lower index always wins one.

    Parameters
    ----------
    mission
        the question.
    objective
        one of OBJECTIVES; the mission's own by default.
    ignored
        rules that do not hold, of IGNORABLE.

    Robots may have tasks that stay where they are, at the beginning of their routes: see `fixed.with_fixed_routes`.

    Raises
    ------
    ParameterError
        for an unknown objective or rule.
    NotSupportedError
        for a mission that asks for what is not supported yet (see `require_supported`).
    """

    mission: Mission
    objective: str
    ignored: tuple[str, ...]
    robots: tuple[Robot, ...]
    tasks: tuple[Task, ...]
    fixed: tuple[tuple[int, ...], ...] = ()  # for each robot the tasks that its route begins with; empty: none at all
    known: Measured | None = None  # what the problem of which this is a part knew
    energy_left: tuple[EnergyLeft | None, ...] = ()  # measured, for each robot; empty: none at all
    aboard: tuple[tuple[int, ...], ...] = ()  # for each robot the tasks that deliver what it has on board; empty: none
    levels: tuple[float, ...] = ()  # the energy of each robot at first, measured; inf: without bounds; empty: as stated
    mapped: RobotPaths | None = None  # over the mission's map, as far as they are known already
    waiting: Waiting = NO_WAITING  # that is expected on ways
    past: Mapping[str, tuple[Task, ...]] | None = None  # of tasks that stand for what was done, that; None: it begins
    begun: tuple[Begun, ...] = ()  # for each robot of a mission under way; empty: it begins
    sooner: tuple[float, ...] = ()  # for each task when it must have ended, beside what rules say; empty: none

    @classmethod
    def compile(cls, mission: Mission, objective: str | None = None, ignored: str | Collection[str] = ()) -> Problem:
        objective = mission.rules.objective if objective is None else objective
        if objective not in OBJECTIVES:
            raise ParameterError(f"objective: {shown(objective)}; expected {' or '.join(OBJECTIVES)}")
        require_supported(mission)
        ignored = ignored_rules(ignored)
        if "lock" in ignored:  # taken off the tasks, as planning makes locks of its own
            mission = replace(
                mission,
                tasks=tuple(as_it_holds(task, ("lock",)) for task in mission.tasks),
                stations=tuple(as_it_holds(station, ("lock",)) for station in mission.stations),
            )
        return cls(
            mission=mission,
            objective=objective,
            ignored=ignored,
            robots=tuple(mission.robots[k] for k in tie_order([r.id for r in mission.robots])),
            tasks=tuple(mission.tasks[k] for k in tie_order([t.id for t in mission.tasks])),
        )

    @collector_paused()
    def ready(self) -> Problem:
        """The problem itself with its arrays computed, so that the time of an allocator does not include it."""
        assert self.core is not None
        return self

    def part(self, robots: Sequence[int], tasks: Sequence[int]) -> Problem:
        """The problem of some robots (at least one) and tasks, in ascending order; none may wait for one outside.

        Of the mission it has what these need and no more (see `cut_down`).
        """
        own, work = tuple(self.robots[i] for i in robots), tuple(self.tasks[j] for j in tasks)
        number_in = {j: k for k, j in enumerate(tasks)}
        fixed = tuple(tuple(number_in[j] for j in self.fixed[i]) for i in robots) if self.fixed else ()
        n, m = len(self.tasks), len(self.robots)
        stations = range(n + 2 * m, n + 2 * m + len(self.stations))
        places = [*tasks, *(n + i for i in robots), *(n + m + i for i in robots), *stations]
        known = None
        if self.known is not None or self.has_paths:
            known = self.measured.part(robots, places, tasks)
        return replace(
            self,
            mission=cut_down(self.mission, own, work),
            robots=own,
            tasks=work,
            fixed=fixed,
            energy_left=tuple(self.energy_left[i] for i in robots) if self.energy_left else (),
            aboard=tuple(tuple(number_in[j] for j in self.aboard[i]) for i in robots) if self.aboard else (),
            levels=tuple(self.levels[i] for i in robots) if self.levels else (),
            known=known,
            waiting=self.waiting.part(robots, places),
            begun=tuple(self.begun[i] for i in robots) if self.begun else (),
            sooner=tuple(self.sooner[j] for j in tasks) if self.sooner else (),
        )

    def __getstate__(self) -> dict[str, Any]:
        """The fields alone; everything derived is computed again where the problem is unpickled."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    @property
    def places(self) -> tuple[Floats, Floats]:
        """Where tasks are entered, (n, 3), and robots start, (m, 3), in metres of the map frame.

        Where that depends on the robot, for one of them.
        """
        n, m = len(self.tasks), len(self.robots)
        return self._entries[0, :n], self._entries[0, n : n + m]

    @property
    def all_places(self) -> Floats:
        """(2n + 4m, 3) where tasks are entered and left, robots start and routes end; for one of the robots."""
        return np.concatenate([self._entries[0], self._exits[0]])

    def holds(self, rule: str) -> bool:
        """Whether a rule of IGNORABLE holds."""
        return rule not in self.ignored

    @cached_property
    def task_index(self) -> dict[str, int]:
        return {task.id: j for j, task in enumerate(self.tasks)}

    @cached_property
    def robot_index(self) -> dict[str, int]:
        return {robot.id: i for i, robot in enumerate(self.robots)}

    @cached_property
    def model(self) -> PlanModel:
        """What the rules in force come to."""
        over = {self.task_index[name] for name in self.past or ()}
        parts = Parts(len(self.robots), len(self.tasks), dict(enumerate(self.begun)), over)
        for rule in self.rules:
            parts.rule = rule.word
            rule.compile(self, parts)
            parts.named(rule.word)
        parts.rule = ""
        for j, latest_s in enumerate(self.sooner):
            parts.ends(j, latest_s)
        due = np.array([math.inf if task.due_s is None else task.due_s for task in self.tasks])
        return PlanModel(parts, due, tuple(map(Service.of, self.stations)))

    def amounts(self, of: Callable[[Task], float]) -> Floats:
        """(n,) an amount of each task; of one that stands for what a robot has done so far, what that sums to."""
        past = self.past or {}
        return _floats(sum(map(of, past.get(task.id, (task,)))) for task in self.tasks)

    @property
    def capacity(self) -> Floats:
        """(m,) the most usage of a robot; inf where unlimited."""
        return self.model.capacity

    @cached_property
    def prerequisites(self) -> list[list[int]]:
        """For each task those before it, but one that is so only as it takes on what the task delivers."""
        pairs = zip(self.model.awaited, self.model.pickups, strict=True)
        return [
            [k for k in before if k != pickup or self.tasks[k].id in self.tasks[j].prerequisites]
            for j, (before, pickup) in enumerate(pairs)
        ]

    def with_partner(self, j: int) -> tuple[int, ...]:
        """A task, with all that can only be done together with it where transports are among them, in order.

        Those are the other task of its transport, what begins with either, and what waits for one of them while
        another waits for it.
        """
        partners = self.model.partners
        tied = self.closed([j]) if self.model.parts.taken_on_by else []
        whole = [k for k in tied if j in self.closed([k])]
        if all(partners[k] is None for k in whole):
            return (j,)
        ordered: list[int] = []
        while len(ordered) < len(whole):
            left = [k for k in whole if k not in ordered]
            free = [k for k in left if not set(self.model.awaited[k]).intersection(left)]
            ordered.append(min(free or left))
        return tuple(ordered)

    def closed(self, tasks: Iterable[int]) -> list[int]:
        """Tasks with all that must come before them, begin with them or deliver their goods, in order."""
        needed, model = set(tasks), self.model
        waiting = list(needed)
        while waiting:
            j = waiting.pop()
            partner = model.partners[j]
            new = {*self.prerequisites[j], *model.beginning_with(j), *([] if partner is None else [partner])} - needed
            needed |= new
            waiting += new
        return sorted(needed)

    @cached_property
    def asked(self) -> Mapping[str, str]:
        """What not every allocator can do, and the problem asks for: each with the place that does so first."""
        word_of = {primitive: word for rule in all_rules() for primitive, word in rule.asked.items()}
        given = {word_of[part]: rule for part, rule in self.model.parts.words.items() if part in word_of}
        asks = ((rule.word, word, where) for rule in all_rules() for word, where in rule.asks(self).items())
        said = {word: where for rule, word, where in asks if where is not None and given.get(word, rule) == rule}
        found = said | {word: self._stated(rule) for word, rule in given.items() if word not in said}
        late = {"lateness": "objective lateness"} if self.objective == "lateness" else {}
        return found | late | (_RETURN_ASKED if self._makespan_includes_ways_to_ends else {})

    def _stated(self, rule: str) -> str:
        """The first robot or task with a key that a rule declares, and the key; without one its word."""
        found = (
            f"{what} {one.id}: {key}"
            for what, team in (("robot", self.robots), ("task", self.tasks))
            for one in team
            for key in one.extra
            if key in rules_in_order()[rule].keys
        )
        return next(found, f"rule {rule}")

    @property
    def _makespan_includes_ways_to_ends(self) -> bool:
        rules = self.mission.rules
        with_ends = any(robot.place_at_end(rules) is not None for robot in self.robots)
        return self.objective == "makespan" and rules.makespan_includes_return and with_ends

    @property
    def has_timed_rules(self) -> bool:
        """Whether anything but prerequisites depends on times, teams, relations or on what a whole route is."""
        return bool(self.asked.keys() - _RETURN_ASKED.keys())

    @cached_property
    def dependants(self) -> list[list[int]]:
        """For each task the indices of the tasks that wait for it."""
        waiting: list[list[int]] = [[] for _ in self.tasks]
        for j, before in enumerate(self.prerequisites):
            for k in before:
                waiting[k].append(j)
        return waiting

    def beginning(self, i: int) -> tuple[int, ...]:
        """The tasks that robot i's route begins with, whatever follows."""
        return self.fixed[i] if self.fixed else ()

    @cached_property
    def drains(self) -> Drains:
        """What routes use up of the energy of robots, as measured where it was."""
        return Drains.of(self.energy_left, self.capacity)

    def may(self, i: int, j: int) -> bool:
        """Whether robot i may do task j: skills, suitability, locks, and what its action asks for."""
        return bool(self.allowed_by_kind[self.kinds[i], j])

    def refusal(self, i: int, j: int) -> tuple[str, str] | None:
        """Why robot i may not do task j whatever its route (reason, detail); None if it may."""
        for rule in self.rules:
            detail = rule.refusal(self, i, j)
            if detail is not None:
                return rule.word, detail
        return None

    @cached_property
    def rules(self) -> tuple[Rule, ...]:
        """The rules that hold."""
        return tuple(rule for rule in all_rules() if not rule.ignorable or self.holds(rule.word))

    def action_refusal(self, i: int, j: int) -> str | None:
        """Why robot i cannot do the action of task j, whatever the rules; None if it can."""
        return self._task_geometry.refusal(i, j)

    def actions_refused(self, i: int) -> frozenset[int]:
        """The tasks whose actions robot i cannot do."""
        return self._task_geometry.refused(i)

    @cached_property
    def allowed(self) -> Bools:
        """(m, n) whether robot i may do task j: skills, suitability, locks. Of a large team that is a large table."""
        return self.allowed_by_kind[self.kinds]

    @cached_property
    def kinds(self) -> npt.NDArray[np.int32]:
        """(m,) kinds of robots: of one kind are those that may do the same tasks for the same reasons."""
        number = {key: k for k, key in enumerate(self._robots_by_kind)}
        return np.array([number[key] for key in self._kind_keys], dtype=np.int32)

    @cached_property
    def allowed_by_kind(self) -> Bools:
        """(kinds, n) whether a robot of a kind may do a task."""
        rows = [self._allowed_row(i) for i in self._robots_by_kind.values()]
        return np.array(rows, dtype=np.bool_).reshape(len(rows), len(self.tasks))

    @cached_property
    def _robots_by_kind(self) -> dict[tuple[object, ...], int]:
        """The first robot of each kind."""
        first: dict[tuple[object, ...], int] = {}
        for i, key in enumerate(self._kind_keys):
            first.setdefault(key, i)
        return first

    @cached_property
    def _kind_keys(self) -> list[tuple[object, ...]]:
        columns = [kinds for rule in all_rules() if (kinds := rule.kinds(self)) is not None]
        return list(zip(*columns, strict=True))

    def _allowed_row(self, i: int) -> Bools:
        return np.array([self.refusal(i, j) is None for j in range(len(self.tasks))], dtype=np.bool_)

    @cached_property
    def suitability(self) -> Floats:
        """(m, n) score of each robot's type for each task's type; 1 where no table is given."""
        table = self.mission.suitability
        if table is None:
            return np.ones((len(self.robots), len(self.tasks)))
        rows = {kind: _floats(scores.get(t.type or "", 0.0) for t in self.tasks) for kind, scores in table.items()}
        return np.array([rows[r.type or ""] for r in self.robots]).reshape(len(self.robots), len(self.tasks))

    @cached_property
    def core_of_greatest_usage(self) -> core.Problem | None:
        """The problem with objective `max` that has the same plans and values, where its own is `makespan`.

        None where it is another, or something else decides too: prerequisites, times, capacities, robots that come
        later.
        """
        free = not self.has_timed_rules and not self._makespan_includes_ways_to_ends and not any(self.prerequisites)
        begins = all(robot.available_from_s == 0 for robot in self.robots)
        if self.objective != "makespan" or not free or not begins or np.isfinite(self.capacity).any():
            return None
        return self._core("max", in_time=True, must_end=np.zeros(len(self.robots), dtype=np.bool_))

    def _core(self, objective: str, in_time: bool, must_end: Bools) -> core.Problem:
        measured = self.measured
        return core.Problem(
            objective=objective,
            usage_is_time=in_time,
            capacity=self.capacity,
            speed=_floats(r.speed_mps for r in self.robots),
            available_from=_floats(r.available_from_s for r in self.robots),
            must_end=must_end,
            fixed=np.array([len(self.beginning(i)) for i in range(len(self.robots))], dtype=np.int32),
            actuation_cost=measured.costs,
            work_class=measured.work_classes,
            work_seconds=self._work_times[0],
            time_class=self._work_times[1],
            priority=_floats(t.priority for t in self.tasks),
            allowed=self.allowed_by_kind,
            kind=self.kinds,
            prerequisites=self.model.awaited,
            entry=self._entries,
            exit=self._exits,
            place_class=self._task_geometry.classes,
            table=measured.table,
            travel_class=measured.classes,
            **core_arrays(self, self.leg_times),
            waiting=self.waiting.seconds,
            waits=self.waiting.robots,
        )

    @cached_property
    def core(self) -> core.Problem:
        """The problem as the core holds it."""
        must_end = np.array([r.place_at_end(self.mission.rules) is not None for r in self.robots], dtype=np.bool_)
        return self._core(self.objective, self.in_time, must_end)

    @cached_property
    def travel(self) -> tuple[Floats, npt.NDArray[np.int32]]:
        """Travel tables and each robot's table; empty where travel is straight.

        The table is (classes, n + 2m, n + 2m) metres between tasks, starts and ends of robots, inf where there is no
        way.
        """
        return self.measured.table, self.measured.classes

    @property
    def work_classes(self) -> npt.NDArray[np.int32]:
        """(m,) of one class are robots for which every task costs the same metres."""
        return self.measured.work_classes

    @cached_property
    def measured(self) -> Measured:
        if self.known is not None:
            return self.known
        geometry, none = self._task_geometry, np.empty(0, dtype=np.int32)
        if self.has_paths:
            return self._over_map.measured(os.cpu_count() or 1)
        if self.mission.travel_rule == "matrix":
            table, classes = travel_table(self.mission, self.robots, self.tasks)
        else:
            table = straight_table(self.mission, self._exits, self._entries)
            classes = geometry.classes if len(table) else none
        legs = geometry.legs(lambda _, leg: math.dist(*leg))
        return Measured(table, classes, geometry.costs, geometry.classes, legs)

    @cached_property
    def _task_geometry(self) -> TaskGeometry:
        return TaskGeometry.of(self.robots, self.tasks, by_body=self.has_paths)

    @cached_property
    def has_paths(self) -> bool:
        """Whether legs are paths over the map: shortest ones, or straight ones that closed areas may cross."""
        if not self.mission.has_straight_legs_among_areas:
            return self.mission.travel_rule == "map"
        return not all(self.robot_paths.is_open(body_of(robot), self._all_points) for robot in self.robots)

    @cached_property
    def _all_points(self) -> Floats:
        """(k, 3) metres, map frame: where legs and the work on tasks begin and end."""
        geometry = TaskGeometry.of(self.robots, self.tasks, by_body=False)
        passed = [(*point, 0.0)[:3] for doing in geometry.moving.values() for point in doing.points]
        places = [self._with_robots(geometry.entries), self._with_robots(geometry.exits), np.array(passed, np.float64)]
        return np.concatenate([part.reshape(-1, 3) for part in places])

    @cached_property
    def robot_paths(self) -> RobotPaths:
        """Over the mission's map."""
        from muster.motion.paths.robot_paths import RobotPaths

        return RobotPaths.of(self.mission) if self.mapped is None else self.mapped

    @cached_property
    def _over_map(self) -> MapTravel:
        require_room(self.mission, self._exits.shape[1], "travel over a map")
        return self.over(self.robot_paths)

    def over(self, robot_paths: RobotPaths) -> MapTravel:
        """Travel between the places by paths over the map, whatever the mission's rule."""
        from muster.model.map_travel import MapTravel

        geometry = self._task_geometry if self.has_paths else TaskGeometry.of(self.robots, self.tasks, by_body=True)
        exits, entries = self._with_robots(geometry.exits), self._with_robots(geometry.entries)
        return MapTravel.of(robot_paths, self.robots, geometry, exits, entries)

    def no_way_to(self, i: int, j: int) -> str:
        """Why robot i has no path to task j, or along its way points."""
        if self.known is not None or not self.has_paths:
            return "there is no way to it"
        return self._over_map.why_not(i, self.start(i), j)

    @cached_property
    def _duration(self) -> Floats:
        return _floats(math.nan if (d := duration_of(t)) is None else d for t in self.tasks)

    @cached_property
    def _entries(self) -> Floats:
        """(classes, n + 2m, 3) metres, map frame: where tasks are entered, robots start and routes end."""
        return self._with_robots(self._task_geometry.entries)

    @cached_property
    def _exits(self) -> Floats:
        """(classes, n + 2m, 3) metres, map frame: where tasks are left, robots start and routes end."""
        return self._with_robots(self._task_geometry.exits)

    def _with_robots(self, portals: Floats) -> Floats:
        places = np.array([(*p, 0.0)[:3] for p in self._robots_places], dtype=np.float64)
        return np.concatenate([portals, np.broadcast_to(places, (len(portals), *places.shape))], axis=1)

    @property
    def _robots_places(self) -> list[Point]:
        ends = [r.place_at_end(self.mission.rules) or r.position for r in self.robots]
        return [*(r.position for r in self.robots), *ends, *(station.position for station in self.stations)]

    @property
    def stations(self) -> tuple[Station, ...]:
        return self.mission.stations

    @cached_property
    def energy_reaches(self) -> Bools:
        """(m, n) whether a robot's energy may last for a task, as far as these two alone tell."""
        from muster.model.energy_reach import energy_reaches

        return energy_reaches(self)

    def value(self, routes: Sequence[Sequence[int]]) -> tuple[float, float]:
        """Weight completed and objective of routes, which need not be admissible.

        Raises
        ------
        ParameterError
            if they deadlock, so that an objective of time has no value.
        """
        weight = sum(self.tasks[j].priority for j in sorted({j for route in routes for j in route}))
        objective = core.Inspection(self.core, [list(route) for route in routes]).objective
        if objective is None:  # routes of a function from elsewhere
            raise ParameterError("routes: tasks wait for each other for ever; expected orders in which all can begin")
        return weight, objective

    @property
    def in_time(self) -> bool:
        """Whether usage is time."""
        return self.mission.rules.usage == "time"

    @property
    def usage_unit(self) -> str:
        return "s" if self.in_time else "m"

    def start(self, i: int) -> int:
        """The place where robot i starts."""
        return len(self.tasks) + i

    def end(self, i: int) -> int:
        """The place where robot i's route ends, if it must end somewhere."""
        return len(self.tasks) + len(self.robots) + i

    @cached_property
    def leg_times(self) -> tuple[LegTimes, ...]:
        """For each robot how long legs take."""
        over_map = self.mission.travel_rule == "map" if self.known is None else self.known.over_map
        return tuple(LegTimes.of(robot, self.mission.rules, over_map=over_map) for robot in self.robots)

    def metres(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        """(len(places), len(to)) metres that robot i travels between places."""
        table, classes = self.travel
        if len(table):
            return np.asarray(table[classes[i]][np.asarray(places, np.int64)[:, None], np.asarray(to, np.int64)[None]])
        return np.asarray(np.linalg.norm(self._exits[0, places][:, None] - self._entries[0, to][None], axis=2))

    def legs(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        """(len(places), len(to)) travel usage of robot i between places."""
        if self.in_time:
            return self.travel_seconds(i, places, to)
        waits_m = self.waiting.of(i, places, to) * self.robots[i].speed_mps
        return np.asarray(self.metres(i, places, to) + waits_m)

    def travel_seconds(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        """(len(places), len(to)) the time that robot i takes between places."""
        return np.asarray(self._driving_seconds(i, places, to) + self.waiting.of(i, places, to))

    def _driving_seconds(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        metres, profile = self.metres(i, places, to), self.leg_times[i]
        if profile.is_constant:
            return np.asarray(metres / profile.speed_mps)
        k = self._task_geometry.classes[i]
        apart = self._entries[k, to][None] - self._exits[k, places][:, None]
        return np.asarray(profile.seconds(metres, np.abs(apart[..., 2]), np.linalg.norm(apart, axis=2)))

    def back(self, i: int, end_s: float, j: int) -> float:
        """When robot i, which ends work on its last task j at a time, is at the end of its route."""
        if self.robots[i].place_at_end(self.mission.rules) is None:
            return end_s
        way = self.travel_seconds(i, [j], [self.end(i)])[0]
        return float((self.model.set_out(i, np.array([end_s]), way) + way)[0])

    def work_usage(self, i: int) -> Floats:
        """(n,) usage of robot i for the work of each task."""
        return self.work_seconds(i) if self.in_time else self._work_metres(i)

    def work_seconds(self, i: int) -> Floats:
        """(n,) the time that robot i takes for the work of each task."""
        seconds, classes = self._work_times
        return np.asarray(seconds[classes[i]])

    @cached_property
    def _work_times(self) -> tuple[Floats, npt.NDArray[np.int32]]:
        return work_times(self.robots, self._duration, self.leg_times, self._task_geometry, self.measured)

    def _work_metres(self, i: int) -> Floats:
        measured = self.measured
        return np.asarray(measured.costs[measured.work_classes[i]])

    def shortcuts(self) -> Indices:
        """Tasks through which a way can be shorter than the direct one."""
        return self._shortcuts

    @cached_property
    def _shortcuts(self) -> Indices:
        if len(self.travel[0]) or len(self.waiting.seconds):
            return np.arange(len(self.tasks))
        n = len(self.tasks)
        return np.flatnonzero((self._entries[0, :n] != self._exits[0, :n]).any(axis=1))


def _floats(values: Iterable[float]) -> Floats:
    return np.array(list(values), dtype=np.float64)
