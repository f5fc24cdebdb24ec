"""The problem: a mission, an objective and the rules in force, compiled to arrays for the core."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.declared_rules import rules_in_order
from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import as_it_holds, ignored_rules
from muster.mission.model import OBJECTIVES, Mission, Robot, Task
from muster.mission.plan import tie_order
from muster.mission.supported_features import require_supported
from muster.mission.system.garbage import collector_paused
from muster.mission.value_types import shown
from muster.mission.values.arrays import Bools as Bools
from muster.mission.values.arrays import Floats as Floats
from muster.mission.values.arrays import Indices as Indices
from muster.model.core_arrays import core_arrays
from muster.model.measured_energy import Drains, EnergyLeft
from muster.model.parts import Begun, Parts, Service
from muster.model.plan_model import PlanModel
from muster.model.rules import Rule, all_rules
from muster.model.subproblem import cut_down
from muster.model.travel_and_work import TravelAndWork, floats

_IN_FILES = {"lags": "prerequisites with after_s or within_s"}  # what files call keys that have none of their own
_RETURN_ASKED = {"makespan-return": "objective makespan: makespan_includes_return"}


@dataclass(frozen=True, eq=False, kw_only=True)
class Problem(TravelAndWork):
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

    objective: str
    ignored: tuple[str, ...]
    fixed: tuple[tuple[int, ...], ...] = ()  # for each robot the tasks that its route begins with; empty: none at all
    energy_left: tuple[EnergyLeft | None, ...] = ()  # measured, for each robot; empty: none at all
    aboard: tuple[tuple[int, ...], ...] = ()  # for each robot the tasks that deliver what it has on board; empty: none
    levels: tuple[float, ...] = ()  # the energy of each robot at first, measured; inf: without bounds; empty: as stated
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

    def with_capacities(self, stated: Mapping[int, float | None]) -> Problem:
        """The problem with other work capacities of some robots; None: unlimited."""
        robots = list(self.robots)
        for i, capacity in stated.items():
            robots[i] = replace(robots[i], work_capacity=capacity)
        return replace(self, robots=tuple(robots))

    def capacity_for(self, usage: float) -> float:
        """The work capacity of which a route may use so much."""
        return usage / self.mission.rules.usable_share

    def holds(self, rule: str) -> bool:
        """Whether a rule of IGNORABLE holds."""
        return rule not in self.ignored

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
        return floats(sum(map(of, past.get(task.id, (task,)))) for task in self.tasks)

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
        rules, words, found = {rule.word: rule for rule in all_rules()}, self.model.parts.words, dict[str, str]()
        for rule in rules.values():
            for part, word in rule.asked.items():
                if getattr(self.model.parts, part):
                    found.setdefault(word, self._stated(part, rules.get(words.get(part, ""), rule)))
        late = {"lateness": "objective lateness"} if self.objective == "lateness" else {}
        return found | late | (_RETURN_ASKED if self._makespan_includes_ways_to_ends else {})

    def _stated(self, part: str, rule: Rule) -> str:
        """The first task or robot with a key by which a rule gives a primitive, and the key; without one its word."""
        given, declared = getattr(self.model.parts, part), rules_in_order().get(rule.word)
        keys = (rule.asked_by[part],) if part in rule.asked_by else declared.keys if declared else ()
        bearers: list[tuple[str, Sequence[Task | Robot]]] = [("task", self.tasks), ("robot", self.robots)]
        if isinstance(given, dict):  # by the number of a task or a robot
            first = min(given)
            bearers = [(what, some[first : first + 1]) for what, some in bearers] + bearers
        stated = ((what, one.id, key) for what, some in bearers for one in some for key in keys if one.states(key))
        found = (f"{what} {name}: {_IN_FILES.get(key, key)}" for what, name, key in stated)
        return next(found, f"rule {rule.word}")

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
        for rule in self._refusing:
            detail = rule.refusal(self, i, j)
            if detail is not None:
                return rule.word, detail
        return None

    @cached_property
    def _refusing(self) -> tuple[Rule, ...]:
        """The rules that hold and refuse pairs of a robot and a task."""
        return tuple(rule for rule in self.rules if type(rule).refusal is not Rule.refusal)

    @cached_property
    def rules(self) -> tuple[Rule, ...]:
        """The rules that hold."""
        return tuple(rule for rule in all_rules() if not rule.ignorable or self.holds(rule.word))

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
        rows = {kind: floats(scores.get(t.type or "", 0.0) for t in self.tasks) for kind, scores in table.items()}
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
            speed=floats(r.speed_mps for r in self.robots),
            available_from=floats(r.available_from_s for r in self.robots),
            must_end=must_end,
            fixed=np.array([len(self.beginning(i)) for i in range(len(self.robots))], dtype=np.int32),
            actuation_cost=measured.costs,
            work_class=measured.work_classes,
            work_seconds=self._work_times[0],
            time_class=self._work_times[1],
            priority=floats(t.priority for t in self.tasks),
            allowed=self.allowed_by_kind,
            kind=self.kinds,
            prerequisites=self.model.awaited,
            entry=self._entries,
            exit=self._exits,
            place_class=self._task_geometry.classes,
            table=measured.table,
            travel_class=measured.classes,
            seconds=measured.seconds,
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
        objective = core.Inspection(self.core, [list(route) for route in routes]).objective
        if objective is None:  # routes of a function from elsewhere
            raise ParameterError("routes: tasks wait for each other for ever; expected orders in which all can begin")
        return self.weight(routes), objective

    def weight(self, routes: Sequence[Sequence[int]]) -> float:
        """Weight of the tasks of routes."""
        return sum(self.tasks[j].priority for j in sorted({j for route in routes for j in route}))

    def back(self, i: int, end_s: float, j: int) -> float:
        """When robot i, which ends work on its last task j at a time, is at the end of its route."""
        if self.robots[i].place_at_end(self.mission.rules) is None:
            return end_s
        way = self.travel_seconds(i, [j], [self.end(i)])[0]
        return float((self.model.set_out(i, np.array([end_s]), way) + way)[0])
