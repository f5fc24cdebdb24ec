"""Work that falls into intervals of time whatever the plan, and for how long groups of robots are there for it.

Energetic reasoning [baptiste1999]: a task whose begin is between two times does some of its work within an interval
wherever it begins. What the tasks of a group of robots have in an interval, as often as members of the group do each,
is no more than the time that its robots can be at tasks then, less the legs between those that begin within it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from muster.allocation.bounds.earliest_times import kth_least
from muster.allocation.bounds.limits import Limits
from muster.model.problem import Floats, Indices

_EFFORT = 3e7  # intervals times tasks, and times groups: beyond, fewer intervals are looked at
_MOST_TIMES = 150  # at which intervals begin, or end
_MOST_LEGS = 2e7  # robots times tasks squared, up to which legs between tasks are looked at
_MOST_ROUNDS = 50  # of latest begins; they hold whenever it ends
_CLEAR = 1e-6  # by how much work must be above the time for it, relative and in seconds
Group = frozenset[int]


@dataclass(frozen=True, eq=False)
class Overload:
    """An interval in which a group of robots has more to do than time.

    Parameters
    ----------
    group
        the robots.
    begins, ends
        the interval, seconds.
    work
        (n,) seconds of work of each task within it that the group does at least, all members together. Of tasks that
        exclude each other those of the one with least.
    legs
        (n,) seconds of legs within it to each task, all members together; the longest, one for each robot, are not
        on the way from another task.
    travel, available
        seconds of the other legs, and of the robots.
    """

    group: Group
    begins: float
    ends: float
    work: Floats
    legs: Floats
    travel: float
    available: Floats

    @property
    def lacking(self) -> float:
        """By how many seconds it is too much."""
        return float(self.work.sum()) + self.travel - float(self.available.sum())

    @property
    def share(self) -> float:
        """The same, relative to what is to do."""
        return self.lacking / (float(self.work.sum()) + self.travel)


class IntervalWork:
    """When some tasks are worked on in plans that do all of them, of those that exclude each other one.

    Parameters
    ----------
    limits
        lower bounds of times, and the pairs that are possible.
    tasks
        the tasks.
    """

    def __init__(self, limits: Limits, tasks: Sequence[int]) -> None:
        self._limits, self._problem, self._rules = limits, limits.problem, limits.rules
        chosen = np.zeros(len(self._problem.tasks), np.bool_)
        chosen[list(tasks)] = True
        self._usable = limits.usable & chosen & np.isfinite(limits.begin)
        self._chosen = np.asarray(self._usable.any(axis=0))
        self._members = [self._rules.least_members(j) for j in range(len(chosen))]

    # --- times of tasks and robots -----------------------------------------------------------------------------------

    @cached_property
    def _seconds(self) -> Floats:
        """(n,) how long each member of a team works at least: as long as the slowest."""
        works = kth_least(np.where(self._usable, self._limits.work, math.inf), self._members)
        return np.maximum(np.where(np.isfinite(works), works, 0.0), self._limits.shortest_work)

    @cached_property
    def _leaves_by(self) -> Floats:
        """(m, n) until when a robot can be at a task; -inf: never."""
        homes = np.where(self._usable, self._limits.home, 0.0)
        return np.where(self._usable, self._rules.over_by[:, None] - homes, -math.inf)

    @cached_property
    def _latest_alone(self) -> Floats:
        """(n,) when a task begins at the latest, whatever other tasks there are."""
        leaves = -kth_least(-self._leaves_by, self._members)
        for j in self._rules.for_teams:
            for count, fits in self._rules.seats(j) if self._rules.has_seats(j) else ():
                leaves[j] = min(leaves[j], -np.sort(-self._leaves_by[fits, j])[:count].max(initial=-math.inf))
        closes = [spans[-1][1] if spans else math.inf for spans in self._rules.openings]
        return np.minimum(closes, np.minimum(self._rules.ends_by, leaves) - self._seconds)

    @cached_property
    def _latest(self) -> Floats:
        """(n,) when a task begins at the latest if all are done: those after it need time, too."""
        latest, rules = self._latest_alone.copy(), self._rules
        longest = np.maximum(self._limits.longest_work, self._limits.shortest_work)
        tasks = np.flatnonzero(self._chosen).tolist()
        for _ in range(min(len(tasks), _MOST_ROUNDS)):
            before = latest.copy()
            for j in reversed(tasks):
                for k in rules.units[rules.unit[j]]:
                    latest[k] = min(latest[k], latest[j]) if not rules.exclusive[j] else latest[k]
                for k, after, within in rules.gaps(j):
                    if math.isfinite(within):
                        latest[j] = min(latest[j], latest[k] + longest[k] + within)
                    if not rules.exclusive[j]:
                        latest[k] = min(latest[k], latest[j] - after - self._seconds[k])
            if np.array_equal(before, latest):
                break
        return latest

    def forcing(self, tasks: Sequence[int]) -> list[int]:
        """The other tasks because of which some begin so early: what waits for them, directly or through others."""
        rules, found = self._rules, set[int]()
        waiting = [j for j in tasks if self._latest[j] < self._latest_alone[j]]
        while waiting:
            j = waiting.pop()
            tied = [*rules.beginning_with(j), *(k for k, _, within in rules.gaps(j) if math.isfinite(within))]
            new = {*tied, *(k for k in self._followers[j] if not rules.exclusive[k])} - found
            found |= new
            waiting += new
        return sorted(found.difference(tasks))

    @cached_property
    def _followers(self) -> list[list[int]]:
        """For each task those that wait for it."""
        found: list[list[int]] = [[] for _ in self._members]
        for j in np.flatnonzero(self._chosen).tolist():
            for k in self._rules.awaited[j]:
                found[k].append(j)
        return found

    @cached_property
    def _begins(self) -> tuple[Floats, Indices]:
        """The first and the last begin in each opening, seconds, and where those of each task of `_placed` start."""
        ends, starts = list[float](), list[int]()
        for j in self._placed.tolist():
            starts.append(len(ends))
            for first, last in self._ranges(j):
                ends += [first, last]
        return np.array(ends), np.array(starts, np.int64)

    def _ranges(self, j: int) -> list[tuple[float, float]]:
        first, last = float(self._limits.begin[j]), float(self._latest[j])
        openings = self._rules.openings[j] or [(0.0, math.inf)]
        cut = [(max(first, opens), min(last, closes)) for opens, closes in openings]
        return [(opens, closes) for opens, closes in cut if opens <= closes]

    @cached_property
    def _placed(self) -> Indices:
        """The tasks with some work, and a latest begin that leaves a time to begin."""
        worked = self._chosen & (self._seconds > 0) & np.isfinite(self._latest)
        return np.array([j for j in np.flatnonzero(worked).tolist() if self._ranges(j)], np.int64)

    @cached_property
    def _spans(self) -> tuple[Floats, Floats, Indices]:
        """When robots can be at tasks: from, until, and whose span it is."""
        ends = np.where(self._usable, self._latest + self._seconds, -math.inf).max(axis=1, initial=-math.inf)
        until = np.minimum(self._leaves_by.max(axis=1, initial=-math.inf), ends)
        there = np.where(self._usable, np.maximum(self._limits.arrival, self._limits.begin), math.inf)
        since = there.min(axis=1, initial=math.inf)
        found = [
            (max(since[i], first), min(until[i], last), i)
            for i in range(len(self._usable))
            for first, last in self._rules.spans(i) or [(0.0, math.inf)]
        ]
        kept = [span for span in found if span[0] < span[1]]
        return (
            np.array([a for a, _, _ in kept]),
            np.array([b for _, b, _ in kept]),
            np.array([i for *_, i in kept], int),
        )

    @cached_property
    def _at_work_most(self) -> Floats:
        """(m,) for how long a robot is at tasks and between them at most."""
        ways = np.where(self._usable, self._limits.way, math.inf).min(axis=1, initial=math.inf)
        homes = np.where(self._usable, self._limits.home, math.inf).min(axis=1, initial=math.inf)
        some = np.isfinite(ways)
        return np.where(some, self._rules.lasts_most - np.where(some, ways + homes, 0.0), 0.0)

    @cached_property
    def _legs(self) -> Floats:
        """(m, n) the least leg of a robot to a task from another one or a station; inf: there is none; 0: unknown."""
        problem, n = self._problem, len(self._problem.tasks)
        if len(problem.robots) * n * n > _MOST_LEGS:
            return np.zeros(self._usable.shape)
        stations = [n + 2 * len(problem.robots) + k for k in range(len(problem.stations))]
        legs = np.full(self._usable.shape, math.inf)
        for i, usable in enumerate(self._usable):
            own = np.flatnonzero(usable)
            ways = problem.travel_seconds(i, [*own.tolist(), *stations], own)
            ways[np.arange(len(own)), np.arange(len(own))] = math.inf
            legs[i, own] = ways.min(axis=0, initial=math.inf)
        return legs

    # --- groups ------------------------------------------------------------------------------------------------------

    def _members_of(self, group: Group) -> Floats:
        """(n,) how many members of a group do a task at least, whoever else does it."""
        outside = np.ones(len(self._usable), np.bool_)
        outside[list(group)] = False
        others, found = self._usable & outside[:, None], np.zeros(len(self._members))
        for j in self._placed.tolist():
            if not others[:, j].any():
                found[j] = self._members[j]
            elif not self._rules.sums(j):
                seats = sum(count for count, fits in self._rules.seats(j) if not (fits & others[:, j]).any())
                found[j] = max(seats, self._members[j] - int(others[:, j].sum()))
        return found

    # --- intervals ---------------------------------------------------------------------------------------------------

    def overloads(self, groups: Sequence[Group]) -> Iterator[Overload]:
        """For each group the interval that lacks most, relative to what is to do, if one lacks any."""
        if not len(self._placed) or not groups:
            return
        members = np.array([self._members_of(group) for group in groups])[:, self._placed]
        of_group = np.zeros((len(groups), len(self._usable)))
        for g, group in enumerate(groups):
            of_group[g, list(group)] = 1.0
        best, where = np.zeros(len(groups)), dict[int, tuple[float, float]]()
        begins, ends = self._times(len(groups))
        for a in begins:
            later = ends[ends > a]
            if len(later):
                work = self._work_within(a, later)
                needed = self._summed(work[:, None, :] * members[None]) + self._travel_within(a, later, groups, members)
                lacking = needed - self._available_within(a, later) @ of_group.T
                clear = lacking > _CLEAR * (1.0 + needed)
                shares = np.where(clear, lacking / np.maximum(needed, _CLEAR), 0.0)
                at = shares.argmax(axis=0)
                worst = shares[at, np.arange(len(groups))]
                for g in np.flatnonzero(worst > best + _CLEAR).tolist():
                    best[g], where[g] = shares[at[g], g], (a, float(later[at[g]]))
        for g, (a, b) in where.items():
            yield self._overload(groups[g], members[g], a, b)

    def _times(self, groups: int) -> tuple[list[float], Floats]:
        """When intervals begin and end: where work can begin or end, or robots come or go."""
        points, _ = self._begins
        first, last, _ = self._spans
        sizes = np.diff(np.append(self._begins[1], len(points)))
        over = points + np.repeat(self._seconds[self._placed], sizes)
        count = int(min(_MOST_TIMES, max(2.0, math.sqrt(_EFFORT / (len(self._placed) * groups)))))
        return _some(np.concatenate([points, first]), count).tolist(), _some(np.concatenate([over, last]), count)

    def _work_within(self, a: float, ends: Floats) -> Floats:
        """(ends, placed) the least seconds of each task's work between a time and each end.

        The work done within an interval grows and falls with the begin: it is least at the first or last begin of an
        opening.
        """
        points, starts = self._begins
        sizes = np.diff(np.append(starts, len(points)))
        over = points + np.repeat(self._seconds[self._placed], sizes)
        within = np.minimum(ends[:, None], over[None]) - np.maximum(a, points)[None]
        return np.asarray(np.minimum.reduceat(np.maximum(within, 0.0), starts, axis=1))

    def _summed(self, work: Floats) -> Floats:
        """(...,) the sum over tasks (the last axis), of those that exclude each other the least."""
        return np.asarray(self._one_of_each(work).sum(axis=-1))

    def _one_of_each(self, work: Floats) -> Floats:
        """The work of tasks, nothing for all of those that exclude each other but one with least."""
        left = work.copy()
        for alike in self._alternatives:
            least = np.asarray(work[..., alike].argmin(axis=-1))[..., None] == np.arange(len(alike))
            left[..., alike] = np.where(least, work[..., alike], 0.0)
        for j in self._open_alternatives:
            left[..., j] = 0.0
        return left

    @cached_property
    def _alternatives(self) -> list[list[int]]:
        """The sets of tasks that exclude each other and are all placed, or cannot be done; by their place in these."""
        number = {j: at for at, j in enumerate(self._placed.tolist())}
        own = ([j for j in tasks if self._chosen[j]] for tasks in self._rules.alternatives)
        return [[number[j] for j in tasks] for tasks in own if tasks and all(j in number for j in tasks)]

    @cached_property
    def _open_alternatives(self) -> list[int]:
        """The placed tasks in whose place one can be done of which nothing is known."""
        closed = {at for tasks in self._alternatives for at in tasks}
        tied = {j for tasks in self._rules.alternatives for j in tasks}
        return [at for at, j in enumerate(self._placed.tolist()) if j in tied and at not in closed]

    def _travel_within(self, a: float, ends: Floats, groups: Sequence[Group], members: Floats) -> Floats:
        """(ends, groups) the least seconds of legs between tasks that begin in an interval.

        Each member comes to each of them from another stop after the interval has begun, but at the first for each
        robot: of as many as there are robots the longest legs are left out.
        """
        inside = self._inside(a, ends)
        found = np.zeros((len(ends), len(groups)))
        for g, group in enumerate(groups):
            legs = self._legs_to(group)
            order = np.argsort(-legs)
            copies = np.asarray(inside[:, order] * members[g, order])
            before = np.cumsum(copies, axis=1) - copies
            kept = np.clip(copies - np.maximum(0.0, len(group) - before), 0.0, None)
            found[:, g] = kept @ legs[order]
        return found

    def _inside(self, a: float, ends: Floats) -> Floats:
        """(ends, placed) 1 where a task that every plan does begins in an interval; else 0."""
        first, last = self._limits.begin[self._placed], self._latest[self._placed]
        alone = np.array([not self._rules.exclusive[j] for j in self._placed.tolist()])
        within = np.asarray((first >= a) & alone & (last[None] <= ends[:, None]))
        return within.astype(np.float64)

    def _legs_to(self, group: Group) -> Floats:
        """(placed,) the least leg of robots of a group to each task."""
        legs = self._legs[sorted(group)][:, self._placed].min(axis=0, initial=math.inf)
        return np.where(np.isfinite(legs), legs, 0.0)

    def _available_within(self, a: float, ends: Floats) -> Floats:
        """(ends, m) how long robots can be at tasks."""
        first, last, robots = self._spans
        within = np.maximum(0.0, np.minimum(ends[:, None], last) - np.maximum(a, first))
        available = np.zeros((len(ends), len(self._usable)))
        np.add.at(available.T, robots, within.T)
        return np.minimum(available, np.maximum(0.0, self._at_work_most))

    def _overload(self, group: Group, members: Floats, a: float, b: float) -> Overload:
        ends, n = np.array([b]), len(self._problem.tasks)
        work, legs = np.zeros(n), np.zeros(n)
        work[self._placed] = self._one_of_each(self._work_within(a, ends)[0] * members)
        legs[self._placed] = self._inside(a, ends)[0] * members * self._legs_to(group)
        travel = float(self._travel_within(a, ends, [group], members[None])[0, 0])
        of_robots = self._available_within(a, ends)[0]
        return Overload(group, a, b, work, legs, travel, of_robots[sorted(group)])


def _some(times: Floats, count: int) -> Floats:
    """So many of some times at most, evenly, the first and the last of them among these."""
    known = np.unique(times[np.isfinite(times)])
    return known[np.unique(np.linspace(0, len(known) - 1, count).astype(np.int64))] if len(known) > count else known
