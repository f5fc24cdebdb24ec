"""The world of the model: robots, what is on its way between them, what may still go wrong, and each possible step."""

from dataclasses import dataclass
from typing import NamedTuple

from tests.muster_team.model.replicas import OFF, BrokenPromiseError, Replicas


@dataclass(frozen=True, kw_only=True)
class Bounds:
    """How much of what may happen is tried, in any order and at any moment.

    Parameters
    ----------
    epochs
        the highest epoch of which every step is tried; where a robot goes into a higher one the run is only healed.
    crashes, restarts
        of all robots; a robot that starts again remembers, and where `forgets` also does not.
    any_order
        whether messages of different links overtake each other in every way; else all arrive in the order in which
        they were sent, except for delays.
    losses, repeats, delays
        messages that are lost, arrive again at any later moment, or arrive at any later moment only.
    orders
        how many operators give their order.
    quanta
        the time, in periods of heartbeats.
    work
        whether robots begin tasks that are at-most-once, at any moment.
    """

    epochs: int = 3
    crashes: int = 0
    restarts: int = 0
    forgets: bool = False
    any_order: bool = False
    losses: int = 0
    repeats: int = 0
    delays: int = 0
    orders: int = 0
    quanta: int = 1
    work: bool = False


class World(NamedTuple):
    """A moment of a run.

    `states`: the number of each robot's state, or OFF. `lives`: how often each has started. `memories`: what a robot
    that does not run has kept. `way`: (link, message) of what is on its way, in the order of arrival. `late`: (link,
    message) that arrive at any moment. `lost`: a bit for each pair of robots that have lost each other. `begun`: (task,
    robot) that were begun for good. Then how much may still go wrong, and a bit for each order that was given.
    """

    now: int
    states: tuple
    lives: tuple
    memories: tuple
    way: tuple
    late: tuple
    lost: int
    begun: tuple
    crashes: int
    restarts: int
    losses: int
    repeats: int
    delays: int
    ordered: int


ROBOTS = 3
LINKS = tuple((a, b) for a in range(ROBOTS) for b in range(ROBOTS) if a != b)
LINK = {link: k for k, link in enumerate(LINKS)}
PAIR = {(a, b): 1 << (a + b - 1) for a, b in LINKS}


