"""The model of a plan: the primitives that the rules of a mission come to, by task and robot.

A rule contributes what it means (`Rule.compile`); whoever plans, proves, explains or carries out reads it here, and
knows no rule. Units are sets of tasks that begin at one moment.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from muster.mission.task_relations import joined
from muster.mission.values.arrays import Bools, Floats, Indices
from muster.model.parts import Gap, Meter, Openings, Parts, Seats, Service

ROUNDING = 2e-9
"""By how much a time may be above a limit, relative; a little more than the judge allows."""


@dataclass(frozen=True, eq=False)
class PlanModel:
    """What every plan must hold.

    Parameters
    ----------
    parts
        what the rules have contributed.
    due
        (n,) when a task should have ended: of the objective `lateness`, binding nothing; inf: never late.
    stations
        what robots get at each station that there is, whatever they need.
    """

    parts: Parts
    due: Floats
    stations: tuple[Service, ...] = ()

    def word_of(self, *primitives: str) -> str:
        """The word of the rule that gives one of these parts, by which reasons name it; empty: none does."""
        return next((self.parts.words[name] for name in primitives if name in self.parts.words), "")

    def given_by(self, primitive: str, *of: int) -> str:
        """The word of the rule whose bound of a task, a robot, or two tasks holds; empty: there is none."""
        return self.parts.given.get((primitive, of), "")

    @property
    def tasks(self) -> int:
        return self.parts.tasks

    @property
    def robots(self) -> int:
        return self.parts.robots

    @cached_property
    def openings(self) -> list[Openings]:
        """For each task when it may begin; empty: at any time."""
        return [self.parts.openings.get(j, []) for j in range(self.tasks)]

    @cached_property
    def ends_by(self) -> Floats:
        """(n,) when a task has ended at the latest; inf: whenever."""
        return _filled(self.parts.ends_by, self.tasks, math.inf)

    @cached_property
    def over_by(self) -> Floats:
        """(m,) when a robot's route is over at the latest; inf: whenever."""
        return _filled(self.parts.over_by, self.robots, math.inf)

    @cached_property
    def lasts_most(self) -> Floats:
        """(m,) how long a robot is under way at the most, from leaving its start to the end of its route; inf: ever."""
        return _filled(self.parts.lasts_most, self.robots, math.inf)

    def spans(self, i: int) -> Openings:
        """When robot i drives and works; empty: at any time."""
        return self.parts.spans.get(i, [])

    def set_out(self, i: int, times: Floats, seconds: Floats) -> Floats:
        """From when robot i, free at some times, is busy for so long without a rest; inf: never again."""
        if i not in self.parts.spans:
            return times
        begins = np.full(np.broadcast(times, seconds).shape, math.inf)
        for first, last in reversed(self.spans(i)):
            tried = np.maximum(times, first)
            begins = np.where(tried + seconds <= last * (1 + ROUNDING), tried, begins)
        return begins

    def busy_until(self, i: int, times: Floats, seconds: Floats) -> Floats:
        """When robot i, free at some times, has driven and worked so long at the earliest, as often as it rests."""
        times, left = np.broadcast_arrays(np.asarray(times, np.float64), np.asarray(seconds, np.float64))
        until = times + left
        open_yet = np.isfinite(until) & (left > 0)
        for first, last in self.spans(i):
            start = np.maximum(times, first)
            ends = open_yet & (start + left <= last)
            until = np.where(ends, start + left, until)
            open_yet &= ~ends
            room = np.maximum(0.0, last - np.where(open_yet, start, 0.0))
            left = np.where(open_yet, left - np.where(open_yet, room, 0.0), left)
        return np.where(open_yet, math.inf, until) if self.spans(i) else until

    @cached_property
    def capacity(self) -> Floats:
        """(m,) the most usage of a robot; inf: without an end."""
        return _filled(self.parts.capacity, self.robots, math.inf)

    @cached_property
    def least_stops(self) -> Indices:
        """(m,) how many tasks a robot does at least that does any."""
        return _filled(self.parts.least_stops, self.robots, 0).astype(np.int32)

    @property
    def meters(self) -> Sequence[Meter]:
        """What robots have on board."""
        return self.parts.meters

    @cached_property
    def energy(self) -> Floats:
        """(m,) for how much usage a robot's energy is enough at most; inf: for any."""
        return _filled({i: room for i, (room, _) in self.parts.energy.items()}, self.robots, math.inf)

    @property
    def refills(self) -> bool:
        """Whether robots get energy on the way."""
        return any(station.refill for station in self.stations)

    @cached_property
    def energy_at_start(self) -> Floats:
        """(m,) the same at first."""
        return _filled({i: first for i, (_, first) in self.parts.energy.items()}, self.robots, math.inf)

    @cached_property
    def pickups(self) -> list[int]:
        """For each task the one that takes on board what it delivers; -1: it delivers nothing."""
        return [self.parts.taken_on_by.get(j, -1) for j in range(self.tasks)]

    @cached_property
    def partners(self) -> list[int | None]:
        """For each task the one that it delivers for, or that delivers for it."""
        found: list[int | None] = [None] * self.tasks
        for j, pickup in self.parts.taken_on_by.items():
            found[j], found[pickup] = pickup, j
        return found

    def gaps(self, j: int) -> list[Gap]:
        """The tasks that are done before a task; how long after the end of each it begins, at least and at most."""
        own = self.parts.gaps.get(j, {})
        return [(k, *own.get(k, (0.0, math.inf))) for k in self.awaited[j]]

    @cached_property
    def awaited(self) -> list[list[int]]:
        """For each task those that are done before it, also the one that takes on board what it delivers."""
        pickups = enumerate(self.pickups)
        return [sorted({*self.parts.gaps.get(j, ()), pickup} - {-1}) for j, pickup in pickups]

    @cached_property
    def units(self) -> list[list[int]]:
        """The tasks in sets that begin together."""
        members: dict[int, list[int]] = {}
        for j, first in enumerate(joined(self.parts.together, self.tasks)):
            members.setdefault(first, []).append(j)
        return list(members.values())

    @cached_property
    def unit(self) -> list[int]:
        """For each task the index of its unit."""
        index = {j: u for u, members in enumerate(self.units) for j in members}
        return [index[j] for j in range(self.tasks)]

    def beginning_with(self, j: int) -> list[int]:
        """The other tasks of its unit."""
        return [k for k in self.units[self.unit[j]] if k != j]

    @cached_property
    def same_crew(self) -> list[list[int]]:
        """For each task those that the same robots do."""
        return [sorted(self.parts.same_crew.get(j, ())) for j in range(self.tasks)]

    @cached_property
    def apart(self) -> list[list[int]]:
        """For each task those that none of its robots does."""
        return [sorted(self.parts.apart.get(j, ())) for j in range(self.tasks)]

    @cached_property
    def exclusive(self) -> list[list[int]]:
        """For each task those of which none is done if it is."""
        return [sorted(self.parts.exclusive.get(j, ())) for j in range(self.tasks)]

    @cached_property
    def alternatives(self) -> list[list[int]]:
        """The sets of tasks that exclude each other, directly or through others: a plan does one of each at most."""
        pairs = [(j, k) for j, others in self.parts.exclusive.items() for k in others]
        sets: dict[int, list[int]] = {}
        for j, first in enumerate(joined(pairs, self.tasks) if pairs else ()):
            sets.setdefault(first, []).append(j)
        return [tasks for tasks in sets.values() if len(tasks) > 1]

    @property
    def most_done(self) -> int:
        """How many tasks a plan does at most."""
        return self.tasks - sum(len(tasks) - 1 for tasks in self.alternatives)

    def may_call(self, i: int, station: int) -> bool:
        """Whether a robot may call at a station."""
        return (i, station) not in self.parts.no_calls

    @property
    def with_relations(self) -> bool:
        """Whether tasks are tied to others by who does them, or begin together."""
        return bool(self.parts.same_crew or self.parts.apart or self.parts.together)

    @property
    def with_teams(self) -> bool:
        """Whether several robots may have to do a task."""
        return bool(self.parts.seats or self.parts.sums)

    @cached_property
    def for_teams(self) -> tuple[int, ...]:
        """The tasks that several robots may have to do."""
        return tuple(sorted({*self.parts.seats, *self.parts.sums}))

    def is_for_team(self, j: int) -> bool:
        """Whether several robots may have to do a task."""
        return j in self.parts.seats or j in self.parts.sums

    def has_seats(self, j: int) -> bool:
        """Whether the robots that do a task are so many of each sort, more than one in all."""
        return j in self.parts.seats

    def seats(self, j: int) -> Seats:
        """How many robots of each sort do a task, and (m,) who is of it; one of any sort, where nothing is said."""
        return self.parts.seats.get(j) or [(1, np.ones(self.robots, np.bool_))]

    def sums(self, j: int) -> Mapping[str, tuple[float, Floats]]:
        """By name what the robots that do a task must be able to do at least, together, and (m,) what each is."""
        return self.parts.sums.get(j, {})

    def places(self, u: int) -> tuple[list[int], Bools]:
        """The places of the crews of a unit, where sums count one: the task of each, and (places, m) who fits."""
        rows = [(j, fits) for j in self.units[u] for count, fits in self.seats(j) for _ in range(count)]
        return [j for j, _ in rows], np.array([fits for _, fits in rows], dtype=np.bool_)

    def next_begin(self, j: int, times: Floats) -> Floats:
        """When a task may begin that is ready at some times; inf: not any more."""
        if not self.openings[j]:
            return times
        opens, closes = np.array(self.openings[j]).T
        at = np.searchsorted(closes * (1 + ROUNDING), times)
        return np.asarray(np.maximum(times, np.append(opens, math.inf)[at]))

    def of_robot(self, i: int) -> object:
        """What it says of robot i, beside the tasks that it may do and its capacity: the same for robots alike."""
        aboard = [float(of[i]) for meter in self.meters for of in (meter.most, meter.at_start, meter.pending_at_start)]
        energy = float(self.energy[i]), float(self.energy_at_start[i])
        times = float(self.over_by[i]), float(self.lasts_most[i]), tuple(self.spans(i))
        return times, int(self.least_stops[i]), energy, tuple(aboard), self.in_team(i)

    def in_team(self, i: int) -> object:
        """What makes robot i the same as another in every crew."""
        if not self.with_teams:
            return None
        seats = tuple(bool(fits[i]) for j in sorted(self.parts.seats) for _, fits in self.parts.seats[j])
        able = {name: float(who[i]) for sums in self.parts.sums.values() for name, (_, who) in sums.items()}
        return seats, tuple(sorted(able.items()))

    def sizes_differ(self, j: int, k: int) -> bool:
        """Whether no crew is of the right size for both of two tasks."""
        fewest = self.least_members(j), self.least_members(k)
        return fewest[0] != fewest[1] and not any(
            self.sums(few) for few, least in zip((j, k), fewest, strict=True) if least < max(fewest)
        )

    def least_members(self, j: int) -> int:
        """How many robots a task needs at least."""
        if j in self.parts.sums:
            return max(_fewest(least, able) for least, able in self.parts.sums[j].values())
        return sum(count for count, _ in self.seats(j))


def _filled(known: Mapping[int, float], size: int, otherwise: float) -> Floats:
    values = np.full(size, otherwise, dtype=np.float64)
    for k, value in known.items():
        values[k] = value
    return values


def _fewest(least: float, able: Floats) -> int:
    """How many of the ablest robots reach the least sum; one more than there are if none do."""
    sums = np.cumsum(np.sort(able)[::-1])
    return int((sums < least * (1 - 1e-9)).sum()) + 1
