"""What one more task in the routes of a plan would do where times, teams and relations matter."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

from muster import core
from muster.allocation.bounds.route_bounds import RouteBounds
from muster.allocation.reasons.timed_teams import Member, TimedTeams
from muster.model.problem import Problem
from muster.model.rules import Rule
from muster.model.rules.rule import InPlan, Tried

_TIES = ("together", "same_crew", "apart")
"""What ties tasks to others by their robots or begins."""

_MOST_PLACES = 400  # of a team, the earliest first, that are looked at
_MOST_TEAMS = 60
_MOST_OF_WHOLE = 2_000  # ways to place inseparable tasks
_LEAST_PLACES = 10  # that take the time in which the problem is compiled without some rules


@dataclass(frozen=True)
class Place:
    """A way to put a task, with all that begins together with it, into routes.

    `at` is its index in the route of the robot that was asked about.
    """

    at: int
    routes: list[list[int]]


@dataclass(frozen=True)
class Outcome:
    """The best admissible place, with the usage of the robot; or the rule that leaves none, and how.

    Without a place and a rule not all places were looked at, and none of those that were is admissible.
    """

    place: Place | None = None
    usage: float = math.inf
    word: str = ""
    detail: str = ""


class TimedPlaces(TimedTeams):
    """All places of a task in routes, by trial."""

    def __init__(self, problem: Problem, routes: Sequence[Sequence[int]]) -> None:
        super().__init__(problem, routes)
        self._looked_at_some = set[tuple[int, int]]()  # pairs of which not all places are looked at
        self.outcome = cache(self._outcome)
        self._word_of = problem.model.word_of
        self.without = cache(self._without)
        self.bounds_without = cache(lambda words: RouteBounds(self.without(words)))

    def effort(self, j: int) -> float:
        """How many stops are passed, about, to look at a task at every place of every robot that may do it."""
        problem, whole = self.problem, self.problem.with_partner(j)
        able = (i for i in range(len(problem.robots)) if problem.may(i, j))
        places = sum(_LEAST_PLACES + self._places_at_most(len(self._gaps(i)), whole) for i in able)
        return float(places * len(problem.tasks))

    def _places_at_most(self, gaps: int, whole: Sequence[int]) -> int:
        """How many places of inseparable tasks are looked at, of a robot whose route has so many gaps."""
        rules = self.problem.model
        if any(rules.is_for_team(k) or rules.beginning_with(k) for k in whole) or len(whole) > 2:
            return _MOST_PLACES if len(whole) == 1 else _MOST_OF_WHOLE
        return gaps if len(whole) == 1 else gaps * (gaps + 1) // 2

    def with_task(self, i: int, j: int, at: int) -> list[list[int]]:
        place = self.outcome(i, j).place
        assert place is not None  # as `at` is its place
        return [list(route) for route in place.routes]

    def kept_out(self, word: str, i: int, j: int) -> str | None:
        found = self.outcome(i, j)
        return found.detail if found.word == word else None

    @cached_property
    def _lifted(self) -> dict[str, Rule]:
        """The rules that are looked at one after the other, in the order of rules."""
        return {rule.word: rule for rule in self.problem.rules if rule.lifted_late}

    def _outcome(self, i: int, j: int) -> Outcome:
        """The place of task j with the least usage of robot i, or why there is none."""
        if missing := self._left_out_with(j):
            return Outcome(word=self._word_of(*_TIES), detail=missing)
        if missing := self._transport_lacks(i, j):
            return Outcome(word=self._word_of_whole(j), detail=missing)
        places = self.places(i, j)
        best = min(self._admissible(self.problem, places), key=lambda one: one[1].usages[i], default=None)
        if best is not None:
            return Outcome(best[0], best[1].usages[i])
        if (i, j) in self._looked_at_some:
            return Outcome()
        if not places:
            detail = "no team for it keeps its relations to the tasks of the plan"
            return Outcome(word=self._word_of(*_TIES), detail=detail)
        return self._refused(i, j, places)

    def _left_out_with(self, j: int) -> str:
        """What the tasks that begin together with a task lack; empty: nothing."""
        problem, whole = self.problem, self.problem.with_partner(j)
        for k in problem.model.beginning_with(j):
            if k in self.done:
                continue
            before = [problem.tasks[b].id for b in problem.prerequisites[k] if b not in self.done and b not in whole]
            if before:
                return f"begins together with {problem.tasks[k].id}; left out before that: {', '.join(before)}"
        return ""

    def _word_of_whole(self, j: int) -> str:
        """The rule by which a task can only be done together with the tasks of a transport."""
        if self.problem.model.partners[j] is not None:
            return self._word_of("taken_on_by")
        return self._word_of(*(_TIES if self.problem.model.beginning_with(j) else ("gaps",)))

    def _transport_lacks(self, i: int, j: int) -> str:
        """What keeps robot i from the other task of a transport; empty: nothing."""
        problem, other, whole = self.problem, self.problem.model.partners[j], self.problem.with_partner(j)
        if other is not None and (not problem.may(i, other) or not self._keeps_relations(i, other)):
            return f"comes with {problem.tasks[other].id}, which it cannot do"
        for one in whole if len(whole) > 1 else ():
            before = [problem.tasks[k].id for k in problem.prerequisites[one] if k not in self.done and k not in whole]
            if before and one != j:
                return f"comes with {problem.tasks[one].id}; left out before that: {', '.join(before)}"
        return ""

    @staticmethod
    def _admissible(problem: Problem, places: Iterable[Place]) -> list[tuple[Place, core.Inspection]]:
        tried = ((place, core.Inspection(problem.core, place.routes)) for place in places)
        return [(place, found) for place, found in tried if found.admissible]

    # --- the rule that leaves no place -------------------------------------------------------------------------------

    def _refused(self, i: int, j: int, places: list[Place], unproven: Sequence[str] = ()) -> Outcome:
        """The first rule with which, beside those before it, no place is left.

        Rules that are not proven to be broken, as other calls at stations may keep them, are looked away from.
        """
        words = tuple(word for word in self._lifted if word not in unproven)
        left = self._admissible(self.without((*words, *unproven)), places)
        if not left:
            return self._no_order(i, j, places)
        for at, word in enumerate(words):
            others = (*words[at + 1 :], *unproven)
            before, left = left, self._admissible(self.without(others), [place for place, _ in left])
            if left:
                continue
            if self._lifted[word].kept_by_calls and not self._is_proven(others, before):
                return self._refused(i, j, places, (*unproven, word))
            tie = self._tie_to_others(j)
            if tie and not self._lifted[word].concerns(self.problem, j):
                detail = f"at every place in its route the tasks that come with it would break the rule {word}"
                return Outcome(word=tie, detail=detail)
            if tie and not self._is_by_itself(word, i, j, before):
                detail = f"at every place in its route another robot that it needs would break the rule {word}"
                return Outcome(word=tie, detail=detail)
            tried = Tried(self.problem, i, j, [(place.routes, found) for place, found in before])
            return Outcome(word=word, detail=self._lifted[word].broken_at(tried))
        assert unproven  # or a place that keeps all rules would be admissible
        return Outcome()

    def _is_proven(self, others: Sequence[str], left: list[tuple[Place, core.Inspection]]) -> bool:
        """Whether at each place a robot cannot do its route, wherever it calls at stations, `others` not holding."""
        if not self.problem.stations:
            return True
        bounds = self.bounds_without(tuple(others))
        return all(
            any(bounds.excludes(k, route) for k, route in enumerate(place.routes) if route != self.routes[k])
            for place, _ in left
        )

    def _tie_to_others(self, j: int) -> str:
        """The rule by which other robots must do something beside one that does a task; empty: none."""
        rules = self.problem.model
        if rules.beginning_with(j):
            return self._word_of(*_TIES)
        if rules.is_for_team(j):
            return self._word_of("seats", "sums")
        if len(self.problem.with_partner(j)) > 2:
            return self._word_of_whole(j)
        return ""

    def _is_by_itself(self, word: str, i: int, j: int, left: list[tuple[Place, core.Inspection]]) -> bool:
        """Whether a rule is broken at all places by the route of robot i, whatever the others do."""
        rule = self._lifted[word]
        if not rule.of_a_route or (rule.of_the_team and len(self.problem.with_partner(j)) <= 2):
            return True
        problem = self.problem
        others = tuple(one.word for one in problem.rules if one.word != word)
        alone = replace(problem, ignored=(*problem.ignored, *others), fixed=(), known=problem.measured)
        own = ([place.routes[i] if k == i else [] for k in range(len(self.routes))] for place, _ in left)
        return not any(core.Inspection(alone.core, routes).admissible for routes in own)

    def _without(self, words: Sequence[str]) -> Problem:
        """The problem in which some rules leave every place, and no more of them than that is missing."""
        problem = self.problem
        ignored, tasks, robots = list(problem.ignored), problem.tasks, problem.robots
        for word in words:
            left, staying = self._lifted[word].without_limit(tasks), self._lifted[word].without_end(robots)
            if left is None and staying is None:
                ignored.append(word)
            tasks, robots = left or tasks, staying or robots
        if not words:
            return problem
        return replace(problem, ignored=tuple(ignored), tasks=tasks, robots=robots, known=problem.measured)

    def _no_order(self, i: int, j: int, places: list[Place]) -> Outcome:
        """Why no place is left whatever the times and capacities."""
        free = self.without(tuple(self._lifted))
        usages = [core.Inspection(free.core, place.routes).usages for place in places]  # finite in a circle
        if any(math.isinf(used[i]) for used in usages):
            return Outcome(word="unreachable", detail=self.problem.no_way_to(i, j))
        if any(map(math.isinf, itertools.chain.from_iterable(usages))):
            return Outcome(word="unreachable", detail="there is no way for another robot of its team")
        for rule in self.problem.rules:
            patient = None if rule.lifted_late else rule.without_limit(free.tasks)
            if patient and self._admissible(replace(free, tasks=patient, known=free.measured), places):
                return Outcome(word=rule.word, detail=rule.broken_at(Tried(self.problem, i, j, [])))
        detail = "at every place in its route tasks would wait for each other in a circle"
        return Outcome(word="prerequisite", detail=detail)

    # --- places ------------------------------------------------------------------------------------------------------

    def places(self, i: int, j: int) -> list[Place]:
        """Ways to put task j into the route of robot i; of teams those that can begin first."""
        whole = self.problem.with_partner(j)
        if len(whole) > 1:
            return self._of_whole(i, j, whole)
        found: list[Place] = []
        for number, team in enumerate(self._teams(i, j)):
            if number == _MOST_TEAMS:
                self._looked_at_some.add((i, j))
                break
            gaps = [self._gaps(robot) for robot, _ in team]
            if len(team) == 1:
                combinations: Iterable[tuple[int, ...]] = itertools.product(*gaps)
            else:
                combinations = self._earliest(team, gaps)
                if len(combinations) < math.prod(map(len, gaps)):
                    self._looked_at_some.add((i, j))
            found += [self._put(i, team, at) for at in combinations]
            if len(team) > 1 and len(found) >= _MOST_PLACES:
                self._looked_at_some.add((i, j))
                break
        return found

    def _of_whole(self, i: int, j: int, whole: Sequence[int]) -> list[Place]:
        """The places of tasks that can only be done together."""
        rules = self.problem.model
        if len(whole) == 2 and not any(rules.is_for_team(k) or rules.beginning_with(k) for k in whole):
            return list(self._of_transport(i, j, whole))
        units = [[k for k in whole if rules.unit[k] == unit] for unit in dict.fromkeys(rules.unit[k] for k in whole)]
        ways = self._grown(units, self.routes, {}, i, j)
        found = [Place(routes[i].index(j), routes) for routes in itertools.islice(ways, _MOST_OF_WHOLE)]
        if next(ways, None) is not None:
            self._looked_at_some.add((i, j))
        return found

    def _grown(
        self, units: Sequence[list[int]], routes: list[list[int]], teams: dict[int, tuple[int, ...]], i: int, j: int
    ) -> Iterator[list[list[int]]]:
        """Routes with units of inseparable tasks, one after the other, each with the teams that it can have."""
        if not units:
            if i in teams[j]:
                yield routes
            return
        for chosen in itertools.product(*(list(self._teams_in_whole(k, teams)) for k in units[0])):
            members = [(robot, k) for k, team in zip(units[0], chosen, strict=True) for robot in team]
            if len({robot for robot, _ in members}) < len(members):
                continue
            gaps = [range(len(self.problem.beginning(robot)), len(routes[robot]) + 1) for robot, _ in members]
            for at in itertools.product(*gaps):
                longer = self._with_members(routes, members, at)
                yield from self._grown(units[1:], longer, {**teams, **dict(zip(units[0], chosen, strict=True))}, i, j)

    def _teams_in_whole(self, k: int, teams: dict[int, tuple[int, ...]]) -> Iterator[tuple[int, ...]]:
        """The teams of a task: that of the one that takes on what it delivers, or all that it can have."""
        pickup = self.problem.model.pickups[k]
        if pickup in teams:
            yield teams[pickup]
        else:
            yield from self._teams_of(k, None)

    def _of_transport(self, i: int, j: int, whole: Sequence[int]) -> Iterator[Place]:
        """All places of both tasks of a transport."""
        first, second = whole
        if not self._keeps_relations(i, j):
            return
        route = self.routes[i]
        for at, then in itertools.combinations_with_replacement(self._gaps(i), 2):
            with_both = [*route[:at], first, *route[at:then], second, *route[then:]]
            routes = [with_both if k == i else other for k, other in enumerate(self.routes)]
            yield Place(with_both.index(j), routes)

    def _put(self, i: int, team: Sequence[Member], at: Sequence[int]) -> Place:
        routes = self._with_members(self.routes, team, at)
        return Place(next(gap for (robot, _), gap in zip(team, at, strict=True) if robot == i), routes)

    @staticmethod
    def _with_members(routes: list[list[int]], team: Sequence[Member], at: Sequence[int]) -> list[list[int]]:
        longer = list(routes)
        for (robot, task), gap in zip(team, at, strict=True):
            longer[robot] = [*longer[robot][:gap], task, *longer[robot][gap:]]
        return longer

    def _gaps(self, i: int) -> range:
        return range(len(self.problem.beginning(i)), len(self.routes[i]) + 1)

    def _earliest(self, team: Sequence[Member], gaps: Sequence[range]) -> list[tuple[int, ...]]:
        """Combinations of gaps, those first at which the last member arrives first; of these the latest gaps."""
        most = max(1, int(_MOST_PLACES ** (1 / len(team))))
        all_of_them = math.prod(map(len, gaps)) <= _MOST_PLACES
        near = [list(some) if all_of_them else _spread(list(some), most) for some in gaps]
        arrivals = [{gap: self._arrival(*member, gap) for gap in some} for member, some in zip(team, near, strict=True)]

        def order(at: tuple[int, ...]) -> tuple[float, int]:
            return max(times[gap] for times, gap in zip(arrivals, at, strict=True)), -sum(at)

        return sorted(itertools.product(*near), key=order)


def in_plan(problem: Problem, routes: Sequence[Sequence[int]]) -> InPlan:
    """Routes, and what one more task in them would do."""
    return TimedPlaces(problem, routes) if problem.core.is_timed else InPlan(problem, routes)


def _spread(gaps: list[int], most: int) -> list[int]:
    """Some of many gaps, the last ones and others evenly."""
    if len(gaps) <= most:
        return gaps
    return sorted({gaps[-1 - k * (len(gaps) - 1) // max(1, most - 1)] for k in range(most)})
