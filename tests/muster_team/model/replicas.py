"""What the shipped core does in each of its states: every input of every state is tried once, and then looked up."""

from contextlib import suppress
from dataclasses import dataclass
from functools import partial

from tests.muster_team.model.states import Store, state_of

from muster.mission.errors import MissionError, ParameterError

OFF = -1
"""The number that stands for a robot that does not run."""


class BrokenPromiseError(Exception):
    """A promise that is not kept."""


@dataclass(frozen=True, slots=True)
class Look:
    """What there is to see of a negotiator.

    `route`: (task, whether it was begun) of what the robot owns. `base`: the digest of the last base. `verdicts`: what
    became of the orders that are known, and `final` those of which the robot says that this holds for the whole team.
    `plan`: the tasks of each robot. `added`: what the orders that count have added. `memory`: the number of what the
    robot would remember.
    """

    epoch: int
    members: tuple
    base: bytes
    owned: frozenset
    route: tuple
    stage: object
    settled: bool
    known: int
    verdicts: tuple
    final: frozenset
    plan: tuple
    added: frozenset
    memory: int


class Replicas:
    """The negotiators of a team, by number of their state.

    Parameters
    ----------
    robots
        their ids.
    make
        (robot, **how) -> a negotiator.
    orders
        (robot, what the operator calls) of each order that operators may give.
    """

    def __init__(self, robots, make, orders=()):
        self.robots, self.orders = robots, orders
        self.looks, self.messages, self.memories = [], [], []
        self.calls = 0
        self._stores = [Store(partial(make, robot)) for robot in range(len(robots))]
        self._stored = []
        self._numbers, self._message_numbers, self._memory_numbers = {}, {}, {}
        self._done = {}

    def start(self, robot, now, incarnation, memory, forgot):
        """The number of the state of a robot that has started, and what it sends."""
        key = robot, now, incarnation, memory, forgot
        if key not in self._done:
            remembered = None if memory is None else self.memories[memory]
            node = self._stores[robot].fresh(incarnation=incarnation, remembered=remembered, forgot=forgot)
            out = self._tried(lambda: node.start(float(now)))
            self._done[key] = self._number(robot, node), self._sent(out or ())
        return self._done[key]

    def handle(self, robot, state, now, message):
        heard = self.messages[message]
        return self._step(robot, state, now, message, lambda node: node.handle(heard, float(now)))

    def tick(self, robot, state, now):
        return self._step(robot, state, now, "tick", lambda node: node.tick(float(now)))

    def order(self, robot, state, now, number):
        """The operator gives an order; where the robot refuses it at once nothing else happens."""

        return self._step(robot, state, now, ("order", number), lambda node: self.give(node, number))

    def give(self, node, number):
        """Let the operator give an order to a negotiator."""
        with suppress(MissionError, ParameterError):
            self.orders[number][1](node)

    def begin(self, robot, state, now, task):
        """The robot wants to begin a task."""
        return self._step(robot, state, now, ("begin", task), lambda node: node.begin(task) and ())

    def is_in(self, robot, state, node):
        """Whether a negotiator is in the state of this number."""
        return self._numbers.get((robot, state_of(node))) == state

    def _step(self, robot, state, now, what, call):
        key = robot, state, now, what
        if key not in self._done:
            node = self._stores[robot].loaded(self._stored[state])
            self.calls += 1
            out = self._tried(lambda: call(node))
            self._done[key] = self._number(robot, node), self._sent(out or ())
        return self._done[key]

    def _tried(self, call):
        try:
            return call()
        except Exception as error:
            raise BrokenPromiseError(f"the core raises {type(error).__name__}: {error}") from error

    def _number(self, robot, node):
        key = robot, state_of(node)
        if key not in self._numbers:
            self._numbers[key] = len(self.looks)
            self.looks.append(self._look(node))
            self._stored.append(self._stores[robot].stored(node))
        return self._numbers[key]

    def _look(self, node):
        orders, base, claims = node.orders, node.latest.base if node.latest else None, node.route
        verdicts = tuple(orders.verdicts.items())
        return Look(
            epoch=node.epoch.own.epoch,
            members=tuple(self.robots.index(robot) for robot in node.epoch.own.members),
            base=b"" if base is None else base.digest,
            owned=frozenset(claim.task for claim in claims),
            route=tuple((claim.task, claim.begun) for claim in claims),
            stage=node.stage,
            settled=node.settled,
            known=node.known,
            verdicts=verdicts,
            final=frozenset(fact for fact, _ in verdicts if node.is_final(fact)),
            plan=tuple(tuple(node.valuer.route(robot)) for robot in self.robots) if base is not None else (),
            added=frozenset() if base is None else frozenset(fact.content for fact in base.added),
            memory=_number_in(self.memories, self._memory_numbers, node.memory),
        )

    def _sent(self, out):
        """What was sent: (receiver or None, number of the message) of each."""
        return tuple(
            (
                None if sent.to is None else self.robots.index(sent.to),
                _number_in(self.messages, self._message_numbers, sent.message),
            )
            for sent in out
        )


def _number_in(values, numbers, value):
    if value not in numbers:
        numbers[value] = len(values)
        values.append(value)
    return numbers[value]
