"""CBBA, the consensus-based bundle algorithm, in one process; rounds and messages are counted.

[choi2009]. Every robot fills its bundle with the tasks that add most to the score of its path (phase 1, Algorithm 3);
then the robots exchange winners, bids and time stamps with their neighbours (phase 2, Table I), and each releases what
it took after a task that it lost; until all agree. Scores are the paper's time-discounted rewards, the sum of
discount ** arrival * priority over the path; the mission's objective has no part in them.

Where the paper leaves room, or a mission holds more than the paper's:

- At the paper's discount of 0.95 a second a robot crosses the paper's square in 50 s. Time counts here in fiftieths of
  what the slowest robot takes along the longer side of the mission's extent, so that scale does not matter.
- Bids are held as logarithms: a late task is worth little, never nothing. A task for which there is only room where it
  costs later ones more than it brings is bid for with next to nothing, where the paper would leave it out.
- Agreement is proven for scores that add the less, the larger the bundle. Priorities, work that takes time, capacities
  and travel tables may break that; so no bid is above the one before it in the bundle ([johnson2012]). Where the
  paper's condition holds, that changes nothing.
- Of equal bids that of the robot first in tie order wins, so a robot also bids where it would win by that alone.
- A release resets only tasks that the robot still believes to be its own.
- Prerequisites: a task comes one layer after the last of its prerequisites; robots agree on a layer, then on the next,
  whose tasks come later in every path. A start plan is the layer before the first. Scores foresee no waiting.
- A place in a path counts only if capacity, ways and the way to the robot's end allow it.

The paper's theorem that the outcome is that of a sequential greedy algorithm holds with a bundle size of 1. With larger
bundles there are exceptions: a robot that took another task because a better one seemed lost keeps it, though the
better one comes free when its holder releases it; neither Algorithm 3 nor Table I makes it choose anew.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile

import numpy as np

from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.auctions.consensus import NO_BID, NOBODY, TOPOLOGIES, Beliefs, Ledger, diameter, neighbours
from muster.allocation.stop import Stop
from muster.mission.errors import MusterError, ParameterError
from muster.mission.values.ranges import require_counts
from muster.model.problem import Bools, Floats, Indices, Problem

_CROSSING = 50.0  # units of time across the mission's extent
_PATIENCE = 10  # times the paper's bound of tasks x diameter, within which its scores agree
_TINIEST = math.ulp(0.0)
_ROUNDING = 5e-13  # relative: half the room that the core leaves for it; the other half is for additions in its order


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of CBBA.

    Attributes
    ----------
    bundle_size
        most tasks of a bundle, L_t, in each layer of prerequisites; 0: at first twice the even share, and twice as many
        whenever a robot could take one more that nobody takes.
    topology
        who exchanges messages with whom, one of TOPOLOGIES; neighbours in tie order.
    discount
        of the reward, lambda, for each unit of time.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    bundle_size: int = 0
    topology: str = "complete"
    discount: float = 0.95

    def __post_init__(self) -> None:
        require_counts(0, bundle_size=self.bundle_size)
        if self.topology not in TOPOLOGIES:
            raise ParameterError(f"topology: {self.topology}; expected complete, ring or line")
        if not 0 < self.discount < 1:
            raise ParameterError(f"discount: {self.discount}; expected a number between 0 and 1")


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """CBBA on one layer of tasks after the other."""
    clock = ScoreClock(problem, params.discount)
    routes = start or [[] for _ in problem.robots]
    team = [Bidder(problem, clock, i, route) for i, route in enumerate(routes)]
    done = {j for route in routes for j in route}
    ledger = Ledger()
    for layer in layers(problem, done):
        offered = np.array([j for j in layer if done.issuperset(problem.prerequisites[j])], dtype=np.int64)
        winners = _agree(problem, team, offered, ledger, stop, params)
        for bidder in team:
            done.update(bidder.settle(winners))
        if stop.due():
            stop.cut()
            break
    routes = [bidder.route for bidder in team]
    stop.improved(*problem.value(routes))
    return Outcome(routes, ledger.book(problem, routes, neighbours(params.topology, len(team))))


def _agree(
    problem: Problem, team: list[Bidder], offered: Indices, ledger: Ledger, stop: Stop, params: Parameters
) -> Indices:
    """(n,) winners of the tasks offered: rounds of the two phases until all agree and nobody takes one more."""
    m, network = len(team), neighbours(params.topology, len(team))
    beliefs = Beliefs(m, len(problem.tasks))
    limit = params.bundle_size or first_limit(len(offered), m)
    most_rounds = _PATIENCE * len(offered) * diameter(params.topology, m)
    last_round = ledger.rounds + most_rounds
    for bidder in until_due(team, stop):
        bidder.offer(offered)
    while not stop.due():
        added = [bidder.build_bundle(beliefs, limit, ledger, stop) for bidder in team]  # phase 1
        if not any(added) and beliefs.agree():
            if params.bundle_size or not any(bidder.could_take_more(beliefs) for bidder in team):
                break
            limit *= 2
            last_round = ledger.rounds + most_rounds
            continue
        if ledger.rounds == last_round:
            raise MusterError(f"consensus-bundle: the robots do not agree within {most_rounds} rounds")
        beliefs.exchange(network, ledger.end_round(), stop)  # phase 2
        for bidder in until_due(team, stop):  # what is not released is not settled
            bidder.release(beliefs)
    return beliefs.agreed_winners()


def until_due(team: Iterable[Bidder], stop: Stop) -> Iterator[Bidder]:
    """The bidders one after the other, as far as there is time."""
    return takewhile(lambda _: not stop.due(), team)


def first_limit(tasks: int, robots: int) -> int:
    """How many tasks a bundle may hold at first: twice the even share."""
    return 2 * math.ceil(tasks / robots)


def layers(problem: Problem, done: set[int]) -> list[list[int]]:
    """The tasks not done, those first that wait for none of the others, then those that wait for these, and so on."""
    waits_for = [[k for k in before if k not in done] for before in problem.prerequisites]
    layer = [j for j in range(len(problem.tasks)) if j not in done and not waits_for[j]]
    left = [len(before) for before in waits_for]
    result = []
    while layer:
        result.append(layer)
        following = []
        for j in layer:
            for dependant in problem.dependants[j]:
                left[dependant] -= 1
                if left[dependant] == 0 and dependant not in done:
                    following.append(dependant)
        layer = sorted(following)
    return result


class ScoreClock:
    """Time as scores see it: what passes is the logarithm of what a reward loses."""

    def __init__(self, problem: Problem, discount: float) -> None:
        self._problem = problem
        longest = max(float(problem.work_seconds(i).max(initial=0.0)) for i in range(len(problem.robots)))
        longest = max(longest, *(robot.available_from_s for robot in problem.robots))
        crossing = extent(problem) / min(robot.speed_mps for robot in problem.robots)
        # The second and third keep all sums in range where there is next to no way between the places.
        self._per_s = -math.log(discount) * _CROSSING / max(crossing, 1e-9 * longest, 1e-150)

    def start(self, i: int) -> float:
        return self._per_s * self._problem.robots[i].available_from_s

    def work(self, i: int) -> Floats:
        """(n,) for the work of robot i on each task."""
        return self._per_s * self._problem.work_seconds(i)

    def travel(self, i: int) -> float:
        """For a unit of robot i's travel usage."""
        return self._per_s if self._problem.in_time else self._per_s / self._problem.robots[i].speed_mps


