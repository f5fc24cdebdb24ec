"""Invariants of robots that agree: one owner per task, no ownable task without one, equal views, a valid plan."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from tests.muster_team.trials.observer import Observer, is_of_one_sale
from tests.muster_team.trials.scenario import Scenario

from muster.mission.model import Mission, Task
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster.verification import verify
from muster_team.auctions.epoch import opening_of
from muster_team.auctions.valuation import Valuer
from muster_team.knowledge.facts import in_order
from muster_team.knowledge.messages import Fact, RoundBids
from muster_team.knowledge.new_tasks import task_of
from muster_team.negotiators.methods import METHODS
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.participation import rules_of


class Invariants:
    """Checks the invariants for the robots of one scenario; the observer knows which robot has begun which task."""

    def __init__(self, scenario: Scenario, problem: Problem, observer: Observer) -> None:
        self._scenario, self._problem, self._observer = scenario, problem, observer
        self._rules = rules_of(problem)

    def wrong(self, nodes: Sequence[Negotiator]) -> Iterator[str]:
        """Violations by robots that agree."""
        owners: dict[str, list[str]] = {}
        for node in nodes:
            for claim in node.route:
                owners.setdefault(claim.task, []).append(node.robot)
        for task, robots in owners.items():
            begun = self._observer.begun.get(task, ())
            if len(robots) > 1 and not (_is_one_team(task, nodes) or all(robot in begun for robot in robots)):
                yield f"{task} is owned by {robots}"
        yield from self._could_be_sold(nodes)
        for node in nodes:
            for task in sorted(_reserved(node) - {claim.task for claim in node.route}):
                yield f"{node.robot} keeps {task} from others, and does not own it"
        routes = [{robot: node.valuer.route(robot) for robot in self._rules.robots} for node in nodes]
        if any(other != routes[0] for other in routes):
            yield f"views differ: {routes}"
        yield from self._judged(nodes[0], routes[0])

    def _could_be_sold(self, nodes: Sequence[Negotiator]) -> Iterator[str]:
        """What robots could add if the auction began again with all tasks that must be for sale."""
        asked = {node.robot: self._asked_again(node, nodes) for node in nodes}
        bids = [RoundBids(node.robot, 0, asked[node.robot].bids(node.epoch.refused)) for node in nodes]
        if self._scenario.method != "auction":
            yield from (f"{said.robot} could add {said.bids}" for said in bids if said.bids)
        elif sales := asked[nodes[0].robot].resolve(bids).sales:
            yield f"{sales[0].winner} could add {sales[0].what}"

    def _asked_again(self, node: Negotiator, nodes: Sequence[Negotiator]) -> Valuer:
        base = node.epoch.base
        assert base is not None
        begun = opening_of(base)
        past = {task for tasks in begun.past.values() for task in tasks}
        ahead = {robot: [t for t in node.valuer.route(robot) if t not in past] for robot in self._rules.robots}
        method, terms = METHODS[self._scenario.method], self._scenario.terms
        asked = method.negotiator(self._problem, terms, node.robot, incarnation=1).valuer
        closed = self._closed(node, nodes).intersection(self._rules.with_added(base.added).tasks)
        asked.begin(replace(begun, ahead=ahead, closed=closed))
        return asked

    def _closed(self, node: Negotiator, nodes: Sequence[Negotiator]) -> set[str]:
        """Tasks that need no owner: done, cancelled, perhaps begun, or at-most-once where too few remember."""
        facts = node.facts
        over = {fact.task for fact in facts if fact.kind in ("done", "cancelled")}
        begun = {fact.task for fact in _begun_for_good(facts)}
        few = sum(node.knows for node in nodes) <= len(self._rules.robots) // 2
        return over | begun | (self._observer.once if few else set())

    def _judged(self, node: Negotiator, routes: dict[str, list[str]]) -> Iterator[str]:
        """Violations that the judge finds in the plan; work already done is accepted."""
        past = {fact.task for fact in node.facts if fact.done} | set(self._observer.begun)
        mission = _as_it_is(self._scenario.mission, node, past)
        before = Plan(routes=tuple(Route(r, tuple(t for t in tasks if t in past)) for r, tasks in routes.items()))
        spent = {(v.kind, v.robot) for v in verify(mission, before).violations if v.kind in ("capacity", "shift")}
        plan = Plan(routes=tuple(Route(robot, tuple(tasks)) for robot, tasks in routes.items()))
        for violation in verify(mission, plan).violations:
            if (violation.kind, violation.robot) not in spent:
                yield f"judge: {violation}"


def _as_it_is(mission: Mission, node: Negotiator, past: Collection[str]) -> Mission:
    """The mission with announced tasks; tasks already begun have no prerequisites and no times."""
    added = [task_of(fact.content) for fact in in_order(node.facts) if fact.kind == "added"]
    tasks = (*mission.tasks, *added)
    return replace(mission, tasks=tuple(_begun(task) if task.id in past else task for task in tasks))


def _is_one_team(task: str, nodes: Sequence[Negotiator]) -> bool:
    """Whether all robots that own a task of a team won it in one sale; the judge says whether they are enough."""
    base = nodes[0].epoch.base
    assert base is not None
    return is_of_one_sale(task, nodes) and task in nodes[0].rules.with_added(base.added).teams


def _begun(task: Task) -> Task:
    return replace(task.waiting_for(()), window_s=(), deadline_s=None, same_robot_as=(), other_robot_than=())


def _begun_for_good(facts: Collection[Fact]) -> Iterator[Fact]:
    """Facts that say that a task may have been begun, unless they were waived."""
    waived = {(fact.task, fact.robot, fact.content) for fact in facts if fact.kind == "waived"}
    return (f for f in facts if f.kind == "begun" and (f.task, f.robot, f.content) not in waived)


def _reserved(node: Negotiator) -> set[str]:
    """Unfinished tasks that a robot has declared to begin permanently since it started."""
    done, said = {fact.task for fact in node.facts if fact.done}, (node.robot, str(node.incarnation).encode())
    return {fact.task for fact in _begun_for_good(node.facts) if (fact.robot, fact.content) == said} - done
