"""Negotiators whose messages arrive in any order, any number of times or never, while robots die, start and work."""

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from tests.muster_team.networks import line_mission
from tests.muster_team.trials.observer import Observer

from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.auctions.valuation import AuctionValuer
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.participation import rules_of

ROBOTS = ("r_0", "r_1", "r_2")
PROBLEM = Problem.compile(line_mission(robots=3, tasks=4, once=("0",))).ready()
RULES = rules_of(PROBLEM)


class AnyDelivery(RuleBasedStateMachine):
    def __init__(self):
        super().__init__()
        self.now, self.lives = 0.0, dict.fromkeys(ROBOTS, 0)
        self.nodes, self.memories, self.messages = {}, {}, []
        self.observer = Observer(self.nodes, {"0"})
        for robot in ROBOTS:
            self.begin_life(robot, None)

    def begin_life(self, robot, memory):
        self.lives[robot] += 1
        self.observer.started(robot)
        life = self.lives[robot]
        valuer, forgot = AuctionValuer(PROBLEM, Parameters(), robot), memory is None and life > 1
        node = Negotiator(robot, RULES, valuer, incarnation=life, remembered=memory, forgot=forgot)
        self.nodes[robot] = node
        self.sent(robot, node.start(self.now))

    def sent(self, robot, out):
        self.messages += [
            (o.to or other, o.message) for o in out for other in ROBOTS if other == (o.to or other) != robot
        ]
        self.observer.look(robot)

    @precondition(lambda self: self.messages)
    @rule(data=st.data(), stays=st.booleans())
    def deliver(self, data, stays):
        k = data.draw(st.integers(0, len(self.messages) - 1))
        to, message = self.messages[k] if stays else self.messages.pop(k)
        if to in self.nodes:
            self.sent(to, self.nodes[to].handle(message, self.now))

    @rule(group=st.sets(st.sampled_from(ROBOTS), min_size=1), for_s=st.sampled_from((0.3, 1.0, 5.0, 9.0)))
    def speak_among_themselves(self, group, for_s):
        """All that some say reaches all of them at once; what they say to others stays on its way."""
        end, said = self.now + for_s, len(self.messages)
        while self.now < end:
            self.now += 0.2
            for robot in sorted(group & self.nodes.keys()):
                self.sent(robot, self.nodes[robot].tick(self.now))
            while any(to in group for to, _ in self.messages[said:]):
                latest = self.messages[said:]
                self.messages[said:] = [(to, message) for to, message in latest if to not in group]
                for to, message in latest:
                    if to in group and message.sender in group and to in self.nodes:
                        self.sent(to, self.nodes[to].handle(message, self.now))
        del self.messages[said + 20 :]  # as much as may still be late

    @rule(after_s=st.sampled_from((0.05, 0.2, 1.0, 4.5)))
    def time_goes_by(self, after_s):
        self.now += after_s
        for robot, node in self.nodes.items():
            self.sent(robot, node.tick(self.now))

    @precondition(lambda self: len(self.nodes) > 1)
    @rule(data=st.data())
    def crash(self, data):
        robot = data.draw(st.sampled_from(sorted(self.nodes)))
        self.memories[robot] = self.nodes.pop(robot).memory
        self.observer.gone(robot)

    @precondition(lambda self: len(self.nodes) < len(ROBOTS))
    @rule(data=st.data(), remembers=st.booleans())
    def restart(self, data, remembers):
        robot = data.draw(st.sampled_from([robot for robot in ROBOTS if robot not in self.nodes]))
        self.begin_life(robot, self.memories[robot] if remembers else None)

    @rule(robot=st.sampled_from(ROBOTS), finishes=st.booleans())
    def work(self, robot, finishes):
        node = self.nodes.get(robot)
        for claim in node.route if node else ():
            if node.begin(claim.task):
                self.observer.begins(robot, claim.task, again=claim.begun)
                if finishes:
                    node.finish(claim.task)
                self.observer.look(robot)
                return

    @invariant()
    def promises_hold(self):
        assert self.observer.broken == []


AnyDelivery.TestCase.settings = settings(max_examples=60, stateful_step_count=40, deadline=None)
TestAnyDelivery = AnyDelivery.TestCase