class Model:
    """All that may happen next in each world."""

    def __init__(self, replicas: Replicas, bounds: Bounds, once: frozenset):
        self.replicas, self.bounds, self.once = replicas, bounds, once

    def first(self):
        """The world in which all robots have just started."""
        b = self.bounds
        done = [self.replicas.start(robot, 0, 1, None, False) for robot in range(ROBOTS)]
        world = World(
            now=0,
            states=tuple(state for state, _ in done),
            lives=(1,) * ROBOTS,
            memories=(None,) * ROBOTS,
            way=(),
            late=(),
            lost=sum(set(PAIR.values())),
            begun=(),
            crashes=b.crashes,
            restarts=b.restarts,
            losses=b.losses,
            repeats=b.repeats,
            delays=b.delays,
            ordered=0,
        )
        for robot in range(ROBOTS):
            world = self._after(world, robot, done[robot])
        return world

    def steps(self, world):
        """Each step that is possible: what it is, the robot at which it happens, and the world after it."""
        for robot in range(ROBOTS):
            yield from self.steps_at(world, robot)

    def steps_at(self, world, robot):
        """The steps that happen at one robot, what happens to messages for it among them."""
        if world.states[robot] == OFF:
            if world.restarts and self.is_quiet(world):
                spent = world._replace(restarts=world.restarts - 1)
                yield ("restart", robot), self._started(spent, robot, world.memories[robot], forgot=False)
                if self.bounds.forgets:
                    yield ("restart without memory", robot), self._started(spent, robot, None, forgot=True)
            return
        for item in self.next_for(world, robot):
            yield from self._of_a_message(world, item)
        for k, (link, message) in enumerate(world.late):
            if LINKS[link][1] == robot and world.late.index((link, message)) == k:
                rest = world._replace(late=_without(world.late, k))
                yield ("late", LINKS[link], message), self._handled(rest, robot, message)
        if self.has_to_tick(world, robot):
            yield ("tick", robot), self._ticked(world, robot)
        for k, (receiver, _) in enumerate(self.replicas.orders[: self.bounds.orders]):
            if receiver == robot and not world.ordered & 1 << k:
                done = self.replicas.order(robot, world.states[robot], world.now, k)
                yield ("order", k), self._after(world._replace(ordered=world.ordered | 1 << k), robot, done)
        if self.bounds.work:
            yield from self._work(world, robot)
        if world.crashes:
            yield ("crash", robot), self._crashed(world, robot)

    def time(self, world):
        """The world a quantum later, if nothing is on its way and nobody has to do anything before; else None."""
        if world.now < self.bounds.quanta and self.is_quiet(world):
            return world._replace(now=world.now + 1)
        return None

    def is_quiet(self, world):
        """Whether nothing is on its way, except what is late, and nobody sends anything before time goes on."""
        return not world.way and all(
            state == OFF or self._ticked(world, robot) is world for robot, state in enumerate(world.states)
        )

    def is_beyond(self, world):
        """Whether a robot is in an epoch above those of which every step is tried."""
        looks = self.replicas.looks
        return any(state != OFF and looks[state].epoch > self.bounds.epochs for state in world.states)

    def has_to_tick(self, world, robot):
        """Whether something is due at a robot, all that was sent to it in time has arrived, and it is its turn."""
        if self.bounds.any_order:
            is_its_turn = all(LINKS[link][1] != robot for link, _ in world.way)
        else:
            is_its_turn = not world.way and not any(self.has_to_tick(world, other) for other in range(robot))
        return is_its_turn and world.states[robot] != OFF and self._ticked(world, robot) is not world

    def next_for(self, world, robot):
        """What may arrive next at a robot of what is on its way, as (link, message)."""
        if not self.bounds.any_order:
            return [item for item in world.way[:1] if LINKS[item[0]][1] == robot]
        first = {link: message for link, message in reversed(world.way) if LINKS[link][1] == robot}
        return sorted(first.items())

    def _of_a_message(self, world, item):
        """What may happen to a message that would arrive next."""
        (source, robot), message = LINKS[item[0]], item[1]
        rest = world._replace(way=_without(world.way, world.way.index(item)))
        after = self._handled(rest, robot, message)
        yield ("deliver", (source, robot), message), after
        if world.losses:
            yield ("lose", (source, robot), message), rest._replace(losses=world.losses - 1)
        if world.repeats:
            late = tuple(sorted((*after.late, item)))
            yield ("repeat", (source, robot), message), after._replace(late=late, repeats=world.repeats - 1)
        if world.delays:
            late = tuple(sorted((*rest.late, item)))
            yield ("delay", (source, robot), message), rest._replace(late=late, delays=world.delays - 1)

    def _handled(self, world, robot, message):
        return self._after(world, robot, self.replicas.handle(robot, world.states[robot], world.now, message))

    def _ticked(self, world, robot):
        """The world after a robot was told that time goes by; the same world where that changes nothing."""
        state, sent = self.replicas.tick(robot, world.states[robot], world.now)
        if state == world.states[robot] and not sent:
            return world
        return self._after(world, robot, (state, sent))

    def _work(self, world, robot):
        look = self.replicas.looks[world.states[robot]]
        for task, begun in look.route:
            if begun or task not in self.once:
                continue
            state, sent = self.replicas.begin(robot, world.states[robot], world.now, task)
            if state == world.states[robot]:
                continue
            after = self._after(world, robot, (state, sent))
            if (task, True) in self.replicas.looks[state].route:
                before = [other for name, other in world.begun if name == task]
                if before:
                    raise BrokenPromiseError(f"{robot} begins {task}, which is at-most-once, and was begun by {before}")
                after = after._replace(begun=tuple(sorted((*world.begun, (task, robot)))))
            yield ("begin", robot, task), after

    def _crashed(self, world, robot):
        """A robot ends, and what is on its way to it is lost."""
        return world._replace(
            crashes=world.crashes - 1,
            lost=world.lost | _pairs_of(robot),
            states=_with(world.states, robot, OFF),
            memories=_with(world.memories, robot, self.replicas.looks[world.states[robot]].memory),
            way=tuple(item for item in world.way if LINKS[item[0]][1] != robot),
            late=tuple(item for item in world.late if LINKS[item[0]][1] != robot),
        )

    def _started(self, world, robot, memory, *, forgot):
        life = world.lives[robot] + 1
        done = self.replicas.start(robot, world.now, life, memory, forgot)
        world = world._replace(
            lives=_with(world.lives, robot, life),
            memories=_with(world.memories, robot, None),
            lost=world.lost | _pairs_of(robot),
        )
        return self._after(world, robot, done)

    def _after(self, world, robot, done):
        """The world after a robot came to a state and sent something."""
        state, sent = done
        before = world.states[robot]
        states = _with(world.states, robot, state)
        way = list(world.way)
        for to, message in sent:
            there = [other for other in (range(ROBOTS) if to is None else (to,)) if states[other] != OFF]
            way += [(LINK[robot, other], message) for other in there if other != robot]
        if self.bounds.any_order:
            way.sort(key=lambda item: item[0])  # the order of a link alone counts
        lost = self._lost(world.lost, robot, before, states)
        return world._replace(states=states, way=tuple(way), lost=lost)

    def _lost(self, lost, robot, before, states):
        """The pairs that have lost each other after a robot came to its state, as `trials.observer` defines it."""
        looks = self.replicas.looks
        look = looks[states[robot]]
        if before == OFF or looks[before].epoch != look.epoch:
            for other in range(ROBOTS):
                lost |= PAIR[robot, other] if other != robot and other not in look.members else 0
        if look.base and (before == OFF or looks[before].base != look.base):
            for other in look.members:
                if other != robot and states[other] != OFF:
                    theirs = looks[states[other]]
                    if robot in theirs.members and theirs.base == look.base:
                        lost &= ~PAIR[robot, other]
        return lost


def _pairs_of(robot):
    return sum(PAIR[robot, other] for other in range(ROBOTS) if other != robot)


def _with(values, k, value):
    return (*values[:k], value, *values[k + 1 :])


def _without(values, k):
    return (*values[:k], *values[k + 1 :])
