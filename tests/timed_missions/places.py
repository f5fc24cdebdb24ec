"""What one more task in the routes of a plan would do: every place for it, and which reasons against them are true."""

import re
from dataclasses import replace
from functools import cache
from itertools import product

from tests.timed_missions.meaning import Meaning, with_last_end

LIMITS = ("window", "deadline", "shift", "duty", "capacity", "min-tasks")
"""The rules that are looked at one after the other: each is named where it leaves no place, beside those before it."""

PAIRS = ("skill", "suitability", "lock")
SECONDS = r"([\d,.]*\d) s"
CLOSE = 0.0051  # sentences have two digits, where these tell the numbers apart


class Places:
    """Every place of a task that a plan leaves out, robot i in its team, with all that begins with it."""

    def __init__(self, mission, ignored, routes, i, j):
        self.mission, self.ignored, self.routes, self.i, self.j = mission, tuple(ignored), routes, i, j
        self.meaning = Meaning(mission, ignored=ignored)
        self.done = {k for route in routes for k in route}
        self.unit = [k for k in self.meaning.units[self.meaning.unit_of[j]] if k not in self.done]
        self.all = [place for team in self._teams() for place in self._put(team)]
        self.left = cache(self._left)

    def teams_of(self, k):
        """The teams for a task, robot i in that for the task that was asked about."""
        robots = range(len(self.mission.robots))
        sets = (tuple(r for r in robots if bits >> r & 1) for bits in range(1, 1 << len(robots)))
        return [team for team in sets if self.meaning.is_team(k, team) and (k != self.j or self.i in team)]

    def _teams(self):
        """For each robot the task that it gets."""
        for teams in product(*(self.teams_of(k) for k in self.unit)):
            given = {r: k for k, members in zip(self.unit, teams, strict=True) for r in members}
            if len(given) == sum(map(len, teams)):
                yield given

    def _put(self, given):
        """Routes with the tasks, at all places."""
        for gaps in product(*(range(len(self.routes[r]) + 1) for r in given)):
            routes = [list(route) for route in self.routes]
            for (r, k), gap in zip(given.items(), gaps, strict=True):
                routes[r].insert(gap, k)
            yield tuple(map(tuple, routes))

    def _left(self, *words):
        """The places that keep all rules but those of these words."""
        meaning = self.meaning_without(words)
        return [routes for routes in self.all if not meaning.faults(routes)]

    def meaning_without(self, words):
        """The rules but those of these words; windows and shifts begin when they do, and the last does not end."""
        tasks, robots = self.mission.tasks, self.mission.robots
        if "window" in words:
            tasks = tuple(replace(task, window_s=_never_closed(task.window_s)) for task in tasks)
        if "shift" in words:
            robots = tuple(with_last_end(robot, None) for robot in robots)
        others = [word for word in words if word not in ("window", "shift")]
        return Meaning(replace(self.mission, tasks=tasks, robots=robots), ignored=(*self.ignored, *others))

    def is_true(self, word):
        """Whether the rule keeps robot i from the task, and is the first of the limits that leaves no place."""
        if word == "not-chosen":
            return bool(self.left())
        if self.left():
            return False
        if word in PAIRS:
            others = [other for other in PAIRS if other != word]
            return not Meaning(self.mission, ignored=(*self.ignored, *others)).allowed[self.i][self.j]
        if word == "team":
            return not self.teams_of(self.j)
        if word == "relation":
            return all(self._breaks_relations(routes) for routes in self.all)
        faults = [self.meaning_without(LIMITS).faults(routes) for routes in self.all]
        if word == "unreachable":
            return any("unreachable" in found for found in faults) and set() not in faults
        if word == "prerequisite":
            return bool(self.missing(self.j)) or not any(found <= {"unreachable"} for found in faults)
        at = LIMITS.index(word)
        return bool(self.left(*LIMITS[at:])) and not self.left(*LIMITS[at + 1 :])

    def missing(self, k):
        """The prerequisites of a task that are left out."""
        return [b for b in self.meaning.before[k] if b not in self.done]

    def _breaks_relations(self, routes):
        before = any(
            b not in self.done | set(self.unit) for k in self.unit if k != self.j for b in self.meaning.before[k]
        )
        return before or "relation" in self.meaning_without(LIMITS).faults(routes)

    # --- the numbers of a sentence ------------------------------------------------------------------------------------

    def sentence_holds(self, word, sentence):
        """Whether names and numbers of a reason are right; None: it is not one of the known sentences."""
        for pattern, check in SENTENCES:
            found = re.fullmatch(pattern, sentence)
            if found:
                return check(self, word, *found.groups())
        return None

    def times(self, word):
        """Begins and ends of the tasks done at each place that keeps the rules before a limit."""
        lifted = LIMITS[LIMITS.index(word) :]
        meaning = self.meaning_without(lifted)
        return [(routes, *meaning.schedule(routes)) for routes in self.left(*lifted)]

    def arrival(self, routes, ends):
        """When robot i is at the task."""
        route = routes[self.i]
        at = route.index(self.j)
        last = self.mission.tasks[route[at - 1]] if at else None
        begin = ends[route[at - 1]] if at else self.mission.robots[self.i].available_from_s
        meaning = self.meaning_without(("shift",))
        return meaning.moved(self.i, begin, self.meaning._travel.seconds(self.i, last, self.mission.tasks[self.j]))

    def route_end(self, routes, ends):
        """When robot i is at the end of its route."""
        return self.meaning_without(("shift",)).back(self.i, routes[self.i], ends)

    def usages(self, *words):
        """What robot i uses at each place that keeps all rules but these."""
        return [(routes[self.i].index(self.j), self.meaning.usages(routes)[self.i]) for routes in self.left(*words)]

    def number(self, name):
        return self.meaning.number[name]


