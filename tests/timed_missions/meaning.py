"""What routes mean by docs/design.md: their earliest schedule, their figures, and whether they are admissible.

This is a third reading of the rules beside planner and judge, with which it shares no code. Robots and tasks are
numbers, in mission order. All methods are the simplest that are right; nothing here is meant for more than some tasks.
"""

import math
from itertools import pairwise

from tests.timed_missions.travel import OwnTravel

ROUNDING = 1e-9
PLURALS = {"prerequisites": "prerequisite", "skills": "skill"}


class Meaning:
    """A mission read by the rules that hold."""

    def __init__(self, mission, objective=None, ignored=()):
        self.mission, self.ignored = mission, {PLURALS.get(word, word) for word in ignored}
        self.objective = objective or mission.rules.objective
        self.robots, self.tasks = mission.robots, mission.tasks
        self.number = {task.id: j for j, task in enumerate(mission.tasks)}
        self._travel = OwnTravel(mission)
        self.units = self._units()
        self.unit_of = {j: u for u, unit in enumerate(self.units) for j in unit}
        self.before = [self._numbers(task.prerequisites, "prerequisite") for task in self.tasks]
        self.same = [self._numbers(task.same_robot_as, "relation") for task in self.tasks]
        self.other = [self._numbers(task.other_robot_than, "relation") for task in self.tasks]
        self.sets = self._joined("either_or", "either-or")
        self.delivers = {j: self.number[task.delivers] for j, task in enumerate(self.tasks) if self._delivers(task)}
        self.allowed = [[self._may(robot, task) for task in self.tasks] for robot in self.robots]
        self._durations, self._teams = {}, {}

    def _holds(self, word):
        return word not in self.ignored

    def _numbers(self, names, word):
        return [self.number[name] for name in names] if self._holds(word) else []

    def _units(self):
        """The tasks in sets that begin together."""
        return self._joined("starts_with", "relation")

    def _joined(self, key, word):
        """The tasks in sets of those that are tied by a key."""
        unit = {j: {j} for j in range(len(self.tasks))}
        for j, task in enumerate(self.tasks):
            for k in self._numbers(getattr(task, key), word):
                joined = unit[j] | unit[k]
                unit |= dict.fromkeys(joined, joined)
        return [tuple(sorted(one)) for one in {frozenset(one) for one in unit.values()}]

    def _delivers(self, task):
        return task.delivers is not None and self._holds("load")

    # Who may do what.

    def _may(self, robot, task):
        table, rules = self.mission.suitability, self.mission.rules
        score = 1.0 if table is None else table[robot.type].get(task.type, 0.0)
        return (
            (score >= rules.min_suitability or not self._holds("suitability"))
            and (set(task.requires) <= set(robot.skills) or not self._holds("skill"))
            and (task.only_robots is None or robot.id in task.only_robots or not self._holds("lock"))
        )

    def is_team(self, j, members):
        """Whether these robots, different ones, are a team for the task."""
        key = j, frozenset(members)
        if key not in self._teams:
            self._teams[key] = self._is_team(self.tasks[j], [self.robots[i] for i in members])
        return self._teams[key] and all(self.allowed[i][j] for i in members)

    def _is_team(self, task, members):
        if not self._holds("team"):
            return len(members) == 1
        if task.needs:
            sums = {name: sum((robot.abilities or {}).get(name, 0.0) for robot in members) for name in task.needs}
            return bool(members) and all(sums[name] >= least - ROUNDING for name, least in task.needs.items())
        if task.team:
            places = [part for part in task.team for _ in range(part.count)]
            return len(members) == len(places) and self._seated(members, places)
        return len(members) == (task.robots_needed or 1)

    def _seated(self, members, places):
        """Whether each member can have a place of its own."""
        if not members:
            return True
        first, *others = members
        return any(
            self._fits(first, place) and self._seated(others, places[:k] + places[k + 1 :])
            for k, place in enumerate(places)
        )

    def _fits(self, robot, part):
        return (
            (part.type is None or robot.type == part.type)
            and (part.kind is None or robot.kind == part.kind)
            and (set(part.requires) <= set(robot.skills) or not self._holds("skill"))
        )

    # Time.

    def work_s(self, i, j):
        robot, task = self.robots[i], self.tasks[j]
        return task.actuation_cost / robot.speed_mps if task.duration_s is None else task.duration_s / robot.efficiency

    def duration_s(self, j, members):
        return max(self.work_s(i, j) for i in members)

    def next_begin(self, unit, at, durations, teams):
        """When a unit can begin at the earliest, not before `at`; None: never."""
        while True:
            later = at
            for j in unit:
                later = self._next_begin(j, later, durations[j])
                for i in teams[j]:
                    later = None if later is None else self._next_in_shift(i, later, durations[j])
                if later is None:
                    return None
            if later <= at:
                return at
            at = later

    def _next_in_shift(self, i, at, seconds):
        """The first moment, not before `at`, from which a shift of the robot lasts so long; None: never."""
        shifts = self.robots[i].shifts_s
        if not shifts or not self._holds("shift"):
            return at
        for begin, end in shifts:
            if end is None or max(at, begin) + seconds <= end + ROUNDING:
                return max(at, begin)
        return None

    def _moved(self, i, at, seconds):
        """When the robot has gone a way for which it is free at a moment; None: never."""
        leaves = self._next_in_shift(i, at, seconds)
        return None if leaves is None else leaves + seconds

    def _next_begin(self, j, at, duration):
        task = self.tasks[j]
        if self._holds("deadline") and task.deadline_s is not None and at + duration > task.deadline_s + ROUNDING:
            return None
        if not task.window_s or not self._holds("window"):
            return at
        for begin, end in sorted(task.window_s, key=lambda window: window[0]):
            if end is None or at <= end + ROUNDING:
                return max(at, begin)
        return None

    def schedule(self, routes, *, way_home=True):
        """Begins and ends of the tasks done, each by number, in the earliest schedule; None: there is none."""
        teams = self.teams(routes)
        durations = {j: self.duration_s(j, members) for j, members in teams.items()}
        least, steps = self._steps(routes, durations)
        if any(a == b for a, b, _ in steps) or self._circular(steps):
            return None
        steps += self._at_most(teams, durations)
        units = {u: [j for j in self.units[u] if j in teams] for u in least}
        begins = {u: self.next_begin(units[u], at, durations, teams) for u, at in least.items()}
        leaves = [robot.available_from_s for robot in self.robots]
        jumps = sum(len(self.tasks[j].window_s) for j in teams)
        jumps += sum((len(route) + 1) * len(robot.shifts_s) for robot, route in zip(self.robots, routes, strict=True))
        for _ in range((len(begins) + len(routes) + 2) * (jumps + 1)):
            if None in begins.values():
                return None
            late = [(b, begins[a] + after) for a, b, after in steps]
            late += self._arrivals(routes, begins, durations, leaves)
            if any(earliest is None for _, earliest in late):
                return None
            late = [(b, earliest) for b, earliest in late if earliest > begins[b] + ROUNDING]
            at = {j: begins[self.unit_of[j]] for j in teams}
            ends = {j: at[j] + durations[j] for j in teams}
            if not late and not self._leave_later(routes, ends, leaves, way_home=way_home):
                return at, ends
            for b, earliest in late:
                if begins[b] is not None:
                    begins[b] = self.next_begin(units[b], max(begins[b], earliest), durations, teams)
        return None

    def _arrivals(self, routes, begins, durations, leaves):
        """When units can begin by each of their robots, which keep to their shifts and leave when they do."""
        for i, route in enumerate(routes):
            free, here = leaves[i], None
            for j in route:
                yield self.unit_of[j], self._moved(i, free, self._travel.seconds(i, here, self.tasks[j]))
                free, here = begins[self.unit_of[j]] + durations[j], self.tasks[j]

    def _leave_later(self, routes, ends, leaves, *, way_home):
        """Robots whose duty is too long leave later; whether any does."""
        found = False
        for i, (robot, route) in enumerate(zip(self.robots, routes, strict=True)):
            if route and robot.longest_duty_s is not None and self._holds("duty"):
                back = self.back(i, route, ends) if way_home else ends[route[-1]]
                way = self._travel.seconds(i, None, self.tasks[route[0]])
                leaves[i] = self._next_in_shift(i, leaves[i], way)
                if back is not None and back - robot.longest_duty_s > leaves[i] + ROUNDING:
                    leaves[i], found = back - robot.longest_duty_s, True
        return found

    def back(self, i, route, ends):
        """When a robot's route, which has tasks, ends; None: never."""
        if not self._travel.has_end(i):
            return ends[route[-1]]
        return self._moved(i, ends[route[-1]], self.way_home(i, route, "seconds"))

    @staticmethod
    def teams(routes):
        """The members of the team of each task done."""
        teams = {}
        for i, route in enumerate(routes):
            for j in route:
                teams.setdefault(j, []).append(i)
        return teams

    def _steps(self, routes, durations):
        """When units can begin by their robots alone; and by how much one must begin after another."""
        least, steps = {}, []
        for i, route in enumerate(routes):
            for a, b in pairwise(route):
                seconds = durations[a] + self._travel.seconds(i, self.tasks[a], self.tasks[b])
                steps.append((self.unit_of[a], self.unit_of[b], seconds))
            for number, j in enumerate(route):
                begin = 0.0
                if number == 0:
                    begin = self.robots[i].available_from_s + self._travel.seconds(i, None, self.tasks[j])
                least[self.unit_of[j]] = max(least.get(self.unit_of[j], 0.0), begin)
        for j in durations:
            for k in self.before[j]:
                if k in durations:
                    after = (
                        self.tasks[j].lags[self.tasks[k].id].after_s if self.tasks[k].id in self.tasks[j].lags else 0
                    )
                    steps.append((self.unit_of[k], self.unit_of[j], durations[k] + after))
        return least, steps

    def _at_most(self, teams, durations):
        """What begins must not be too early for: a task that may begin only so long after their end."""
        steps = []
        for j in teams:
            for k in self.before[j]:
                lag = self.tasks[j].lags.get(self.tasks[k].id)
                if lag is not None and lag.within_s is not None and k in teams:
                    steps.append((self.unit_of[j], self.unit_of[k], -lag.within_s - durations[k]))
            k, longest = self.delivers.get(j), self.tasks[j].longest_aboard_s
            if longest is not None and k in teams and self._holds("aboard"):
                steps.append((self.unit_of[j], self.unit_of[k], -longest - durations[k]))
        return steps

    @staticmethod
    def _circular(steps):
        """Whether units wait for each other in a circle."""
        left = {u for a, b, _ in steps for u in (a, b)}
        while left:
            free = {u for u in left if not any(a in left and b == u for a, b, _ in steps)}
            if not free:
                return True
            left -= free
        return False

    # Figures.

    def ways(self, i, route, durations):
        """Usage on arrival at each task of a route, and after the last."""
        usage, here, arrivals, in_time = 0.0, None, [], self.mission.rules.usage == "time"
        for j in route:
            task = self.tasks[j]
            leg = (self._travel.seconds if in_time else self._travel.metres)(i, here, task)
            arrivals.append(usage + leg)
            usage = arrivals[-1] + (durations[j] if in_time else task.actuation_cost)
            here = task
        return arrivals, usage

    def way_home(self, i, route, measure="usage"):
        """What the way from a route's last task to the robot's end takes."""
        if not route or not self._travel.has_end(i):
            return 0.0
        in_time = measure == "seconds" or self.mission.rules.usage == "time"
        return (self._travel.seconds if in_time else self._travel.metres)(i, self.tasks[route[-1]], "end")

    def usages(self, routes):
        durations = {j: self.duration_s(j, members) for j, members in self.teams(routes).items()}
        return [self.ways(i, route, durations)[1] + self.way_home(i, route) for i, route in enumerate(routes)]

    def figures(self, routes):
        """All that can be minimised, by name, of admissible routes."""
        begins, ends = self.schedule(routes)
        durations = {j: ends[j] - begins[j] for j in begins}
        usages, arrival = self.usages(routes), {}
        for i, route in enumerate(routes):
            for j, usage in zip(route, self.ways(i, route, durations)[0], strict=True):
                arrival[j] = max(arrival.get(j, 0.0), usage)
        last = list(ends.values())
        if self.mission.rules.makespan_includes_return:
            last += [self.back(i, route, ends) for i, route in enumerate(routes) if route]
        late = {j: 0.0 if self.tasks[j].due_s is None else max(0.0, ends[j] - self.tasks[j].due_s) for j in ends}
        return {
            "total": sum(usages),
            "max": max(usages),
            "total+max": sum(usages) + max(usages),
            "average": sum(arrival.values()) / max(1, len(arrival)),
            "makespan": max(last, default=0.0),
            "lateness": sum(self.tasks[j].priority * seconds for j, seconds in late.items()),
        }

    def value(self, routes):
        """Weight of the tasks done, and the objective, with what breaks ties."""
        figures = self.figures(routes)
        tie = figures["total"] if self.objective == "lateness" else 0.0
        return sum(sorted(self.tasks[j].priority for j in self.teams(routes))), figures[self.objective], tie

    # Verdicts.

    def faults(self, routes):
        """The rules that routes break, by the words of reasons; empty: they are admissible."""
        teams = self.teams(routes)
        found = self._broken_before(routes, teams, way_home=True)
        if any((j in teams) != (k in teams) for j, k in self.delivers.items()):
            found.add("load")
        if any(not set(self.before[j]) <= teams.keys() for j in teams):
            found.add("prerequisite")
        if any(not set(self.units[self.unit_of[j]]) <= teams.keys() for j in teams):
            found.add("relation")
        if self._holds("min-tasks"):
            pairs = zip(self.robots, routes, strict=True)
            found |= {"min-tasks" for robot, route in pairs if route and len(route) < robot.min_tasks}
        found |= self._too_long(routes, way_home=True)
        return found

    def hopeless(self, routes):
        """Whether routes break a rule that they break as well with anything behind them."""
        found = self._broken_before(routes, self.teams(routes), way_home=False)
        return bool(found or self._too_long(routes, way_home=False))

    def _broken_before(self, routes, teams, *, way_home):
        found = {"team" for j, members in teams.items() if not self.is_team(j, members)}
        for j in teams:
            if any(k in teams and set(teams[k]) != set(teams[j]) for k in self.same[j]):
                found.add("relation")
            if any(k in teams and set(teams[k]) & set(teams[j]) for k in self.other[j]):
                found.add("relation")
        if any(len(teams.keys() & set(names)) > 1 for names in self.sets):
            found.add("either-or")
        if any(not self._carries(route) for route in routes):
            found.add("load")
        if not found and self.schedule(routes, way_home=way_home) is None:
            found.add("time")
        return found

    def _carries(self, route):
        """Whether all that a robot delivers was taken on board by itself before."""
        return all(j not in self.delivers or self.delivers[j] in route[:number] for number, j in enumerate(route))

    def _too_long(self, routes, *, way_home):
        """Whether usages are above capacities, and routes end after their shifts."""
        found, times = set(), self.schedule(routes, way_home=way_home)
        durations = {j: self.duration_s(j, members) for j, members in self.teams(routes).items()}
        for i, (robot, route) in enumerate(zip(self.robots, routes, strict=True)):
            usage = self.ways(i, route, durations)[1] + (self.way_home(i, route) if way_home else 0.0)
            if self._holds("capacity") and usage > self._capacity(robot) * (1 + ROUNDING):
                found.add("capacity")
            if not math.isfinite(usage):
                found.add("unreachable")
            if route and times and self._holds("shift") and robot.available_until_s is not None:
                back = self.back(i, route, times[1]) if way_home else times[1][route[-1]]
                if back is None or back > robot.available_until_s + ROUNDING:
                    found.add("shift")
        return found

    def _capacity(self, robot):
        if robot.work_capacity is None:
            return math.inf
        return (1 - self.mission.rules.capacity_reserve) * robot.work_capacity
