"""One trial: a scenario in a simulated network, and the invariants after its last incident."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from random import Random

from tests.muster_team.trials.deadline import deadline_s, someone_is_left_out
from tests.muster_team.trials.faults import Incident
from tests.muster_team.trials.invariants import Invariants
from tests.muster_team.trials.observer import Observer
from tests.muster_team.trials.scenario import Scenario, scenario_of

from muster.mission.errors import MissionError, ParameterError
from muster.model.problem import Problem
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.messages import Claim
from muster_team.negotiators.methods import METHODS
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.participation import rules_of
from muster_team.network.memory_network import MemoryNetwork

LONGEST_S = 120.0
"""The time limit of agreement after the last incident, seconds of virtual time; `deadline` has the stricter one."""

LOOK_S = 0.1
"""The interval at which idle robots try to begin a task."""

CLOCK_STEP = 1000
"""Incarnations come from clocks, so no two starts of a robot have the same one."""


@dataclass
class Report:
    """The result of a trial: violations, the time to agreement, its share of the deadline, and counts of events."""

    scenario: Scenario
    failures: list[str] = field(default_factory=list)
    took_s: float = 0.0
    share: float = 0.0
    counts: Counter[str] = field(default_factory=Counter)

    def lines(self) -> Iterator[str]:
        """The report as text."""
        yield from self.scenario.described()
        yield f"agreed {self.took_s:.2f} s after it was quiet, {self.share:.0%} of what that may take"
        yield from (f"  {name}: {count}" for name, count in sorted(self.counts.items()))
        yield from self.failures or ["nothing failed"]


def replay(seed: int, *, timed: bool = False) -> Report:
    """Run the trial of a seed, of a mission with times if `timed`; it is deterministic."""
    return Trial(scenario_of(seed, timed=timed)).run()


class Trial:
    """A scenario in a simulated network."""

    def __init__(self, given: Scenario) -> None:
        self.scenario = given
        self.problem = Problem.compile(given.mission).ready()
        self.rules = rules_of(self.problem)
        self.method = METHODS[given.method]
        self.report = Report(given)
        self._memory: dict[str, Memory] = {}
        self._forgot: set[str] = set()
        self._dice = Random(f"work {given.seed}")
        self._clocks = Random(f"clocks {given.seed}")
        self._doing: dict[str, tuple[str, float]] = {}  # by robot its task, and when it ends
        links = given.links
        self.network = MemoryNetwork(
            self._negotiator,
            [robot.id for robot in self.problem.robots],
            given.seed,
            given.conditions,
            None if links is None else lambda one, other: (one, other) in links,
            lambda robot: self.observer.look(robot),
        )
        once = {i.task.id for i in given.incidents if i.task is not None and i.task.across_partition == "at-most-once"}
        self.observer = Observer(self.network.nodes, {*self.rules.once, *once})
        self.invariants = Invariants(given, self.problem, self.observer)

    def run(self) -> Report:
        for incident in self.scenario.incidents:
            self.network.at(incident.at_s, lambda incident=incident: self._happen(incident))  # type: ignore[misc]
        if self.scenario.work_s is not None:
            self.network.at(LOOK_S, self._work)
        self.network.run(self.scenario.quiet_s)
        self.network.heal()
        self._await_agreement()
        self.report.failures += self.observer.broken
        self.report.counts["runs"] += 1
        self.report.counts += self.observer.counts + self.network.counts
        self.report.counts["robots that live at the end"] += len(self.network.nodes)
        self.report.counts["tasks begun"] += len(self.observer.begun)
        return self.report

    def _await_agreement(self) -> None:
        """Run until each group has agreed, and check the invariants then.

        A group that hears robots that do not hear it waits for them in vain: it need not agree.
        """
        nodes, left, began_s = self.network.nodes, self._groups(), self.network.now
        left_out = someone_is_left_out(nodes.values(), began_s)
        waiting = [group for group in left if self._hears_others(group)]
        self.report.counts["groups"] += len(left)
        self.report.counts["groups that hear robots that do not hear them"] += len(waiting)

        def all_have() -> bool:
            for group in [group for group in left if self._agrees(group)]:
                left.remove(group)
                self.report.failures += self.invariants.wrong([nodes[robot] for robot in group])
                if group not in waiting:
                    self._note_time(group, self.network.now - began_s, left_out=left_out)
            return not left

        self.network.run(began_s + LONGEST_S, all_have)
        for group in left:
            if group in waiting:
                self.report.counts["groups that hear robots that do not hear them, and do not agree"] += 1
            else:
                stages = {name: (node.stage, node.epoch.own.members) for name, node in nodes.items()}
                self.report.failures.append(f"no agreement of {group}: {stages}")

    def _note_time(self, group: Sequence[str], took_s: float, *, left_out: bool) -> None:
        rounds = self.network.nodes[group[0]].stage.round
        deadline = deadline_s(self.scenario, group, rounds, left_out=left_out)
        self.report.took_s = max(self.report.took_s, took_s)
        self.report.share = max(self.report.share, took_s / deadline)
        if took_s > deadline:
            self.report.failures.append(f"{group} agreed after {took_s:.1f} s, which should take {deadline:.1f} s")

    def _negotiator(self, robot: str, incarnation: int) -> Negotiator:
        self.observer.started(robot)
        return self.method.negotiator(
            self.problem,
            self.scenario.terms,
            robot,
            incarnation=incarnation,
            timeouts=self.scenario.timeouts,
            remembered=self._memory.pop(robot, None),
            forgot=robot in self._forgot,
        )

    def _happen(self, incident: Incident) -> None:
        kind, robot, nodes = incident.kind, incident.robot, self.network.nodes
        node = nodes.get(robot)
        if kind in ("cut", "block", "heal"):
            self.network.heal()
            self.network.cut(*incident.groups)
            self.network.block(incident.links)
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
        before = self.network.incarnations[robot]
        clock_set_back = forgets and before > 0 and self._clocks.random() < 0.5
        step = -self._clocks.randrange(2, CLOCK_STEP) if clock_set_back else CLOCK_STEP
        self.network.start([robot], before + step)
        self.report.counts["starts without memory after a clock was set back"] += clock_set_back

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
        """Robots do their tasks, one at a time; they try those not begun in random order."""
        assert self.scenario.work_s is not None
        for robot, node in self.network.nodes.items():
            task, ends_s = self._doing.get(robot, ("", 0.0))
            if task and self.network.now >= ends_s:
                node.finish(task)
                del self._doing[robot]
            if robot not in self._doing and node.route and self._dice.random() < self.scenario.begin_probability:
                self._take_up(node, next((c for c in node.route if c.begun), self._dice.choice(node.route)))
            self.observer.look(robot)
        if self.network.now + LOOK_S < self.scenario.quiet_s:
            self.network.at(self.network.now + LOOK_S, self._work)

    def _take_up(self, node: Negotiator, claim: Claim) -> None:
        assert self.scenario.work_s is not None
        if node.begin(claim.task):
            self.observer.begins(node.robot, claim.task, again=claim.begun)
            self._doing[node.robot] = claim.task, self.network.now + self.scenario.work_s

    def _groups(self) -> list[list[str]]:
        """Groups of running robots that can exchange messages in both directions, if need be through others."""
        links, groups, left = self.scenario.links, [], set(self.network.nodes)
        while left:
            group = [left.pop()]
            for a in group:
                near = {b for b in left if links is None or {(a, b), (b, a)} <= links}
                group += sorted(near)
                left -= near
            groups.append(sorted(group))
        return groups

    def _hears_others(self, group: Sequence[str]) -> bool:
        """Whether a group receives messages of robots outside of it."""
        links, others = self.scenario.links or frozenset(), self.network.nodes.keys() - set(group)
        return any((a, b) in links for a in others for b in group)

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
        """Whether a robot that has lost its memory could restore it from a majority of the others."""
        others = sum(other.knows for other in nodes if other is not node)
        return not node.knows and others > len(self.rules.robots) // 2