def _never_closed(windows):
    *before, (opens, _) = sorted(windows, key=lambda window: window[0]) or [(None, None)]
    return (*before, (opens, None)) if windows else ()


def seconds(text):
    return float(text.replace(",", ""))


def near(said, true):
    return abs(seconds(said) - true) <= CLOSE


def closes(places, name, said):
    """Whether a task's last window ends when it is said to."""
    task = places.mission.tasks[places.j if name is None else places.number(name)]
    return near(said, task.window_s[-1][1])


def _fits(places, word, at, usage, _):
    found = places.usages()
    least = min(used for _, used in found)
    return near(usage, least) and any(gap + 1 == int(at) and near(usage, used) for gap, used in found)


def _arrives(places, word, time, close):
    least = min(places.arrival(routes, ends) for routes, _, ends in places.times(word))
    return near(time, least) and closes(places, None, close)


def _begins(places, word, time, close):
    return near(time, min(begins[places.j] for _, begins, _ in places.times(word))) and closes(places, None, close)


def _ends(places, word, time, deadline):
    least = min(ends[places.j] for _, _, ends in places.times(word))
    return near(time, least) and near(deadline, places.mission.tasks[places.j].deadline_s)


def _route_ends(places, word, time, until):
    least = min(places.route_end(routes, ends) for routes, _, ends in places.times(word))
    return near(time, least) and near(until, places.mission.robots[places.i].available_until_s)


def _other_begins(places, word, name, time, close):
    other = places.number(name)
    return closes(places, name, close) and any(near(time, begins[other]) for _, begins, _ in places.times(word))


def _other_ends(places, word, name, time, deadline):
    other = places.number(name)
    right = near(deadline, places.mission.tasks[other].deadline_s)
    return right and any(near(time, ends[other]) for _, _, ends in places.times(word))


def _uses(places, word, usage, _, capacity, __):
    least = min(used for _, used in places.usages(*LIMITS[LIMITS.index(word) :]))
    return near(usage, least) and near(capacity, places.meaning._capacity(places.mission.robots[places.i]))


def _too_few(places, word, name, count, least):
    i = next(i for i, robot in enumerate(places.mission.robots) if robot.id == name)
    counts = {len(routes[i]) for routes in places.left(*LIMITS[LIMITS.index(word) :])}
    return int(count) in counts and 0 < int(count) < int(least) == places.mission.robots[i].min_tasks


def _same_robot(places, word, name, robots):
    other = places.number(name)
    by = [robot.id for robot, route in zip(places.mission.robots, places.routes, strict=True) if other in route]
    return sorted(by) == sorted(robots.split(", ")) and other in _tied(places, "same_robot_as")


def _other_robot(places, word, name):
    other = places.number(name)
    return other in places.routes[places.i] and other in _tied(places, "other_robot_than")


def _tied(places, key):
    """The tasks that are in a relation to the task."""
    tasks, own = places.mission.tasks, places.mission.tasks[places.j]
    return {k for k, task in enumerate(tasks) if task.id in getattr(own, key) or own.id in getattr(task, key)}


