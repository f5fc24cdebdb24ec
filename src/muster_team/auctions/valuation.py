"""A robot's bids, and the place of a won task in its route: the rules of the auction in one process, for one robot.

Every robot keeps all routes, since some bids depend on the team (`total+max`), or wait for others (`makespan`). It
computes only its own bids. The same mission, terms and sales give exactly the same bids, so that robots follow each
other's routes without messages.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar, Protocol

from muster.allocation.allocator import Routes
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.coalitions import bid_of
from muster.allocation.capabilities import NONE
from muster.allocation.fixed import admissible_part, with_past
from muster.mission.errors import MusterError, ParameterError
from muster.mission.value_types import shown
from muster.model.problem import Problem
from muster_team.auctions.capabilities import AGREED, refuse_once_together, refuse_what_is_not_agreed
from muster_team.auctions.task_sales import TaskSales
from muster_team.auctions.unit_sales import UnitSales
from muster_team.knowledge.messages import Bid, Reach, RoundBids, Sold
from muster_team.knowledge.new_tasks import task_of, with_tasks

_MISFITS_KEPT = 1000  # more orders under way at once than operators give


@dataclass(frozen=True)
class Opening:
    """The state of the mission when an auction begins.

    Parameters
    ----------
    past
        for each robot what it has done and then what it has begun, in order; no task occurs twice.
    ahead
        for each robot what else it owns, in order.
    closed
        tasks that are not for sale.
    added
        tasks that were added to the mission, as `new_tasks.content_of` writes them, in tie order.
    seen
        the pieces of the map that all members have, where robots build one.
    """

    past: Mapping[str, Sequence[str]] = field(default_factory=dict)
    ahead: Mapping[str, Sequence[str]] = field(default_factory=dict)
    closed: Collection[str] = ()
    added: tuple[bytes, ...] = ()
    seen: tuple[Reach, ...] = ()


@dataclass(frozen=True)
class Resolution:
    """The result of a round: the tasks sold, and whether it was the last round."""

    sales: tuple[Sold, ...] = ()
    over: bool = False


class Valuer(Protocol):
    """The computation of one robot's part in the auction."""

    @property
    def sales_suffice(self) -> bool:
        """Whether a robot that missed rounds needs to know only what was sold in them; else also what was bid."""
        ...

    def check(self, tasks: Sequence[bytes]) -> None:
        """Raise MissionError unless these added or moved tasks, as `new_tasks.content_of` writes them, fit.

        ParameterError if robots cannot agree on them (`capabilities`).
        """
        ...

    def misfit(self, tasks: tuple[bytes, ...]) -> str:
        """The reason for which `check` raises; empty if it does not."""
        ...

    def bids_fault(self, said: RoundBids) -> str:
        """What is wrong in another robot's bids in this round; empty if it may bid so."""
        ...

    def sale_fault(self, sold: Sold) -> str:
        """Why this cannot have been sold in this round; empty if it can."""
        ...

    def begin(self, opening: Opening) -> Mapping[str, Sequence[str]]:
        """Begin an auction; return what robots own as far as they can still do it, without their past."""
        ...

    def bids(self, refused: Collection[str] = ()) -> tuple[Bid, ...]:
        """The robot's bids in this round, as the winner rule needs them; none for tasks that it has refused."""
        ...

    def resolve(self, bids: Sequence[RoundBids]) -> Resolution:
        """The result of a round with these bids of all members; not awarded yet."""
        ...

    def award(self, sold: Sold) -> None:
        """Assign a task to its owner."""
        ...

    def route(self, robot: str) -> list[str]:
        """The tasks of a robot, in the order of execution."""
        ...

    def spans(self) -> Mapping[str, tuple[float, float]]:
        """When tasks begin and end in the earliest schedule of all routes, seconds; none where nothing binds times."""
        ...


