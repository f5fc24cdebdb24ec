"""A simulated network on a virtual clock: loss, delay, reordering, duplication, partitions and crashes, by seed."""

from __future__ import annotations

import heapq
import itertools
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, field
from random import Random

from muster_team.knowledge.effects import Outgoing
from muster_team.knowledge.messages import Message
from muster_team.negotiators.negotiator import Negotiator

TICK_S = 0.05
"""The time between two calls of a robot's `tick`, seconds."""


@dataclass(frozen=True, kw_only=True)
class LinkConditions:
    """What the network does to each copy of a message.

    Parameters
    ----------
    loss, duplication
        probabilities.
    delay_s, jitter_s
        the least delay, and the largest that is added to it, uniformly; so messages overtake each other.
    """

    loss: float = 0.0
    delay_s: float = 0.001
    jitter_s: float = 0.0
    duplication: float = 0.0


@dataclass
class MemoryNetwork:
    """Robots that send each other messages.

    Parameters
    ----------
    make
        makes a robot's negotiator from its id and incarnation; called again when it restarts.
    robots
        the team.
    links
        (speaker, listener) -> whether a message gets through directly; None: always.
    watch
        called with a robot after each moment in which it did something.
    sent
        called with each message that is sent.
    """

    make: Callable[[str, int], Negotiator]
    robots: Sequence[str]
    seed: int = 0
    conditions: LinkConditions = field(default_factory=LinkConditions)
    links: Callable[[str, str], bool] | None = None
    watch: Callable[[str], None] = lambda robot: None
    sent: Callable[[Message], None] = lambda message: None

    def __post_init__(self) -> None:
        self.now = 0.0
        self.nodes: dict[str, Negotiator] = {}
        self.counts: Counter[str] = Counter()
        self._random = Random(self.seed)
        self._side: dict[str, int] = {}
        self._dead_links: Collection[tuple[str, str]] = ()
        self._order = itertools.count()
        self._next_wake: dict[str, float] = {}
        self._queue: list[tuple[float, int, list[str], Message | None]] = []  # arrivals and receivers; None: a tick
        self.incarnations: Counter[str] = Counter()  # the highest of each robot
        self._later: list[tuple[float, int, Callable[[], None]]] = []

    def start(self, robots: Iterable[str] | None = None, incarnation: int | None = None) -> None:
        """Start robots, by default all, with an incarnation one above the last, or with the given one."""
        for robot in self.robots if robots is None else robots:
            number = self.incarnations[robot] + 1 if incarnation is None else incarnation
            self.incarnations[robot] = max(number, self.incarnations[robot])
            node = self.nodes[robot] = self.make(robot, number)
            self._send(robot, node.start(self.now))
            self._wake(robot)
            self.watch(robot)

    def crash(self, robot: str) -> Negotiator:
        """End a robot at once; return its negotiator."""
        node = self.nodes.pop(robot)
        self.incarnations[robot] = max(node.incarnation, self.incarnations[robot])
        return node

    def cut(self, *groups: Collection[str]) -> None:
        """Let only robots of one group hear each other."""
        self._side = {robot: k for k, group in enumerate(groups) for robot in group}

    def block(self, links: Collection[tuple[str, str]]) -> None:
        """Let nothing get through from the first to the second robot of these pairs."""
        self._dead_links = links

    def heal(self) -> None:
        self._side, self._dead_links = {}, ()

    def at(self, when_s: float, what: Callable[[], None]) -> None:
        """Call a function at a time."""
        heapq.heappush(self._later, (when_s, next(self._order), what))

    def run(self, until_s: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass until then at most; return whether `until` came true."""
        while not until():
            upcoming = min(self._later[0][0] if self._later else until_s, self._queue[0][0] if self._queue else until_s)
            if upcoming >= until_s:
                self.now = until_s
                return False
            self.now = upcoming
            if self._later and self._later[0][0] <= upcoming:
                heapq.heappop(self._later)[2]()
            else:
                _, _, robots, message = heapq.heappop(self._queue)
                for robot in robots:
                    self._deliver(robot, message)
        return True

    def _deliver(self, robot: str, message: Message | None) -> None:
        node = self.nodes.get(robot)
        if node is None:
            return
        if message is not None:
            self.counts["delivered"] += 1
            out = node.handle(message, self.now)
        elif self._next_wake.get(robot) == self.now:
            out = node.tick(self.now)
            self._wake(robot)
        else:
            return
        if out:
            self._send(robot, out)
        self.watch(robot)

    def _wake(self, robot: str) -> None:
        self._next_wake[robot] = self.now + TICK_S
        heapq.heappush(self._queue, (self.now + TICK_S, next(self._order), [robot], None))

    def _send(self, robot: str, out: list[Outgoing]) -> None:
        for outgoing in out:
            self.counts["sent"] += 1
            self.sent(outgoing.message)
            to = self.robots if outgoing.to is None else (outgoing.to,)
            self._post([other for other in to if other != robot and self._joined(robot, other)], outgoing.message)

    def _joined(self, one: str, other: str) -> bool:
        if self._side and self._side.get(one, -1) != self._side.get(other, -2):
            return False
        return (one, other) not in self._dead_links and (self.links is None or self.links(one, other))

    def _post(self, to: Sequence[str], message: Message) -> None:
        """Send copies; those that arrive at the same time are one entry of the queue."""
        conditions, draw = self.conditions, self._random.random
        arriving: dict[float, list[str]] = {}
        lost = 0
        for robot in to:
            for _ in range(1 + (conditions.duplication > 0 and draw() < conditions.duplication)):
                if conditions.loss > 0 and draw() < conditions.loss:
                    lost += 1
                    continue
                late_s = conditions.delay_s + (
                    self._random.uniform(0, conditions.jitter_s) if conditions.jitter_s else 0.0
                )
                arriving.setdefault(late_s, []).append(robot)
        for late_s, robots in arriving.items():
            heapq.heappush(self._queue, (self.now + late_s, next(self._order), robots, message))
        self.counts["copies"] += len(to)
        self.counts["lost"] += lost
