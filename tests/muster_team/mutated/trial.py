"""A team of five at work, through cuts, orders and a restart, and mutated messages at its robots in every phase.

Most are read by copies of robots, one copy after the other: so much can be said to one state, and a robot that is found
to state two things is heard again. Some reach the robots themselves, which have to agree in the end.
"""

import traceback
from collections import Counter
from contextlib import suppress
from functools import partial
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tests.muster_team.byzantine.mutations import codec_of
from tests.muster_team.byzantine.trial import LIAR, give_orders, look_at_the_others, problem_of, work
from tests.muster_team.model.states import Store
from tests.muster_team.mutated.mouth import Mouth
from tests.muster_team.mutated.sealed_robots import HashKeys, SealedRobot
from tests.trials import Report

from muster.allocation.auctions.auction import Parameters
from muster.allocation.auctions.consensus_bundle import Parameters as BundleParameters
from muster_team.knowledge.admission import healed
from muster_team.negotiators.participation import bundler_of, negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork
from muster_team.processes.memory_file import Kept, kept_in

PHASES, WORDS = 20, 1000
"""Moments of a run, and messages at each."""

_LIES_FROM = 12  # before that moment the robots themselves hear no lies, so that the liar is still one of them
_LIES = 10
_CUT, _HEALED, _CRASH, _RESTART = 6, 8, 14, 15
_LONG_S = {5: 2.0, 7: 5.0, 11: 2.0, 14: 5.0}
"""Time before moments at which robots are to have agreed, or to have noticed who is lost; before others it is short."""


class _Copies(Store):
    """The stored states of one robot, for copies that share nothing with the robot."""

    def copied(self, node):
        """A function that makes a copy of the robot as it is now."""
        stored = self.stored(node)

        def copy():
            self._valuers.clear()
            return self.loaded(stored)

        return copy


