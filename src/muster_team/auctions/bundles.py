"""CBBA on the rounds of an epoch: one robot's part in the consensus-based bundle algorithm.

Choi, Brunet and How, 2009; `allocation.consensus_bundle` runs it in one process. A round is one of the paper's: each
robot adds to its bundle and publishes what it added, then all read each other. The result of reading follows from what
was published. So every robot keeps the beliefs of all, and nothing else is sent. When nobody adds a task and all agree,
one round asks who could take more than bundles may hold, and one publishes the order in which robots do what they won,
which only they know.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from enum import Enum

import numpy as np

from muster.allocation.allocator import Routes
from muster.allocation.auctions.consensus import Beliefs, Ledger
from muster.allocation.auctions.consensus_bundle import Bidder, Parameters, ScoreClock, first_limit, layers
from muster.allocation.stop import Stop
from muster.model.problem import Problem
from muster_team.auctions.valuation import Resolution, TeamValuer, not_for_sale
from muster_team.knowledge.messages import Bid, RoundBids, Sold


class _Phase(Enum):
    BUILDING = "building"
    ASKING = "asking"
    TELLING = "telling"


class BundleValuer(TeamValuer):
    """One robot's part in CBBA. `params` are the same for all robots; their topology is ignored.

    The network counts as complete, since the protocol relays messages.
    """

    sales_suffice = False

    def __init__(self, problem: Problem, params: Parameters, robot: str) -> None:
        super().__init__(problem, robot)
        self.params = params
        self._routes: Routes = []
        self._limit = 0
        self._phase = _Phase.BUILDING

    def _open(self, routes: Routes, closed: Collection[int]) -> None:
        self._routes = [list(route) for route in routes]
        clock = ScoreClock(self.problem, self.params.discount)
        self._bidder = Bidder(self.problem, clock, self._me, self._routes[self._me])
        self.ledger = Ledger()
        self._done = {j for route in self._routes for j in route}
        self._closed = closed
        self._layers = layers(self.problem, self._done)
        self._next_layer()

    def bids(self, refused: Collection[str] = ()) -> tuple[Bid, ...]:
        """What the robot publishes in this round: what it adds, whether it could take more, or its order."""
        self._bidder.refuse([self._tasks[task] for task in refused if task in self._tasks])
        if self._phase is _Phase.TELLING:
            mine = self._beliefs.z[self._me] == self._me
            return tuple(self._bid(j) for j in self._bidder.route if mine[j] and j not in self._done)
        if self._phase is _Phase.ASKING:
            more = len(self._offered) and self._bidder.could_take_more(self._beliefs)
            return ((self.problem.tasks[int(self._offered[0])].id, 0.0),) if more else ()
        before = len(self._bidder.bundle)
        self._bidder.build_bundle(self._beliefs, self._limit, self.ledger, Stop())
        return tuple(self._bid(j) for j in self._bidder.bundle[before:])

    def resolve(self, bids: Sequence[RoundBids]) -> Resolution:
        """The result of a round in which all members published this."""
        members = [self._robots[said.robot] for said in bids]
        if self._phase is _Phase.TELLING:
            return self._settle(bids)
        if self._phase is _Phase.ASKING:
            more = any(said.bids for said in bids)
            self._limit *= 2 if more else 1
            self._phase = _Phase.BUILDING if more else _Phase.TELLING
            return Resolution()
        self._take_in(bids)
        if not any(said.bids for said in bids) and self._agree(members):
            self._phase = _Phase.TELLING if self.params.bundle_size else _Phase.ASKING
        else:
            self._exchange(members)
        return Resolution()

    def bids_fault(self, said: RoundBids) -> str:
        names, i = [task for task, _ in said.bids], self._robots[said.robot]
        if wrong := self._no_such_task(names):
            return wrong
        tasks = [self._tasks[task] for task in names]
        if self._phase is _Phase.TELLING:
            mine = self._beliefs.z[i] == i
            return "" if all(mine[j] and j not in self._done for j in tasks) else "the order of tasks that others won"
        offered, had = set(self._offered.tolist()), set(self._bundles[i])
        if self._phase is _Phase.ASKING:
            return "" if tasks in ([], self._offered[:1].tolist()) else "a bid for tasks that are not asked for"
        fits = all(j in offered and j not in had and self.problem.may(i, j) for j in tasks)
        return "" if fits else "a bid for tasks that are not offered to it"

    def sale_fault(self, sold: Sold) -> str:
        if wrong := self._no_such_task([sold.task]):
            return wrong
        robot, task = self._robots[sold.robot], self._tasks[sold.task]
        is_for_sale = task not in self._closed and not any(task in route for route in self._routes)
        if is_for_sale and self.problem.may(robot, task) and not sold.others:
            return ""
        return not_for_sale(sold.assignments)

    def award(self, sold: Sold) -> None:
        self._routes[self._robots[sold.robot]].append(self._tasks[sold.task])

    def route(self, robot: str) -> list[str]:
        return [self.problem.tasks[j].id for j in self._routes[self._robots[robot]]]

    def _next_layer(self) -> bool:
        """Offer the tasks of the next layer whose prerequisites are all owned; return whether there is a layer."""
        m, n = len(self.problem.robots), len(self.problem.tasks)
        self._beliefs, self._phase = Beliefs(m, n), _Phase.BUILDING
        self._bundles: list[list[int]] = [[] for _ in range(m)]  # of others: its own its bidder has
        layer = self._layers.pop(0) if self._layers else []
        ready = [j for j in layer if self._done.issuperset(self.problem.prerequisites[j])]
        offered = [j for j in ready if j not in self._closed]
        self._offered = np.array(offered, dtype=np.int64)
        self._limit = self.params.bundle_size or first_limit(len(offered), m)
        self._bidder.offer(self._offered)
        return bool(layer)

    def _take_in(self, bids: Sequence[RoundBids]) -> None:
        """Note what the others have added; this robot's own additions are noted already."""
        for said in bids:
            i = self._robots[said.robot]
            for task, bid in said.bids if i != self._me else ():
                j = self._tasks[task]
                self._bundles[i].append(j)
                self.ledger.note(j, i, bid)
                self._beliefs.z[i, j], self._beliefs.y[i, j] = i, bid

    def _exchange(self, members: Sequence[int]) -> None:
        """Phase 2: all members read each other, and release what they lost."""
        network = [[k for k in members if k != i] if i in members else [] for i in range(len(self._robots))]
        self._beliefs.exchange(network, self.ledger.end_round(), Stop())
        for bundle, lost in [(b, self._beliefs.lose(i, b)) for i, b in enumerate(self._bundles)]:
            del bundle[len(bundle) - len(lost) :]
        self._bidder.release(self._beliefs)

    def _agree(self, members: Sequence[int]) -> bool:
        z, y = self._beliefs.z[members], self._beliefs.y[members]
        return bool((z == z[0]).all() and (y == y[0]).all())

    def _settle(self, bids: Sequence[RoundBids]) -> Resolution:
        """Assign the layer's tasks to their robots, in their order, and go on to the next layer."""
        sold = [Sold(said.robot, task, price) for said in bids for task, price in said.bids]
        for one in sold:
            self._done.add(self._tasks[one.task])
        self._bidder.settle(self._beliefs.z[self._me])
        return Resolution(tuple(sold), over=not self._next_layer())

    def _bid(self, j: int) -> Bid:
        return self.problem.tasks[j].id, float(self._beliefs.y[self._me, j])
