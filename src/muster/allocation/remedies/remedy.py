"""A remedy as data: the changes of rules with which a robot can do a task, and which of them are proven."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from muster.allocation.allocator import Routes, scheduled
from muster.allocation.bounds.feasibility import impossible
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster.model.rules import Change, all_rules
from muster.model.rules.capacity import CapacityChange


@dataclass(frozen=True)
class Before:
    """A prerequisite that the plan leaves out, and whether it is possible by itself."""

    task: str
    possible: bool


@dataclass(frozen=True, kw_only=True)
class Remedy:
    """What a robot needs to do a task in addition to all tasks of a plan.

    `changes`, by the words of rules, are what stands between the two by themselves, each of which is needed; and where
    times, teams or relations matter those of other rules with which a plan was found: others may be enough as well.
    `before` are the prerequisites that the plan leaves out.
    `enough` tells whether a plan with all this was found and judged; its routes are in `routes`. `unable` tells why the
    robot cannot do the task's action, whatever changes; empty if it can. `unreachable` tells that there is no way to
    the task, `impossible` that no capacity is enough beside the other changes: both are proven. Of many robots only
    those that seem to need least are `searched` for plans in which other tasks are moved. `calls` are those at stations
    that the robot makes in that plan, and not in the one without the task.
    """

    robot: str
    changes: Mapping[str, Change] = field(default_factory=dict)
    before: tuple[Before, ...] = ()
    unable: str = ""
    unreachable: bool = False
    impossible: bool = False
    searched: bool = True
    capacity: CapacityChange
    enough: bool = False
    calls: tuple[str, ...] = ()
    routes: tuple[Route, ...] = field(default=(), repr=False)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of change, by the words of rules."""
        return (
            *self.changes,
            *(("prerequisite",) if self.before else ()),
            *(("capacity",) if self.capacity.grows else ()),
        )

    @property
    def size(self) -> tuple[int, float, float]:
        """What changes are compared by: the number of kinds, the time they give, then the growth of the capacity."""
        grown = (self.capacity.enough or 0.0) - (self.capacity.now or 0.0) if self.capacity.grows else 0.0
        return len(self.kinds), sum(change.seconds for change in self.changes.values()), grown

    def as_dict(self) -> dict[str, Any]:
        """The remedy as plain data, with a key for each rule that robots can be changed for."""
        changes = {
            rule.key: self.changes[rule.word].plain if rule.word in self.changes else rule.no_change
            for rule in all_rules()
            if rule.key is not None
        }
        others = ("unable", "unreachable", "impossible", "searched")
        return {
            "robot": self.robot,
            **changes,
            "before": [asdict(before) for before in self.before],
            **{name: getattr(self, name) for name in others},
            "capacity": asdict(self.capacity),
            "enough": self.enough,
            **({"calls": list(self.calls)} if self.calls else {}),
            "routes": [asdict(route) for route in self.routes],
            "kinds": self.kinds,
        }


def as_they_are(problem: Problem, routes: Routes, j: int, robots: Iterable[int]) -> Iterator[Remedy]:
    """For each robot what stands between it and the task by themselves, and the prerequisites that are left out."""
    done, own, task = {k for route in routes for k in route}, problem.with_partner(j), problem.tasks[j]
    awaited = problem.closed([before for k in own for before in problem.prerequisites[k]])
    missing = [problem.tasks[k].id for k in awaited if k not in done and k not in own]
    never = {item.task for item in impossible(problem)} if missing else set()
    for i in robots:
        robot = problem.robots[i]
        changes = {rule.word: rule.change(problem, robot, task) for rule in problem.rules if rule.key is not None}
        yield Remedy(
            robot=robot.id,
            changes={word: change for word, change in changes.items() if change is not None},
            before=tuple(Before(name, name not in never) for name in missing),
            unable=problem.action_refusal(i, j) or "",
            capacity=CapacityChange.of(problem, i),
        )


def more_calls(problem: Problem, routes: Routes, plan: Plan, i: int) -> tuple[str, ...]:
    """The calls at stations of robot i in a plan that its route did not have: what it does, how long and where."""
    if not problem.stations:
        return ()
    before = [stop.name for stop in scheduled(problem, routes)[i].stops]
    found = []
    for stop in next(route for route in plan.routes if route.robot == problem.robots[i].id).stops:
        if not stop.is_station:
            continue
        if stop.name in before:
            before.remove(stop.name)
            continue
        found.append(f"{stop.said_of_station} of {stop.end_s - stop.begin_s:.0f} s at {stop.name}")
    return tuple(found)