class TeamValuer(ABC):
    """Common parts of all methods: the mission with its added tasks, and what robots own already.

    Parameters
    ----------
    problem
        the same for all robots; from `begin` on with added tasks and past work.
    robot
        the robot whose bids are computed.

    Attributes
    ----------
    can
        what rules of time, teams and relations the method agrees on.
    by_map
        where robots build a map, what returns the problem with ways by some pieces of it.
    """

    by_map: Callable[[Problem, tuple[Reach, ...]], Problem] | None = None
    can: ClassVar[frozenset[str]] = NONE

    def __init__(self, problem: Problem, robot: str) -> None:
        refuse_what_is_not_agreed(problem, self.can)
        self._given = self._whole = self.problem = problem
        self._robots, self._tasks = problem.robot_index, problem.task_index
        self._me = self._robots[robot]
        self._opened_with: tuple[tuple[bytes, ...], tuple[Reach, ...]] = ((), ())
        self._misfits: dict[tuple[bytes, ...], str] = {}

    def check(self, tasks: Sequence[bytes]) -> None:
        whole = with_tasks(self._given, tasks)
        for task in map(task_of, tasks):
            before = self._given.task_index.get(task.id)
            if before is not None and replace(self._given.tasks[before], position=task.position) != task:
                raise ParameterError(f"moved task: {shown(task.id)}; expected another position, and else what it is")
        refuse_what_is_not_agreed(whole, self.can)
        refuse_once_together(whole.tasks, (whole.holds("team"), whole.holds("relation")), self._given.tasks)

    def misfit(self, tasks: tuple[bytes, ...]) -> str:
        if tasks not in self._misfits:
            if len(self._misfits) >= _MISFITS_KEPT:
                self._misfits.clear()
            self._misfits[tasks] = self._reason_against(tasks)
        return self._misfits[tasks]

    def _reason_against(self, tasks: tuple[bytes, ...]) -> str:
        try:
            self.check(tasks)
        except MusterError as error:
            return str(error)
        return ""

    @abstractmethod
    def bids_fault(self, said: RoundBids) -> str: ...

    @abstractmethod
    def sale_fault(self, sold: Sold) -> str: ...

    def _no_such_task(self, tasks: Sequence[str]) -> str:
        """A fault of statements about these tasks: one is unknown, or stated twice; empty: none is."""
        wrong = next((task for k, task in enumerate(tasks) if task not in self._tasks or task in tasks[:k]), None)
        return "" if wrong is None else f"the task {shown(wrong)}, which there is not, or twice"

    def begin(self, opening: Opening) -> Mapping[str, Sequence[str]]:
        if (opening.added, opening.seen) != self._opened_with:
            self._opened_with = (opening.added, opening.seen)
            given = self._given if self.by_map is None else self.by_map(self._given, opening.seen)
            self._whole = with_tasks(given, opening.added)
        number = self._whole.task_index
        past, ahead = self._by_index(opening.past, number), self._by_index(opening.ahead, number)
        self.problem = with_past(self._whole, past) if any(past) else self._whole
        self._tasks = self.problem.task_index
        begun = [self.problem.beginning(i) for i in range(len(past))]
        routes = admissible_part(self.problem, [[*before, *after] for before, after in zip(begun, ahead, strict=True)])
        closed = {number[task] for task in opening.closed}.union(*past)
        self._open(routes, closed)
        return {robot.id: self.route(robot.id)[len(begun[i]) :] for i, robot in enumerate(self.problem.robots)}

    @abstractmethod
    def _open(self, routes: Routes, closed: Collection[int]) -> None:
        """Begin an auction: these tasks have owners, all others are for sale except for those that are closed."""

    @abstractmethod
    def route(self, robot: str) -> list[str]: ...

    def spans(self) -> Mapping[str, tuple[float, float]]:
        return {}

    def _by_index(self, routes: Mapping[str, Sequence[str]], number: Mapping[str, int]) -> list[list[int]]:
        by_index: list[list[int]] = [[] for _ in self._robots]
        for robot, tasks in routes.items():
            by_index[self._robots[robot]] = [number[task] for task in tasks]
        return by_index


class AuctionValuer(TeamValuer):
    """The auction of `allocation`, run by one of its robots; `terms` are the same for all.

    Where times, teams or relations bind tasks, units of work are sold (`unit_sales`), else tasks (`task_sales`).
    """

    can = AGREED
    sales_suffice = True

    def __init__(self, problem: Problem, terms: Terms, robot: str) -> None:
        super().__init__(problem, robot)
        self.terms = terms
        self._refuse_bid(problem)

    def check(self, tasks: Sequence[bytes]) -> None:
        super().check(tasks)
        self._refuse_bid(with_tasks(self._given, tasks))

    def _open(self, routes: Routes, closed: Collection[int]) -> None:
        kind = UnitSales if self.problem.core.is_timed else TaskSales
        self.sales: TaskSales | UnitSales = kind(self.problem, self.terms, routes, closed)

    def bids(self, refused: Collection[str] = ()) -> tuple[Bid, ...]:
        return self.sales.bids(self._me, refused) if self._tasks else ()

    def resolve(self, bids: Sequence[RoundBids]) -> Resolution:
        sold = self.sales.winner(bids) if any(said.bids for said in bids) else None
        return Resolution(over=True) if sold is None else Resolution((sold,))

    def award(self, sold: Sold) -> None:
        self.sales.award(sold)

    def route(self, robot: str) -> list[str]:
        return [self.problem.tasks[j].id for j in self.sales.routes[self._robots[robot]]]

    def bids_fault(self, said: RoundBids) -> str:
        if wrong := self._no_such_task([task for task, _ in said.bids]):
            return wrong
        robot = self._robots[said.robot]
        refused = (task for task, _ in said.bids if not self.sales.may_bid(robot, self._tasks[task]))
        return next((not_for_sale([(said.robot, task)]) for task in refused), "")

    def sale_fault(self, sold: Sold) -> str:
        if wrong := self._no_such_task(list(dict.fromkeys(task for _, task in sold.assignments))):
            return wrong
        pairs = [(self._robots[robot], self._tasks[task]) for robot, task in sold.assignments]
        return "" if self.sales.can_win(pairs) else not_for_sale(sold.assignments)

    def spans(self) -> Mapping[str, tuple[float, float]]:
        return self.sales.spans() if isinstance(self.sales, UnitSales) else {}

    def _refuse_bid(self, problem: Problem) -> None:
        if problem.core.is_timed:
            bid_of(problem, self.terms)


def not_for_sale(assignments: Sequence[tuple[str, str]]) -> str:
    """Why robots cannot win these tasks now, each its own."""
    return ", ".join(f"{shown(task)} for {shown(robot)}" for robot, task in assignments) + ", which is not for sale"
