"""The primitives of a plan model, as the rules of a mission contribute them, each for itself.

Tasks (n) and robots (m) are numbered as in the problem. What two rules say of one thing holds together: the later end
gives way to the earlier one, and of two domains what is in both is left.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from muster.mission.model import Station
from muster.mission.values.arrays import Bools, Floats
from muster.model.energy import Refill

Openings = list[tuple[float, float]]
"""When something may begin: spans from, until, seconds, sorted and apart."""

NEVER: Openings = [(math.inf, math.inf)]
"""No span at all would say that it may begin at any time."""

Seats = list[tuple[int, Bools]]
"""How many robots of which: a count, and (m,) who is fit."""

Gap = tuple[int, float, float]
"""The task before, and the least and the most time between its end and the begin of the one after, seconds."""


@dataclass(frozen=True, eq=False)
class Meter:
    """A quantity on board of robots along their routes, between 0 and the most that each has room for.

    Parameters
    ----------
    name
        for people.
    change
        (n,) what a task adds.
    most
        (m,) the room of each robot; inf: without an end.
    at_start
        (m,) what is on board at first.
    pending
        (n,) what of the change another task takes off again, below 0 where the task is that one: stations leave it on
        board.
    pending_at_start
        (m,) what of the load at first tasks deliver.
    """

    name: str
    change: Floats
    most: Floats
    at_start: Floats
    pending: Floats
    pending_at_start: Floats
    rule: str = ""  # the word of the rule that contributed it

    @classmethod
    def count(cls, name: str, change: Sequence[float], most: Sequence[float]) -> Meter:
        """A quantity that only grows: what tasks add stays, and stations take nothing off."""
        grows, none = np.array(change, dtype=np.float64), np.zeros(len(most))
        return cls(name, grows, np.array(most, dtype=np.float64), none, grows, none)


@dataclass(frozen=True)
class Service:
    """What robots get at a station.

    Parameters
    ----------
    refill
        the energy that it adds; None: none.
    unloads
        whether a robot puts down what no task delivers.
    slots
        how many robots at once.
    """

    refill: Refill | None
    unloads: bool
    slots: int

    @classmethod
    def of(cls, station: Station) -> Service:
        """Return the service of a station."""
        return cls(Refill.of(station), station.unloads, station.slots)


@dataclass(frozen=True)
class Begun:
    """What a robot under way has begun: limits of its times hold of what it is yet to do.

    Parameters
    ----------
    busy_s
        from when until when it has been at work, or is: it does not rest then.
    left_s
        when it left its start; None: it has not.
    over_s
        before which its route cannot be over any more.
    """

    busy_s: tuple[float, float] = -math.inf, -math.inf
    left_s: float | None = None
    over_s: float = -math.inf

    def rests(self, spans: Openings) -> Openings:
        """What is left of spans, and the one in which it is busy."""
        since, free = self.busy_s
        left = [(max(begins, free), ends) for begins, ends in spans if ends > free] or [(free, free)]
        return [(since, free), *left] if since < free else left


@dataclass(eq=False)
class Parts:
    """What rules have contributed so far, to a model of so many robots and tasks."""

    robots: int
    tasks: int
    begun: Mapping[int, Begun] = field(default_factory=dict)  # by robot
    over: Collection[int] = ()  # tasks that stand for what was done: no times bind them, no call comes before them
    openings: dict[int, Openings] = field(default_factory=dict)
    ends_by: dict[int, float] = field(default_factory=dict)
    over_by: dict[int, float] = field(default_factory=dict)
    lasts_most: dict[int, float] = field(default_factory=dict)
    spans: dict[int, Openings] = field(default_factory=dict)
    gaps: dict[int, dict[int, tuple[float, float]]] = field(default_factory=dict)
    bounded: set[tuple[int, int]] = field(default_factory=set)  # gaps of which more is said than the order
    together: list[tuple[int, int]] = field(default_factory=list)
    same_crew: dict[int, set[int]] = field(default_factory=dict)
    apart: dict[int, set[int]] = field(default_factory=dict)
    exclusive: dict[int, set[int]] = field(default_factory=dict)
    no_calls: set[tuple[int, int]] = field(default_factory=set)
    seats: dict[int, Seats] = field(default_factory=dict)
    sums: dict[int, dict[str, tuple[float, Floats]]] = field(default_factory=dict)
    taken_on_by: dict[int, int] = field(default_factory=dict)
    capacity: dict[int, float] = field(default_factory=dict)
    least_stops: dict[int, int] = field(default_factory=dict)
    meters: list[Meter] = field(default_factory=list)
    energy: dict[int, tuple[float, float]] = field(default_factory=dict)
    rule: str = ""  # the word of the rule that contributes now; empty: none
    given: dict[tuple[str, tuple[int, ...]], str] = field(default_factory=dict)  # the rule of each bound that holds
    words: dict[str, str] = field(default_factory=dict)  # by primitive, of the first rule that contributed any

    def opens(self, j: int, spans: Iterable[tuple[float, float | None]]) -> None:
        """Task j begins in one of these spans."""
        if j not in self.over:
            self._within("openings", j, _openings(spans))

    def ends(self, j: int, latest_s: float) -> None:
        """Task j ends by a time."""
        if j not in self.over:
            self._at_most("ends_by", j, latest_s)

    def is_over(self, i: int, latest_s: float) -> None:
        """The route of robot i, its way to the end included, is over by a time."""
        over_s = self.begun[i].over_s if i in self.begun else latest_s
        self._at_most("over_by", i, max(latest_s, over_s))

    def lasts(self, i: int, most_s: float) -> None:
        """From leaving its start to the end of its route robot i takes at most so long, however late it leaves."""
        left_s = self.begun[i].left_s if i in self.begun else None
        if left_s is None:
            self._at_most("lasts_most", i, most_s)
        else:
            self.is_over(i, left_s + most_s)

    def rests(self, i: int, spans: Iterable[tuple[float, float | None]]) -> None:
        """Robot i drives and works in these spans alone: each leg and each work within one of them."""
        own = _openings(spans)
        self._within("spans", i, self.begun[i].rests(own) if i in self.begun else own)

    def follows(self, j: int, before: int, least_s: float = 0.0, most_s: float = math.inf) -> None:
        """Task j is done only if the one before it is, and begins so long after that ends, at least and at most."""
        if least_s > 0 or most_s < math.inf:
            self.bounded.add((before, j))
        least, most = self.gaps.setdefault(j, {}).get(before, (0.0, math.inf))
        if most_s < most:
            self._give("gaps", before, j)
        self.gaps[j][before] = max(least, least_s), min(most, most_s)

    def begin_together(self, j: int, k: int) -> None:
        """Both tasks are done by different robots, beginning at one moment, or neither is."""
        self.together.append((j, k))

    def by_one_crew(self, j: int, k: int) -> None:
        """The same robots do both, if both are done."""
        _both(self.same_crew, j, k)

    def by_others(self, j: int, k: int) -> None:
        """No robot does both."""
        _both(self.apart, j, k)

    def exclude(self, j: int, k: int) -> None:
        """At most one of the tasks is done."""
        _both(self.exclusive, j, k)

    def keep_away(self, i: int, station: int) -> None:
        """Robot i does not call at a station."""
        self.no_calls.add((i, station))

    def seat(self, j: int, seats: Seats) -> None:
        """So many robots of each sort do task j, at once."""
        self.seats[j] = seats

    def sum_up(self, j: int, name: str, needed: float, able: Floats) -> None:
        """What the robots that do task j are able to do, (m,), sums up to at least so much."""
        self.sums.setdefault(j, {})[name] = needed, able

    def deliver(self, j: int, pickup: int) -> None:
        """One robot does both, the pickup first, and neither is done alone."""
        self.taken_on_by[j] = pickup

    def uses(self, i: int, most: float) -> None:
        """The usage of robot i is at most so much."""
        self._at_most("capacity", i, most)

    def stops(self, i: int, least: int) -> None:
        """Robot i does no task, or at least so many."""
        self.least_stops[i] = max(least, self.least_stops.get(i, 0))

    def meter(self, meter: Meter) -> None:
        """A quantity stays between 0 and the robot's room for it."""
        self.meters.append(replace(meter, rule=self.rule))

    def has_energy(self, i: int, room: float, at_start: float) -> None:
        """Robot i has energy for so much usage at most, and at first; stations give it more."""
        self.energy[i] = room, at_start

    def _at_most(self, limits: str, at: int, most: float) -> None:
        """What rules say of a robot or task together is the least of it."""
        known: dict[int, float] = getattr(self, limits)
        if at not in known or most < known[at]:
            known[at] = most
            self._give(limits, at)

    def _within(self, openings: str, at: int, own: Openings) -> None:
        """What rules say of a robot or task together is what is in the spans of each."""
        known: dict[int, Openings] = getattr(self, openings)
        both = _common(known[at], own) if at in known else own
        if at not in known or both[-1] != known[at][-1]:
            self._give(openings, at)
        known[at] = both

    def _give(self, primitive: str, *of: int) -> None:
        self.given[primitive, of] = self.rule

    def named(self, word: str) -> None:
        """Remember the word of the rule that has contributed, for the primitives of which there were none before."""
        self.words |= {name: word for name, given in vars(self).items() if given and name not in self.words}


def _openings(spans: Iterable[tuple[float, float | None]]) -> Openings:
    return sorted((begins, math.inf if ends is None else ends) for begins, ends in spans)


def _both(tied: dict[int, set[int]], j: int, k: int) -> None:
    tied.setdefault(j, set()).add(k)
    tied.setdefault(k, set()).add(j)


def _common(some: Openings, others: Openings) -> Openings:
    """What is in both."""
    pairs = ((max(a, c), min(b, d)) for a, b in some for c, d in others)
    return sorted((opens, closes) for opens, closes in pairs if opens <= closes) or NEVER
