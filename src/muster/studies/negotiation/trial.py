"""One scene played, and what must hold when it is quiet again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace

from muster.allocation.problem import Problem
from muster.mission.errors import MissionError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.negotiation.epoch import opening_of
from muster.negotiation.happenings import Memory
from muster.negotiation.knowledge import in_order
from muster.negotiation.memory_network import MemoryNetwork
from muster.negotiation.messages import Bid
from muster.negotiation.methods import METHODS
from muster.negotiation.negotiator import Negotiator
from muster.negotiation.taking_part import rules_of
from muster.negotiation.tasks import task_of
from muster.studies.negotiation.incidents import Incident
from muster.studies.negotiation.observer import Observer
from muster.studies.negotiation.scene import Scene, scene
from muster.verification import verify

BOUND_S = 60.0
"""So long after the last incident all must agree, seconds of virtual time."""


@dataclass
class Report:
    """What was wrong, how long agreement took, and how often what was seen."""

    scene: Scene
    failures: list[str] = field(default_factory=list)
    took_s: float = 0.0
    counts: Counter[str] = field(default_factory=Counter)

    def lines(self) -> Iterator[str]:
        """For people."""
        yield from self.scene.described()
        yield f"agreed {self.took_s:.2f} s after it was quiet"
        yield from (f"  {name}: {count}" for name, count in sorted(self.counts.items()))
        yield from self.failures or ["nothing failed"]


def replay(seed: int) -> Report:
    """The run of a seed, the same each time."""
    return Play(scene(seed)).run()


class Play:
    """A scene in a simulated network."""

    def __init__(self, given: Scene) -> None:
        self.scene = given
        self.problem = Problem.compile(given.mission).ready()
        self.rules = rules_of(self.problem)
        self.method = METHODS[given.method]
        self.report = Report(given)
        self._memory: dict[str, Memory] = {}
        self._forgot: set[str] = set()
        self._doing: dict[str, tuple[str, float]] = {}  # by robot its task, and when it ends
        links = given.links
        self.network = MemoryNetwork(
            self._negotiator,
            [robot.id for robot in self.problem.robots],
            given.seed,
            given.weather,
            None if links is None else lambda one, other: (one, other) in links,
            lambda robot: self.observer.look(robot),
        )
        once = {i.task.id for i in given.incidents if i.task is not None and i.task.across_partition == "at-most-once"}
        self.observer = Observer(self.network.nodes, {*self.rules.once, *once})

    def run(self) -> Report:
        for incident in self.scene.incidents:
            self.network.at(incident.at_s, lambda incident=incident: self._happen(incident))  # type: ignore[misc]
        if self.scene.work_s is not None:
            self.network.at(0.1, self._work)
        self.network.run(self.scene.quiet_s)
        self.network.heal()
        groups = self._groups()
        agreed = self.network.run(self.scene.quiet_s + BOUND_S, lambda: all(map(self._agrees, groups)))
        self.report.took_s = self.network.now - self.scene.quiet_s
        self.report.failures += self.observer.broken
        self.report.counts["runs"] += 1
        self.report.counts["runs with links that go one way: agreement is not looked at"] += not groups
        if agreed:
            for group in groups:
                self.report.failures += self._wrong([self.network.nodes[robot] for robot in group])
        else:
            stages = {name: (node.stage, node.epoch.own.members) for name, node in self.network.nodes.items()}
            self.report.failures.append(f"no agreement: {stages}")
        self.report.counts += self.observer.counts + self.network.counts
        self.report.counts["robots that live at the end"] += len(self.network.nodes)
        self.report.counts["tasks begun"] += len(self.observer.begun)
        return self.report

    def _negotiator(self, robot: str, incarnation: int) -> Negotiator:
        self.observer.started(robot)
        return self.method.negotiator(
            self.problem,
            self.scene.terms,
            robot,
            incarnation=incarnation,
            remembered=self._memory.pop(robot, None),
            forgot=robot in self._forgot,
        )

    def _happen(self, incident: Incident) -> None:
        kind, robot, nodes = incident.kind, incident.robot, self.network.nodes
        node = nodes.get(robot)
        if kind in ("cut", "deafen", "heal"):
            self.network.heal()
            self.network.cut(*incident.groups)
            self.network.deafen(incident.links)
        elif kind in ("start", "restart", "forget"):
            self._start(robot, forgets=kind == "forget")
        elif node is None:
            return
        elif kind == "crash":
            if len(nodes) > 1:
                self._memory[robot] = self.network.crash(robot).memory
                self._doing.pop(robot, None)
                self.observer.gone(robot)
        else:
            self._order(node, incident)
        self.report.counts[f"incident: {kind}"] += 1

    def _start(self, robot: str, *, forgets: bool) -> None:
        if robot in self.network.nodes:
            return
        if forgets:
            self._forgot.add(robot)
            self._memory.pop(robot, None)
        self.network.start([robot])

    def _order(self, node: Negotiator, incident: Incident) -> None:
        task = "" if incident.task is None else incident.task.id
        owned = [claim.task for claim in node.route if not claim.begun]
        try:
            if incident.kind == "announce":
                assert incident.task is not None
                node.announce(incident.task)
            elif incident.kind == "cancel":
                node.cancel(task)
            elif incident.kind == "withdraw":
                node.withdraw()
            elif owned:
                node.release(owned[-1])
        except (MissionError, ParameterError) as error:
            self.report.failures.append(f"{incident.kind}: {error}")

    def _work(self) -> None:
        """Robots do their tasks, one after the other; who waits for one tries the next."""
        assert self.scene.work_s is not None
        for robot, node in self.network.nodes.items():
            task, ends_s = self._doing.get(robot, ("", 0.0))
            if task and self.network.now >= ends_s:
                node.finish(task)
                del self._doing[robot]
            if robot not in self._doing:
                self._take_up(robot, node, [(claim.task, claim.begun) for claim in node.route])
            self.observer.look(robot)
        if self.network.now + 0.1 < self.scene.quiet_s:
            self.network.at(self.network.now + 0.1, self._work)

    def _take_up(self, robot: str, node: Negotiator, route: Sequence[tuple[str, bool]]) -> None:
        assert self.scene.work_s is not None
        for task, again in route:
            if node.begin(task):
                self.observer.begins(robot, task, again=again)
                self._doing[robot] = task, self.network.now + self.scene.work_s
                return

    def _groups(self) -> list[list[str]]:
        """Robots that live and can speak with each other, if need be through others.

        Where some can only listen there are none: no agreement is promised there.
        """
        nodes, links = self.network.nodes, self.scene.links
        if links is not None and any((b, a) not in links for a, b in links if a in nodes and b in nodes):
            return []
        groups, left = [], set(nodes)
        while left:
            group = [left.pop()]
            for a in group:
                near = {b for b in left if links is None or (a, b) in links}
                group += sorted(near)
                left -= near
            groups.append(sorted(group))
        return groups

    def _agrees(self, group: Sequence[str]) -> bool:
        nodes = [self.network.nodes[robot] for robot in group]
        first = nodes[0]
        return (
            all(node.settled for node in nodes)
            and set(first.epoch.own.members) == set(group)
            and all(node.stage == first.stage and node.known == first.known for node in nodes)
            and not any(self._could_be_told(node, nodes) for node in nodes)
        )

    def _could_be_told(self, node: Negotiator, nodes: Sequence[Negotiator]) -> bool:
        """Whether a robot that has forgotten what it said could know it again from a majority of others."""
        others = sum(other.knows for other in nodes if other is not node)
        return not node.knows and others > len(self.rules.robots) // 2

    def _wrong(self, nodes: Sequence[Negotiator]) -> Iterator[str]:
        """What is wrong with robots that agree."""
        owners: dict[str, list[str]] = {}
        for node in nodes:
            for claim in node.route:
                owners.setdefault(claim.task, []).append(node.robot)
        for task, robots in owners.items():
            if len(robots) > 1 and not all(robot in self.observer.begun.get(task, ()) for robot in robots):
                yield f"{task} is owned by {robots}"
        for node in nodes:
            if bids := self._could_add(node, nodes):
                yield f"{node.robot} could add {bids}"
        routes = [{robot: node.valuer.route(robot) for robot in self.rules.robots} for node in nodes]
        if any(other != routes[0] for other in routes):
            yield f"views differ: {routes}"
        yield from self._judged(nodes[0], routes[0])

    def _could_add(self, node: Negotiator, nodes: Sequence[Negotiator]) -> tuple[Bid, ...]:
        """What a robot would bid if the auction began again, with all for sale that has to be."""
        base = node.epoch.base
        assert base is not None
        begun = opening_of(base)
        past = {task for tasks in begun.past.values() for task in tasks}
        ahead = {robot: [t for t in node.valuer.route(robot) if t not in past] for robot in self.rules.robots}
        asked = self.method.negotiator(self.problem, self.scene.terms, node.robot, incarnation=1).valuer
        closed = self._closed(node, nodes).intersection(self.rules.with_added(base.added).tasks)
        asked.begin(replace(begun, ahead=ahead, closed=closed))
        return asked.bids(node.epoch.refused)

    def _closed(self, node: Negotiator, nodes: Sequence[Negotiator]) -> set[str]:
        """Tasks that nobody need own: done, cancelled, perhaps begun for good, or once and too few here that know."""
        facts = node.facts
        waived = {(fact.task, fact.robot, fact.content) for fact in facts if fact.kind == "waived"}
        over = {fact.task for fact in facts if fact.kind in ("done", "cancelled")}
        begun = {f.task for f in facts if f.kind == "begun" and (f.task, f.robot, f.content) not in waived}
        few = sum(node.knows for node in nodes) <= len(self.rules.robots) // 2
        return over | begun | (self.observer.once if few else set())

    def _judged(self, node: Negotiator, routes: dict[str, list[str]]) -> Iterator[str]:
        """What the judge says of the plan; what has happened may be: robots that forgot, or were alone, did it."""
        past = {fact.task for fact in node.facts if fact.done} | set(self.observer.begun)
        mission = _as_it_is(self.scene.mission, node, past)
        before = Plan(routes=tuple(Route(r, tuple(t for t in tasks if t in past)) for r, tasks in routes.items()))
        spent = {v.robot for v in verify(mission, before).violations if v.kind == "capacity"}
        plan = Plan(routes=tuple(Route(robot, tuple(tasks)) for robot, tasks in routes.items()))
        for violation in verify(mission, plan).violations:
            if not (violation.kind == "capacity" and violation.robot in spent):
                yield f"judge: {violation}"


def _as_it_is(mission: Mission, node: Negotiator, past: Collection[str]) -> Mission:
    """The mission with the tasks that were added, in which what was begun waits for nothing."""
    added = [task_of(fact.content) for fact in in_order(node.facts) if fact.kind == "added"]
    tasks = (*mission.tasks, *added)
    return replace(mission, tasks=tuple(replace(t, prerequisites=()) if t.id in past else t for t in tasks))
