"""The exploration: every world that can be reached within bounds, each once, and what is wrong in any of them."""

from dataclasses import dataclass, field

from tests.muster_team.model.checks import agree, clash, wrong_when_quiet
from tests.muster_team.model.replicas import OFF, BrokenPromiseError
from tests.muster_team.model.world import LINKS, Model

HEALS_WITHIN = 60
"""Quanta within which robots agree once nothing is lost any more; see "How soon all agree" in docs/negotiation.md."""


@dataclass
class Found:
    """What an exploration has come across.

    `quiet` worlds are those in which nothing is on its way and nothing due, `beyond` those in an epoch above the last
    one. `states` of robots were seen, and `calls` into the core made. `slowest`: the most quanta that robots took to
    agree once nothing went wrong any more. `left`: worlds that were reached and not looked at when it was cut. `fault`:
    the first promise that was not kept, and `trace` the steps that lead to it.
    """

    worlds: int = 0
    steps: int = 0
    quiet: int = 0
    healed: int = 0
    beyond: int = 0
    calls: int = 0
    states: int = 0
    left: int = 0
    slowest: int = 0
    fault: str = ""
    trace: list = field(default_factory=list)


class Explorer:
    """A depth-first search through the worlds of a model.

    Parameters
    ----------
    tasks
        those that somebody has to own where the robots agree.
    reduced
        whether of steps that commute one order is tried, where that cannot hide anything (`_enough`).
    most
        the number of worlds after which the exploration is cut.
    watch
        called with each world.
    """

    def __init__(self, model: Model, tasks, *, reduced=True, most=None, watch=lambda world: None):
        self.model, self.tasks, self.reduced, self.most, self.watch = model, tasks, reduced, most, watch
        self.looks = model.replicas.looks
        self.found = Found()
        self._healed = {}

    def explore(self):
        """What was found."""
        found, path = self.found, ()
        try:
            world = self.model.first()
            seen, ahead = {hash(world)}, [(world, ())]
            while ahead:
                if self.most is not None and found.worlds >= self.most:
                    found.left = len(ahead)
                    break
                world, path = ahead.pop()
                found.worlds += 1
                self.watch(world)
                self._look_at(world)
                for step, after in self._steps_from(world):
                    found.steps += 1
                    path_after = (path, step)
                    if (key := hash(after)) not in seen:
                        seen.add(key)
                        ahead.append((after, path_after))
        except BrokenPromiseError as fault:
            found.fault, found.trace = str(fault), _trace(path)
        found.calls, found.states = self.model.replicas.calls, len(self.looks)
        return found

    def _look_at(self, world):
        wrong = clash(self.looks, world)
        if wrong:
            raise BrokenPromiseError(wrong)
        if self.model.is_beyond(world):
            self.found.beyond += 1
            self._heal(world)
        elif self.model.is_quiet(world):
            self.found.quiet += 1
            if world.now == self.model.bounds.quanta:
                self._heal(world)  # before that, the run in which nothing else goes wrong is one of those that follow
            elif agree(self.looks, world):
                self._check(world)

    def _steps_from(self, world):
        if self.model.is_beyond(world):
            return
        for robot in range(len(world.states)) if self.reduced else ():
            steps = self._enough(world, robot)
            if steps:
                yield from steps
                return
        yield from self.model.steps(world)
        later = self.model.time(world)
        if later is not None:
            yield ("time",), later

    def _enough(self, world, robot):
        """The steps at one robot, and where something is late, if they are enough in this world; else nothing.

        They are a strong stubborn set (Valmari 1991). What happens elsewhere commutes with them: it changes nothing at
        these robots, and cannot give them anything to receive before they have taken what waits. A run to a quiet
        world takes what waits at some time. A run to a clash stays one where a step is put before it after which the
        robot is in the same epoch and owns no less, and one of the steps is such.
        """
        model, state = self.model, world.states[robot]
        if state == OFF:
            return []
        if model.bounds.any_order:
            if not self._hears_all_in_turn(world, robot):
                return []
            at = {robot}
        else:
            ticks = model.has_to_tick(world, robot)
            if not (model.next_for(world, robot) or ticks):
                return []
            before_it = range(robot) if ticks else ()  # who has something to say after an order says it first
            at = {robot, *before_it, *(LINKS[link][1] for link, _ in world.late)}
        steps = [step for one in sorted(at) for step in model.steps_at(world, one)]
        before = self.looks[state]
        for what, after in steps:
            if (what[0] == "tick" and what[1] == robot) or (what[0] == "deliver" and what[1][1] == robot):
                look = self.looks[after.states[robot]]
                if look.epoch == before.epoch and look.owned >= before.owned:
                    return steps
        return []

    def _hears_all_in_turn(self, world, robot):
        """Whether something is on its way to the robot from each other that may send something before it has acted."""
        others = [one for one, state in enumerate(world.states) if one != robot and state != OFF]
        sources = {LINKS[link][0] for link, _ in world.way if LINKS[link][1] == robot}
        acting = [one for one in others if self._may_act(world, one)]
        return bool(sources) and (not acting or sources.issuperset(others))

    def _may_act(self, world, robot):
        if any(LINKS[link][1] == robot for link, _ in (*world.way, *world.late)):
            return True
        return any(what[0] != "crash" for what, _ in self.model.steps_at(world, robot))

    def _heal(self, world):
        """Let the network be perfect from now on: the robots have to agree, and what they agree on has to be right."""
        world = world._replace(crashes=0, restarts=0, losses=0, repeats=0, delays=0, late=())
        way, limit = [], world.now + HEALS_WITHIN
        while world not in self._healed:
            way.append(world)
            if self.model.is_quiet(world) and agree(self.looks, world):
                self._check(world)
                break
            if world.now > limit:
                raise BrokenPromiseError(f"the robots do not agree within {HEALS_WITHIN} quanta")
            world = self._next(world)
        for step in way:
            self._healed[step] = True
        self.found.healed += 1
        self.found.slowest = max(self.found.slowest, HEALS_WITHIN - limit + way[-1].now if way else 0)

    def _next(self, world):
        """The next world of a perfect network: messages arrive in turn, then robots send, then time goes on."""
        for robot in range(len(world.states)):
            for step, after in self.model.steps_at(world, robot):
                if step[0] in ("deliver", "tick"):
                    return after
        return world._replace(now=world.now + 1)

    def _check(self, world):
        for wrong in wrong_when_quiet(self.looks, world, self.tasks):
            raise BrokenPromiseError(wrong)


def _trace(path):
    steps = []
    while path:
        path, step = path
        steps.append(step)
    return steps[::-1]