def _left_out_before(places, word, names):
    return {places.number(name) for name in names.split(", ")} == set(places.missing(places.j))


def _begins_with(places, word, name, names):
    other = places.number(name)
    return other in places.unit and {places.number(one) for one in names.split(", ")} <= set(places.missing(other))


def _sums(places, word, _, sums):
    """The abilities of all robots that may do the task."""
    able = [r for r in range(len(places.mission.robots)) if places.meaning.allowed[r][places.j]]
    for name, said in (one.rsplit(" ", 1) for one in sums.split(", ")):
        if abs(sum((places.mission.robots[r].abilities or {}).get(name, 0.0) for r in able) - float(said)) > 1e-4:
            return False
    return True


def _only(places, word, needs, names):
    return sorted(names.split(", ")) == sorted(_able(places))


def _nobody(places, word, needs):
    return not _able(places)


def _able(places):
    """The robots that may do the task, and fit a part of its team."""
    parts, meaning = places.mission.tasks[places.j].team, places.meaning
    robots = [robot for k, robot in enumerate(places.mission.robots) if meaning.allowed[k][places.j]]
    return [robot.id for robot in robots if not parts or any(meaning._fits(robot, part) for part in parts)]


def _circles(places, word):
    """Whether tasks wait for each other at every place, whatever the lags."""
    return not _without_within(places)


def _too_long_after(places, word):
    return places.is_true(word) and bool(_without_within(places))


def _without_within(places):
    """The places that keep all rules but limits, if tasks may begin however long after their prerequisites."""
    tasks = tuple(
        replace(task, lags={name: replace(lag, within_s=None) for name, lag in task.lags.items()})
        for task in places.mission.tasks
    )
    mission = replace(places.mission, tasks=tasks)
    return Places(mission, places.ignored, places.routes, places.i, places.j).left(*LIMITS)


def _as_the_word(places, word, *groups):
    """The sentence says no more than the word of the reason."""
    return places.is_true(word)


_EARLIEST = " at the earliest, its (?:last )?window closes at "
SENTENCES = (
    (r"fits as number (\d+), for ([\d.]+) (m|s) in all", _fits),
    (rf"arrives at {SECONDS}{_EARLIEST}{SECONDS}", _arrives),
    (rf"begins at {SECONDS}{_EARLIEST}{SECONDS}", _begins),
    (rf"ends at {SECONDS} at the earliest, its deadline is {SECONDS}", _ends),
    (rf"its route would end at {SECONDS} at the earliest, its shift ends at {SECONDS}", _route_ends),
    (rf"with it (\S+) begins at {SECONDS}, its (?:last )?window closes at {SECONDS}", _other_begins),
    (rf"with it (\S+) ends at {SECONDS}, its deadline is {SECONDS}", _other_ends),
    (r"at least ([\d.]+) (m|s) with it, of ([\d.]+) (m|s)", _uses),
    (r"with it (\S+) would do (\d+) tasks?, and does at least (\d+) or none.*", _too_few),
    (r"the same robot must do (\S+), and (.+) does it", _same_robot),
    (r"another robot must do (\S+), which is in its route", _other_robot),
    (r"left out before it: (.+)", _left_out_before),
    (r"begins together with (\S+); left out before that: (.+)", _begins_with),
    (r"needs (.+); all who can be there have (.+) together.*", _sums),
    (r"needs (.+); only (.+) can be there", _only),
    (r"needs (.+); (\S+) alone can be there", _only),
    (r"needs (.+); no robot can be there", _nobody),
    (r"needs .+; with it one place stays empty", _as_the_word),
    (r"fits no part of the team: .+", _as_the_word),
    (r"(lacks .+|type \S+ scores .+|only .+ may do it)", _as_the_word),
    (r"there is no way (to it|for another robot of its team)", _as_the_word),
    (r"with it no times keep every robot within its longest duty", _as_the_word),
    (r"with it the route of another robot would end after its shift", _as_the_word),
    (r"at no place in its route are all (windows|deadlines) kept", _as_the_word),
    (r"with its team one of the robots would need more than its capacity", _as_the_word),
    (r"at every place in its route tasks would wait for each other in a circle", _circles),
    (
        r"at every place in its route a task would begin longer after its prerequisite than within_s allows",
        _too_long_after,
    ),
    (r"at every place in its route the prerequisites would wait in a circle", _as_the_word),
    (r"no team for it keeps its relations to the tasks of the plan", _as_the_word),
)