def extent(problem: Problem) -> float:
    """Metres: the longer side of the box around all places; with travel tables, the longest way in them."""
    table = problem.travel[0]
    if len(table):
        return float(table[np.isfinite(table)].max(initial=0.0))
    points = problem.all_places
    return float(np.ptp(points, axis=0).max())


class Bidder:
    """One robot: its settled route, and the bundle and path of the layer that is auctioned.

    Of the tasks of the layer those that the robot may do are the columns of its arrays. A gap is where a task could go:
    between two places of the path that follow each other, the last one behind the path. For each gap and column there
    is `_reach`: time from the place before the gap to the task; `_loss`: the share of the reward behind the gap that is
    lost; `_growth`: what the usage grows by.
    """

    def __init__(self, problem: Problem, clock: ScoreClock, i: int, route: Sequence[int]) -> None:
        self._problem, self._i = problem, i
        self._capacity = float(problem.capacity[i])
        self._priority = np.array([task.priority for task in problem.tasks])
        self._must_end = problem.robots[i].place_at_end(problem.mission.rules) is not None
        self._work_usage, self._work_time = problem.work_usage(i), clock.work(i)
        self._travel_time = clock.travel(i)
        self._settled, self._path = list(route), list[int]()
        self._settled_usage, self._settled_time = 0.0, clock.start(i)
        place = problem.start(i)
        for j in route:
            self._settled_usage, self._settled_time = self._after(self._settled_usage, self._settled_time, place, j)
            place = j

    @property
    def route(self) -> list[int]:
        return self._settled + self._path

    @property
    def bundle(self) -> tuple[int, ...]:
        """The tasks of the bundle, in the order in which they were added."""
        return tuple(self._bundle)

    def offer(self, tasks: Indices) -> None:
        """Begin with an empty bundle."""
        self._columns = tasks[self._problem.allowed_by_kind[self._problem.kinds[self._i], tasks]]
        self._column = {j: column for column, j in enumerate(self._columns.tolist())}
        self._reward = self._priority[self._columns]
        self._free: Bools = np.ones(len(self._columns), dtype=np.bool_)
        self._home = self._ways_to(self._problem.end(self._i)) if self._must_end else np.zeros(len(self._columns))
        self._bundle: list[int] = []
        self._from: dict[int, Floats] = {}
        self._to: dict[int, Floats] = {}
        self._reach, self._loss, self._growth = (row[None] for row in self._gap(self._place(0), None))
        self._measure()

    def refuse(self, tasks: Sequence[int]) -> None:
        """Bid for none of these, but for what is in the bundle."""
        for j in tasks:
            if j in self._column:
                self._free[self._column[j]] = False

    def build_bundle(self, beliefs: Beliefs, limit: int, ledger: Ledger, stop: Stop) -> bool:
        """Algorithm 3: add the task of highest score that outbids the winner known; whether any was added."""
        z, y = beliefs.z[self._i], beliefs.y[self._i]
        before = len(self._bundle)
        while len(self._bundle) < limit and len(self._columns) and not stop.due():
            gaps, scores = self._scores()
            bids = np.minimum(scores, y[self._bundle[-1]] if self._bundle else math.inf)
            known, holder = y[self._columns], z[self._columns]
            outbids = (bids > known) | ((bids == known) & (bids > NO_BID) & (self._i < holder))
            column = int(np.argmax(np.where(outbids & self._free, scores, NO_BID)))
            if not (outbids[column] and self._free[column]):
                break
            j = int(self._columns[column])
            self._insert(column, int(gaps[column]))
            self._bundle.append(j)
            z[j], y[j] = self._i, bids[column]
            ledger.note(j, self._i, float(bids[column]))
        return len(self._bundle) > before

    def could_take_more(self, beliefs: Beliefs) -> bool:
        """Whether there is a task that nobody wins and that this robot could do."""
        _, scores = self._scores()
        return bool((self._free & (beliefs.z[self._i, self._columns] == NOBODY) & (scores > NO_BID)).any())

    def release(self, beliefs: Beliefs) -> None:
        """Let go of the first task of the bundle that was lost, and of all that were added after it."""
        lost = beliefs.lose(self._i, self._bundle)
        for j in reversed(lost):  # so that every path on the way was one before
            self._remove(j)
        del self._bundle[len(self._bundle) - len(lost) :]

    def settle(self, winners: Indices) -> list[int]:
        """Make the path's tasks that all agree this robot wins part of its route for good, and return them.

        After an interruption some may be missing, and where a way through one is shorter than without it, what is left
        may be too long: then none.
        """
        won = [j for j in self._path if winners[j] == self._i]
        self._path = []
        place, usage, time = self._place(0), self._settled_usage, self._settled_time
        for j in won:
            usage, time = self._after(usage, time, place, j)
            place = j
        whole = usage + self._way_home(place)
        if not (math.isfinite(whole) and whole <= self._capacity * (1 + 2 * _ROUNDING)):
            return []
        self._settled, self._settled_usage, self._settled_time = self._settled + won, usage, time
        return won

    def _scores(self) -> tuple[Indices, Floats]:
        """For each column the gap where the task adds most to the score, and the logarithm of what it adds."""
        with np.errstate(over="ignore"):
            gain = self._reward - self._behind[:, None] * self._loss
        scores = np.log(np.maximum(gain, _TINIEST)) - self._reach - self._leaves[:, None]
        scores[self._usage + self._growth > self._capacity * (1 + _ROUNDING)] = NO_BID
        gaps = len(scores) - 1 - np.argmax(scores[::-1], axis=0)  # of equal ones the last
        return gaps, scores[gaps, np.arange(len(gaps))]

    def _insert(self, column: int, gap: int) -> None:
        j = int(self._columns[column])
        self._path.insert(gap, j)
        self._free[column] = False
        self._replace(gap, 1, [self._gap(self._place(gap), j), self._gap(j, self._task_at(gap + 1))])

    def _remove(self, j: int) -> None:
        at = self._path.index(j)
        del self._path[at]
        self._free[self._column[j]] = True
        self._replace(at, 2, [self._gap(self._place(at), self._task_at(at))])
        del self._from[j]
        self._to.pop(j, None)

    def _replace(self, gap: int, count: int, rows: Sequence[tuple[Floats, Floats, Floats]]) -> None:
        """Put new gaps in the place of old ones."""
        reach, loss, growth = zip(*rows, strict=True)
        self._reach = np.concatenate((self._reach[:gap], reach, self._reach[gap + count :]))
        self._loss = np.concatenate((self._loss[:gap], loss, self._loss[gap + count :]))
        self._growth = np.concatenate((self._growth[:gap], growth, self._growth[gap + count :]))
        self._measure()

    def _gap(self, place: int, following: int | None) -> tuple[Floats, Floats, Floats]:
        """Reach, loss and growth of the gap between a place and the task that follows it in the path, if one does.

        A reward lost is a share of what the tasks behind the gap bring, both as seen on arrival: at the new task, and
        at the first of those behind.
        """
        if place not in self._from:
            self._from[place] = self._problem.legs(self._i, [place], self._columns)[0]
        there = self._from[place]
        if following is None:
            onward, direct, loss = self._home, self._way_home(place), np.zeros(len(self._columns))
        else:
            if following not in self._to:
                self._to[following] = self._ways_to(following)
            onward, direct = self._to[following], there[self._column[following]]
            with np.errstate(over="ignore"):
                at_first = np.exp(self._travel_time * (there - direct))
            loss = at_first - np.exp(-(self._work_time[self._columns] + self._travel_time * onward))
        growth = there + self._work_usage[self._columns] + onward - direct
        no_way = ~np.isfinite(growth)
        reach = np.where(no_way, math.inf, self._travel_time * there)
        return reach, np.where(no_way, 0.0, loss), np.where(no_way, math.inf, growth)

    def _measure(self) -> None:
        """Work out when the robot leaves the place before each gap, the reward behind the gap, and the usage."""
        columns = [self._column[j] for j in self._path]
        place, usage, time = self._place(0), self._settled_usage, self._settled_time
        leaves, ways, works = [time], [], []
        for j, column in zip(self._path, columns, strict=True):
            way = float(self._from[place][column])
            ways.append(self._travel_time * way)
            works.append(float(self._work_time[j]))
            usage = usage + way + float(self._work_usage[j])
            time = time + ways[-1] + works[-1]
            leaves.append(time)
            place = j
        behind = [0.0]
        for k in reversed(range(len(columns))):
            until_next = works[k] + ways[k + 1] if k + 1 < len(columns) else 0.0
            behind.append(float(self._reward[columns[k]]) + behind[-1] * math.exp(-until_next))
        self._leaves, self._behind = np.array(leaves), np.array(behind[::-1])
        self._usage = usage + self._way_home(place)

    def _place(self, gap: int) -> int:
        """The place before a gap."""
        if gap:
            return self._path[gap - 1]
        return self._settled[-1] if self._settled else self._problem.start(self._i)

    def _task_at(self, number: int) -> int | None:
        return self._path[number] if number < len(self._path) else None

    def _ways_to(self, place: int) -> Floats:
        """Usage of the ways from the columns' tasks."""
        return self._problem.legs(self._i, self._columns, [place])[:, 0]

    def _way_home(self, place: int) -> float:
        """Usage of the way from a place to where the route must end; 0 if nowhere, and for a robot at its start."""
        if not self._must_end or place == self._problem.start(self._i):
            return 0.0
        if place in self._column:
            return float(self._home[self._column[place]])
        return float(self._problem.legs(self._i, [place], [self._problem.end(self._i)])[0, 0])

    def _after(self, usage: float, time: float, place: int, j: int) -> tuple[float, float]:
        """Usage and time after going on from a place to a task and doing it."""
        way = float(self._problem.legs(self._i, [place], [j])[0, 0])
        return usage + way + float(self._work_usage[j]), time + self._travel_time * way + float(self._work_time[j])


CONSENSUS_BUNDLE = Allocator(
    name="consensus-bundle",
    summary="robots agree by messages to neighbours; CBBA of Choi, Brunet and How",
    anytime=False,
    parameters=Parameters,
    algorithm=allocate,
    auctions=True,
)