class Trial:
    """One run; `report` says what became of it."""

    def __init__(self, seed, phases=PHASES, words=WORDS):
        self.random, self.report = Random(seed), Report(seed)
        self._phases, self._words = phases, words
        kind, problem = problem_of(self.random)
        self._robots = [robot.id for robot in problem.robots]
        self._codec = codec_of(problem)
        self._keys = {robot: HashKeys(robot, self._robots) for robot in self._robots}
        self._bundles = kind != "timed" and self.random.random() < 0.2
        make, terms = (bundler_of, BundleParameters()) if self._bundles else (negotiator_of, Parameters())
        self._copies = {
            robot: _Copies(partial(make, problem, terms, robot, signatures=self._keys[robot])) for robot in self._robots
        }
        self._memories = {}
        self._begun = Counter()
        self.mouth = Mouth(self._codec, self._keys[LIAR], self._robots, self.random)
        self.net = MemoryNetwork(
            self._make,
            self._robots,
            seed,
            LinkConditions(delay_s=0.02, loss=self.random.choice((0.0, 0.1))),
            watch=partial(work, lambda: self.net, self._begun, self.random),
            sent=self.mouth.hear,
        )

    def run(self):
        with self.report.trying(), TemporaryDirectory() as folder:
            self._file = Path(folder, "memory")
            self.net.start()
            for phase in range(self._phases):
                self._happen(phase)
                self.net.run(self.net.now + _LONG_S.get(phase, self.random.choice((0.0, 0.02, 0.02, 0.04, 0.1))))
                self._look(phase)
            self.net.heal()
            look_at_the_others(self.net, self._begun, self.report)
        return self.report

    def _make(self, robot, number):
        memory = self._memories.pop(robot, None)
        node = self._copies[robot].fresh(incarnation=number, remembered=memory, forgot=memory is None and number > 1)
        return SealedRobot(node, self._codec)

    def _happen(self, phase):
        """What else befalls the team at this moment."""
        if phase == 1:
            give_orders(self.net, self.random)
        elif phase == _CUT and self.random.random() < 0.7:
            split = self.random.randrange(1, len(self._robots) - 1)
            self.net.cut(self._robots[:split], self._robots[split:])
        elif phase == _HEALED:
            self.net.heal()
        elif phase == _CRASH:
            self._memories["r_1"] = self._reloaded(self.net.crash("r_1"))
        elif phase == _RESTART:
            self.net.start(["r_1"])
        for node in self.net.nodes.values():
            if phase > 2 and node.route and self.random.random() < 0.3:
                self._finish_something(node)

    def _finish_something(self, node):
        for claim in node.route[:1]:
            if claim.begun or (claim.task not in node.once and node.begin(claim.task)):
                node.finish(claim.task)

    def _look(self, phase):
        """Say much to a copy of a robot, and a little to the robots themselves."""
        robot = self.random.choice([robot for robot in self.net.nodes if robot != LIAR])
        if self._bundles:  # a copy would lack what the robot has computed from bids that it does not keep
            self._say_to(self.net.nodes[robot], None)
        else:
            copy = self._copies[robot].copied(self.net.nodes[robot].negotiator)
            self._say_to(SealedRobot(copy(), self._codec), copy)
        for _ in range(_LIES if phase >= _LIES_FROM else 0):
            to = self.net.nodes[self.random.choice([robot for robot in self.net.nodes if robot != LIAR])]
            self.mouth.meet(to, self.net.now)
            self._feed(to, self.net.now, [self.mouth.word(max(1, to.members.incarnation(LIAR)))])

    def _say_to(self, robot, copy):
        """Say many words to a robot; where copies are made, a new one hears on when the liar is shut out by one."""
        self.mouth.meet(robot, self.net.now)
        epoch = robot.epoch.own.epoch
        now, left, before = self.net.now, self._words, robot.node.status().refused
        while left:
            if copy is not None and self.random.random() < 0.1:
                now += self.random.choice((0.05, 0.3, 5.0))
            count, known = min(left, self.random.randint(1, 10)), robot.members.incarnation(LIAR)
            words = [self.mouth.word(max(1, known)) for _ in range(count)]
            left -= len(words)
            if not self._feed(robot, now, words):
                return
            shut_out = LIAR in robot.convicted
            self.report.counts["copies that shut the liar out"] += copy is not None and shut_out
            is_elsewhere = robot.epoch.own.epoch != epoch  # where most of what the team says is of the past
            if copy is not None and self.random.random() < (1.0 if shut_out else 0.08 if is_elsewhere else 0.01):
                robot.node.negotiator = copy()
        self._reloaded(robot)
        refused = robot.node.status().refused - before
        self.report.counts.update({f"of these {why}": count for why, count in refused.items()})

    def _feed(self, robot, now, words):
        """Let a robot hear words; whether nothing was raised."""
        self.report.counts["mutated messages"] += len(words)
        try:
            robot.step(now, *words)
        except Exception as error:
            self.report.failures.append(f"{robot.robot} raises {type(error).__name__}: {error}")
            self.report.story.append(traceback.format_exc())
            return False
        if robot.superseded:
            self.report.failures.append(f"{robot.robot} was silenced")
            return False
        return True

    def _reloaded(self, robot):
        """What a robot remembers, written and read again; that has to be the same, and all of it admitted."""
        kept = Kept(auction="ab", robot=robot.robot, incarnation=robot.incarnation, memory=robot.memory)
        kept.save(self._file)
        found = kept_in(self._file, "ab", robot.robot)
        self.report.check(found == kept, f"{robot.robot} remembers something else")
        _, refused = healed(found.memory, robot.rules, self._keys[robot.robot])
        self.report.check(not refused, f"{robot.robot} has kept what is refused: {refused}")
        with suppress(ValueError):
            "".join(notice.reason for notice in robot.notices).encode()
            return found.memory
        self.report.failures.append(f"{robot.robot} tells what cannot be written")
        return found.memory


def mutated_trial(seed):
    """The report of one run."""
    return Trial(seed).run()
