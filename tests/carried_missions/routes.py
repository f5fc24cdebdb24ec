"""All orders in which a robot may do tasks, each with the best calls at stations, whatever their order and number.

Nothing is waited for but windows: neither other robots nor lags.
"""

import math
from dataclasses import dataclass, replace

from muster.mission.goods import by_commodity
from tests.carried_missions import frontiers
from tests.carried_missions.frontiers import TINY

MOST_CALLS = 6  # on the way to a stop: where robots unload between two swaps, three are needed


@dataclass(frozen=True)
class State:
    """A robot at a stop: what it used, with what it arrived at its tasks, how late these ended, what is on board."""

    usage: float
    points: list
    load: tuple
    pending: tuple
    arrivals: float = 0.0
    late: float = 0.0

    def covers(self, other):
        least = all(
            a <= b for a, b in ((self.usage, other.usage), (self.arrivals, other.arrivals), (self.late, other.late))
        )
        return (
            least
            and (self.load, self.pending) == (other.load, other.pending)
            and frontiers.covers(self.points, other.points)
        )


@dataclass(frozen=True)
class Figures:
    """The least values of a route, each by itself."""

    usage: float = 0.0
    arrivals: float = 0.0
    ends: float = 0.0
    late: float = 0.0


class RobotRoutes:
    """What one robot can do."""

    def __init__(self, mission, robot):
        self.mission, self.robot, self.rules = mission, robot, mission.rules
        self.tasks = {task.id: task for task in mission.tasks}
        open_to = (one for one in mission.stations if one.only_robots is None or robot.id in one.only_robots)
        self.stations = {station.id: station for station in open_to}
        goods = {name for task in mission.tasks for name in by_commodity(task.load)}
        self.goods = sorted(goods | set(by_commodity(robot.load_at_start)) if goods else ())
        battery = robot.battery
        self.full = math.inf if battery is None else battery.capacity - battery.least
        self.delivered = {task.delivers for task in mission.tasks if task.delivers is not None}
        self.end = robot.place_at_end(mission.rules)
        self.until = math.inf if robot.available_until_s is None else robot.available_until_s

    # --- orders ----------------------------------------------------------------------------------------------------

    def figures(self):
        """All orders that keep the robot's rules, by tasks, with their figures."""
        found = {(): Figures()}
        self._grow((), [self._start()], found)
        return found

    def _start(self):
        energy = (
            math.inf if self.robot.battery is None else self.robot.battery.level_at_start - self.robot.battery.least
        )
        points = [(self.robot.available_from_s, energy)]
        return State(0.0, points, self._amounts(self.robot.load_at_start), (0.0,) * len(self.goods))

    def _grow(self, order, states, found):
        for name, task in self.tasks.items():
            if name in order or not (task.delivers is None or task.delivers in order):
                continue
            place = self.tasks[order[-1]].position if order else self.robot.position
            states_there = self._undominated(
                done
                for state in states
                for there in self._ways(state, place, task.position)
                for done in self._do(there, task)
            )
            if not states_there:
                continue
            longer = (*order, name)
            figures = self._figures(longer, states_there)
            if figures is not None:
                found[longer] = figures
            self._grow(longer, states_there, found)

    def _figures(self, order, states):
        """The figures of a route that ends here; None where it may not."""
        if {name for name in order if name in self.delivered} != {self.tasks[name].delivers for name in order} - {None}:
            return None
        place = self.tasks[order[-1]].position
        homes = [home for state in states for home in self._home(state, place)]
        if not homes:
            return None
        counted = self.rules.makespan_includes_return
        return Figures(
            usage=min(home.usage for home in homes),
            arrivals=min(home.arrivals for home in homes),
            ends=min(home.points[0][0] for home in homes) if counted else self._last_end(states, place),
            late=min(home.late for home in homes),
        )

    def _home(self, state, place):
        if self.end is None:
            ends = [state] if state.points[0][0] <= self.until + TINY else []
        else:
            ends = [there for there in self._ways(state, place, self.end) if there.points[0][0] <= self.until + TINY]
        return [home for home in ends if self._fits(home)]

    def _last_end(self, states, place):
        """The earliest end of the last task with which the robot comes home."""
        if self.end is None:
            return min(state.points[0][0] for state in states if self._home(state, place))
        found = []
        for state in states:
            for to in (self.end, *(station.position for station in self.stations.values())):
                usage = self._way(place, to)[0]
                time = frontiers.time_of(state.points, usage) if self.full < math.inf else state.points[0][0]
                if time < math.inf:
                    one = replace(state, points=[(time, max(usage, frontiers.at(state.points, time)))])
                    if self._home(one, place):
                        found.append(time)
        return min(found)

    # --- ways and work ---------------------------------------------------------------------------------------------

    def _ways(self, state, place, to):
        """The states on arrival, directly and after calls: as many as lead to a state that none before it covers."""
        yield from self._go(state, place, to)
        reached, wave = {name: [] for name in self.stations}, [(place, state)]
        for _ in range(MOST_CALLS):
            wave = [
                (station.position, called)
                for last, one in wave
                for name, station in self.stations.items()
                for called in self._call(one, last, station)
                if self._is_new(called, reached[name])
            ]
            yield from (arrived for last, one in wave for arrived in self._go(one, last, to))

    @staticmethod
    def _is_new(state, known):
        """Whether no known state covers one, which is known then."""
        if any(other.covers(state) for other in known):
            return False
        known.append(state)
        return True

    def _way(self, place, to):
        """The usage and the time of a way."""
        metres = math.dist(place, to)
        seconds = metres / self.robot.speed_mps
        return (seconds if self.rules.usage == "time" else metres), seconds

    def _go(self, state, place, to):
        usage, seconds = self._way(place, to)
        points = frontiers.shifted(state.points, seconds, usage if self.full < math.inf else 0.0)
        return [replace(state, usage=state.usage + usage, points=points)] if points else []

    def _call(self, state, place, station):
        for there in self._go(state, place, station.position):
            points, load = there.points, there.load
            if self.full < math.inf and station.swaps:
                points = [(points[0][0] + station.swap_s, self.full)]
            elif self.full < math.inf and station.charges and station.partial:
                points = frontiers.charged(points, station.charge_per_s, self.full)
            elif self.full < math.inf and station.charges:
                points = frontiers.filled(points, station.charge_per_s, self.full)
            if station.unloads:
                load = there.pending
            if not self._carries(load):
                continue
            changes = load != there.load or (self.full < math.inf and station.gives_energy)
            if changes:
                yield replace(there, points=points, load=load)

    def _do(self, state, task):
        takes, draws = self._work(task)
        load, pending = self._loaded(state, task)
        if not self._carries(load):
            return
        latest = math.inf if task.deadline_s is None else task.deadline_s - takes
        points = frontiers.begun(state.points, task.window_s, latest)
        points = points and frontiers.shifted(points, takes, draws if self.full < math.inf else 0.0)
        if points:
            late = task.priority * max(0.0, points[0][0] - task.due_s) if task.due_s is not None else 0.0
            done = State(state.usage + draws, points, load, pending, state.arrivals + state.usage, state.late + late)
            if self._fits(done):
                yield done

    def _work(self, task):
        """How long a task takes the robot, and what it uses."""
        if task.duration_s is not None:
            takes = task.duration_s / self.robot.efficiency
        else:
            takes = task.actuation_cost / self.robot.speed_mps
        return takes, takes if self.rules.usage == "time" else task.actuation_cost

    def _fits(self, state):
        most = self.robot.work_capacity
        return most is None or state.usage <= (1 - self.rules.capacity_reserve) * most + TINY

    # --- goods -----------------------------------------------------------------------------------------------------

    def _amounts(self, amount):
        named = by_commodity(amount)
        return tuple(named.get(name, 0.0) for name in self.goods)

    def _loaded(self, state, task):
        own = self._amounts(task.load)
        down = self._amounts(self.tasks[task.delivers].load) if task.delivers is not None else self._amounts(None)
        kept = own if task.id in self.delivered else self._amounts(None)
        load = tuple(a + b - c for a, b, c in zip(state.load, own, down, strict=True))
        return load, tuple(a + b - c for a, b, c in zip(state.pending, kept, down, strict=True))

    def _carries(self, load):
        most = self.robot.load_capacity
        named = by_commodity(most)
        room = (math.inf if most is None else named.get(name, 0.0) for name in self.goods)
        return all(-TINY <= one <= limit + TINY for one, limit in zip(load, room, strict=True))

    def _undominated(self, states):
        kept = []
        for state in states:
            if not any(other.covers(state) for other in kept):
                kept = [other for other in kept if not state.covers(other)] + [state]
        return kept
