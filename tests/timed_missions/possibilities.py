"""What `muster check` says of a mission, against every plan of it: tasks alone, all together, every number."""

import re
from dataclasses import replace

from muster.mission.model import Lag
from tests.timed_missions.every_plan import EveryPlan
from tests.timed_missions.meaning import Meaning, with_last_end
from tests.timed_missions.places import CLOSE, SECONDS, near, seconds

WITHOUT = {
    "window": {"window_s": ()},
    "deadline": {"deadline_s": None},
    "capacity": {"work_capacity": None},
    "duty": {"longest_duty_s": None},
}


class Possibilities:
    """Every plan of a mission, and of missions that lack one of its limits."""

    def __init__(self, mission, ignored, every):
        self.mission, self.ignored, self.every = mission, ignored, every
        self.number = every.meaning.number
        self.done = every.done()
        self.robot = {robot.id: i for i, robot in enumerate(mission.robots)}
        self._free = {}

    def can(self, names):
        """Whether some plan does all these tasks."""
        wanted = {self.number[name] for name in names}
        return any(wanted <= done for done in self.done)

    def least_left_out(self, names):
        """How many of these tasks every plan leaves out."""
        wanted = {self.number[name] for name in names}
        return min(len(wanted - done) for done in self.done)

    def wrong_alone(self, said):
        """What is wrong with the tasks that are said to be impossible by themselves, and with their reasons."""
        lost = {item.task for item in said}
        for item in said:
            if self.can([item.task]):
                yield f"{item.task} is said to be impossible, and is done"
            for reason in item.reasons:
                if not self._reason_holds(item.task, reason, lost):
                    yield f"{item.task} {reason}: a false sentence"

    def wrong_together(self, found, lost):
        """What is wrong with a conflict and with shortfalls, or with there being none."""
        conflict, tasks = found.conflict, {task.id for task in self.mission.tasks} - set(lost)
        for short in found.shortfalls:
            if self.least_left_out(short.tasks) < short.left_out:
                yield f"{short}: a plan leaves out fewer"
        if conflict is None:
            if not found.proven and not found.unknown and not self.can(tasks):
                yield f"one plan is said to do {sorted(tasks)}"
            return
        names = set(conflict.tasks)
        if self.can(names):
            yield f"{names} is said to be a conflict, and is done"
        if conflict.minimal and not all(self.can(names - {name}) for name in names):
            yield f"{names} is not a smallest conflict"
        if not self._conflict_holds(conflict):
            yield f"{conflict}: a false sentence"

    # --- plans of missions with one limit less ----------------------------------------------------------------------

    def _plans(self, *, tasks=(), robots=(), without=()):
        """(routes, begins, ends) of every plan of the mission without some limits of some tasks and robots."""
        key = frozenset(tasks), frozenset(robots), frozenset(without)
        if key not in self._free:
            changed = replace(
                self.mission,
                tasks=tuple(_free(one, without, tasks, ("window", "deadline")) for one in self.mission.tasks),
                robots=tuple(_free(one, without, robots, ("shift", "duty", "capacity")) for one in self.mission.robots),
            )
            meaning = Meaning(changed, ignored=self.ignored)
            plans = EveryPlan(meaning).admissible
            self._free[key] = meaning, [(routes, *meaning.schedule(routes)) for routes in plans]
        return self._free[key]

    # --- sentences on tasks alone -----------------------------------------------------------------------------------

    def _reason_holds(self, name, reason, lost):
        for pattern, check in ALONE:
            found = re.fullmatch(pattern, reason.detail)
            if found:
                return check(self, reason.robot, name, lost, *found.groups())
        return False

    def by(self, robot, name, **lifted):
        """The plans in which a robot does a task."""
        i, j = self.robot[robot], self.number[name]
        meaning, plans = self._plans(**lifted)
        return meaning, i, j, [plan for plan in plans if j in plan[0][i]]

    def _conflict_holds(self, conflict):
        detail, _, others = conflict.detail.partition(" (others: ")
        names = (*conflict.tasks, *conflict.prerequisites)
        if others and set().union(*map(self.doers, names)) - set(conflict.robots):
            return False
        for pattern, check in TOGETHER:
            found = re.fullmatch(pattern, detail)
            if found:
                return check(self, conflict, *found.groups())
        return False

    def doers(self, name):
        """The robots that do a task in any plan."""
        j = self.number[name]
        return {
            self.mission.robots[i].id for plan in self.every.admissible for i, route in enumerate(plan) if j in route
        }

    def task(self, name):
        return self.mission.tasks[self.number[name]]


def _free(one, without, names, own):
    """A task or robot without the limits, if it is one of those named."""
    changes = {}
    for word in own if one.id in names else ():
        if word in without:
            changes |= WITHOUT.get(word, {})
    free = replace(one, **changes)
    return with_last_end(free, None) if "shift" in own and "shift" in without and one.id in names else free


def _not_before(said, times):
    """Whether no time is below the one that is said to be the earliest."""
    return all(time >= seconds(said) - CLOSE for time in times)


def _arrives(possible, robot, name, lost, time, close):
    meaning, i, j, plans = possible.by(robot, name, tasks=[name], without=["window"])
    times = [_arrival(meaning, i, j, routes, ends) for routes, _, ends in plans]
    return _not_before(time, times) and near(close, possible.task(name).window_s[-1][1])


def _arrival(meaning, i, j, routes, ends):
    route = routes[i]
    at = route.index(j)
    leaves = ends[route[at - 1]] if at else meaning.robots[i].available_from_s
    way = meaning._travel.seconds(i, meaning.tasks[route[at - 1]] if at else None, meaning.tasks[j])
    return meaning.moved(i, leaves, way)


def _begins(possible, robot, name, lost, _, time, close):
    _, _, j, plans = possible.by(robot, name, tasks=[name], without=["window"])
    return _not_before(time, [at[j] for _, at, _ in plans]) and near(close, possible.task(name).window_s[-1][1])


def _ends(possible, robot, name, lost, time, deadline):
    _, _, j, plans = possible.by(robot, name, tasks=[name], without=["deadline"])
    return _not_before(time, [ends[j] for *_, ends in plans]) and near(deadline, possible.task(name).deadline_s)


def _route_ends(possible, robot, name, lost, time, until):
    meaning, i, _, plans = possible.by(robot, name, robots=[robot], without=["shift"])
    times = [meaning.back(i, routes[i], ends) for routes, _, ends in plans]
    return _not_before(time, times) and near(until, possible.mission.robots[i].available_until_s)


def _under_way(possible, robot, name, lost, time, longest):
    """No plan has the robot under way for less than is said, if its duty had no limit."""
    meaning, i, _, plans = possible.by(robot, name, robots=[robot], without=["duty"])
    times = [meaning.back(i, routes[i], ends) - meaning.robots[i].available_from_s for routes, _, ends in plans]
    return _not_before(time, times) and near(longest, possible.mission.robots[i].longest_duty_s)


def _waits_too_long(possible, robot, name, lost, until):
    """No plan does the task by the robot, and its shift ends when it is said to."""
    done = possible.by(robot, name)[-1]
    return not done and near(until, possible.mission.robots[possible.robot[robot]].available_until_s)


def _waits_too_long_for(word):
    """No plan does the task by the robot, and its deadline, or last window, ends when it is said to."""

    def holds(possible, robot, name, lost, end):
        task = possible.task(name)
        return not possible.by(robot, name)[-1] and near(
            end, task.deadline_s if word == "deadline" else sorted(task.window_s)[-1][1]
        )

    return holds


def _takes(possible, robot, name, lost, usage, _, capacity, __):
    meaning, i, _, plans = possible.by(robot, name, robots=[robot], without=["capacity"])
    own = possible.every.meaning._capacity(possible.mission.robots[i])
    return _not_before(usage, [meaning.usages(routes)[i] for routes, *_ in plans]) and near(capacity, own)


def _held_back(possible, robot, name, lost, other, how, time, limit):
    """That a task before it cannot begin, or end, so late as the task behind it would need."""
    word = "window" if how == "begins" else "deadline"
    _, plans = possible._plans(tasks=[other], without=[word])
    j, k = possible.number[name], possible.number[other]
    both = [(at if how == "begins" else ends)[k] for _, at, ends in plans if j in at and k in at]
    task = possible.task(other)
    return _not_before(time, both) and near(limit, task.window_s[-1][1] if how == "begins" else task.deadline_s)


def _too_far(possible, robot, name, lost, within, other, way):
    """That whoever does one task is too late at the other, which no other robot does."""
    lag = possible.task(name).lags[other]
    travel, tasks = possible.every.meaning._travel, (possible.task(other), possible.task(name))
    ways = [travel.seconds(i, *tasks) for i in range(len(possible.mission.robots))]
    return near(within, lag.within_s) and any(near(way, one) for one in ways) and not possible.can([name])


def _lags_exclude(possible, robot, name, lost, said, _):
    """No plan does the task by the robot, and each lag that is named is one of the mission."""
    return not possible.by(robot, name)[-1] and all(_is_lag(possible, part) for part in said.split("; "))


def _is_lag(possible, said):
    lag = re.fullmatch(rf"(\S+) begins at (least|most) {SECONDS} after (\S+) ends", said)
    if lag is None:
        task, other = re.fullmatch(r"(\S+) begins together with (\S+)", said).groups()
        unit_of = possible.every.meaning.unit_of
        return unit_of[possible.number[task]] == unit_of[possible.number[other]]
    task, how, time, before = lag.groups()
    given = possible.task(task).lags.get(before, Lag())
    return before in possible.task(task).prerequisites and near(
        time, given.after_s if how == "least" else given.within_s
    )


def _lost_before(possible, robot, name, lost, other):
    return other in lost and other in possible.task(name).prerequisites


def _lost_with(possible, robot, name, lost, other):
    unit = possible.every.meaning.units[possible.every.meaning.unit_of[possible.number[name]]]
    return other in lost and possible.number[other] in unit


def _nothing_else(possible, robot, name, lost, *groups):
    """No plan does the task by the robot: the sentence has no other number."""
    return not possible.by(robot, name)[-1]


def _no_common_window(possible, robot, name, lost, windows):
    """No plan does the task by the robot, and each task that is named has these windows."""
    said = re.split(r", (?=\S+ from )", windows)
    return not possible.by(robot, name)[-1] and all(_has_windows(possible.task(each.split()[0]), each) for each in said)


def _has_windows(task, said):
    spans = re.findall(rf"from {SECONDS}(?: to {SECONDS})?", said)
    windows = sorted(task.window_s)
    return len(spans) == len(windows) and all(
        near(opens, window[0]) and (near(closes, window[1]) if closes else window[1] is None)
        for (opens, closes), window in zip(spans, windows, strict=True)
    )


def _same_robot(possible, robot, name, lost, other, mate):
    tied = other in possible.task(name).same_robot_as or name in possible.task(other).same_robot_as
    return tied and mate == robot and robot not in possible.doers(other)


def _other_robot(possible, robot, name, lost, other, only):
    tied = other in possible.task(name).other_robot_than or name in possible.task(other).other_robot_than
    return tied and only == robot and possible.doers(other) <= {robot}


_TIME = rf"at {SECONDS} at the earliest, its "
_WINDOW, _DEADLINE = rf"(?:last )?window closes at {SECONDS}", rf"deadline is {SECONDS}"
ALONE = (
    (rf"arrives {_TIME}{_WINDOW}", _arrives),
    (rf"(begins after \S+,|begins together with .+,|its team is there|begins) {_TIME}{_WINDOW}", _begins),
    (rf"ends {_TIME}{_DEADLINE}", _ends),
    (rf"its route would end {_TIME}shift ends at {SECONDS}", _route_ends),
    (rf"takes at least {SECONDS} from its start to the end of its route, its longest duty is {SECONDS}", _under_way),
    (rf"what it waits for is too late for its shift, which ends at {SECONDS}", _waits_too_long),
    (rf"what it waits for is too late for its deadline, which is {SECONDS}", _waits_too_long_for("deadline")),
    (
        rf"what it waits for is too late for its (?:last )?window, which closes at {SECONDS}",
        _waits_too_long_for("window"),
    ),
    (r"takes at least ([\d.]+) (m|s), of ([\d.]+) (m|s)", _takes),
    (rf"(\S+) may end only so long before what follows: it (begins) {_TIME}{_WINDOW}", _held_back),
    (rf"(\S+) may end only so long before what follows: it (ends) {_TIME}{_DEADLINE}", _held_back),
    (r"(\S+) comes before it and can never be done", _lost_before),
    (r"begins together with (\S+), which can never be done", _lost_with),
    (r"begins together with .+, and from when all are ready no window is open to all: (.+)", _no_common_window),
    (r"begins together with .+, for which no different robots are left", _nothing_else),
    (r"the same robot must do (\S+), which comes with it, and cannot be (\S+)", _same_robot),
    (r"another robot must do (\S+), which comes with it, and only (\S+) can", _other_robot),
    (
        rf"begins at most {SECONDS} after (\S+) ends, and the robot that does both takes {SECONDS} to come to it",
        _too_far,
    ),
    (rf"(\S+ begins at (?:least|most) .+|\S+ begins together .+): with the work {SECONDS} too long", _lags_exclude),
    (r"(lacks .+|type \S+ scores .+|only .+ may do it|fits no part of the team: .+)", _nothing_else),
    (r"does at least \d+ tasks or none, and (may do only \d+ tasks?|can never do so many)", _nothing_else),
    (r"needs .+; .+", _nothing_else),
    (r"there is no way to it", _nothing_else),
)


def _together_usage(possible, conflict, names, usage, _, capacity, __):
    """What robots use together, in plans of all the tasks if their capacities were unlimited."""
    meaning, plans = possible._plans(robots=conflict.robots, without=["capacity"])
    wanted = {possible.number[name] for name in (*conflict.tasks, *conflict.prerequisites)}
    robots = [possible.robot[name] for name in conflict.robots]
    sums = [sum(meaning.usages(routes)[i] for i in robots) for routes, at, _ in plans if wanted <= at.keys()]
    limit = sum(possible.every.meaning._capacity(possible.mission.robots[i]) for i in robots)
    return names == ", ".join(conflict.robots) and _not_before(usage, sums) and near(capacity, limit)


def _by_the_same(possible, conflict, a, b, first, robots, second, others):
    named = ((first, robots), (second, others))
    return all(possible.doers(name) <= set(who.split(", ")) for name, who in named) and {a, b} == {first, second}


def _by_others(possible, conflict, a, b, robot):
    return possible.doers(a) | possible.doers(b) <= {robot}


def _one_after_the_other(possible, conflict, robot, text):
    """Each of two orders: what is too late in it, if the limits of the second task were lifted."""
    return all(_too_late_in(possible, robot, part) for part in text.split("; ")) and len(text.split("; ")) == 2


def _too_late_in(possible, robot, part):
    before = re.fullmatch(r"(\S+) comes before (\S+)", part)
    if before:
        return before[1] in possible.task(before[2]).prerequisites
    late = re.fullmatch(rf"with (\S+) first, (\S+) (begins|ends) {_TIME}(?:{_WINDOW}|{_DEADLINE})", part)
    if late:
        first, then, how, time, close, deadline = late.groups()
        lifted = ["window", "deadline"] if how == "begins" else ["deadline"]
        routes = _in_order(possible, robot, first, then, tasks=[then], without=lifted)
        times = [(at if how == "begins" else ends)[possible.number[then]] for _, at, ends in routes]
        task = possible.task(then)
        return _not_before(time, times) and near(close or deadline, task.window_s[-1][1] if close else task.deadline_s)
    over = re.fullmatch(rf"with (\S+) first and then (\S+), its route would end {_TIME}shift ends at {SECONDS}", part)
    first, then, time, until = over.groups()
    i = possible.robot[robot]
    routes = _in_order(possible, robot, first, then, robots=[robot], without=["shift"])
    free, _ = possible._plans(robots=[robot], without=["shift"])
    ends = [free.back(i, one[i], ends) for one, _, ends in routes]
    return _not_before(time, ends) and near(until, possible.mission.robots[i].available_until_s)


def _in_order(possible, robot, first, then, **lifted):
    """The plans in which the robot does one task before another."""
    _, i, j, plans = possible.by(robot, then, **lifted)
    k = possible.number[first]
    return [plan for plan in plans if k in plan[0][i] and plan[0][i].index(k) < plan[0][i].index(j)]


def _however(possible, conflict, until):
    """The last time at which any of the tasks can begin or end."""
    if until is None:
        return True
    tasks = [possible.task(name) for name in (*conflict.tasks, *conflict.prerequisites)]
    windows = [task.window_s[-1][1] if task.window_s and "window" not in possible.ignored else None for task in tasks]
    deadlines = [None if "deadline" in possible.ignored else task.deadline_s for task in tasks]
    last = max(min(time for time in pair if time is not None) for pair in zip(windows, deadlines, strict=True))
    return near(until, last)


_BREAKS = r"(?:be too late|need more than its capacity|be too late or need more than its capacity)"
_UNTIL = rf"(?:; all must begin or end by {SECONDS})?"
_USES = r"would use at least ([\d.]+) (m|s), of ([\d.]+) (m|s)"


def _of_sizes(possible, conflict, a, b, first, few, then, many):
    """Each task is done by as many robots at least as is said, in every plan, and one of them by never more."""
    least = {first: int(few), then: int(many)}
    fewest = min(least, key=least.get)
    teams = {
        name: {sum(possible.number[name] in route for route in plan) for plan in possible.every.admissible} - {0}
        for name in (a, b)
    }
    return (
        (a, b) == (first, then)
        and all(min(teams[name], default=least[name]) >= least[name] for name in least)
        and (max(teams[fewest], default=0) < max(least.values()))
    )


TOGETHER = (
    (rf"only (\S+) can do them, and {_USES}", _together_usage),
    (rf"together (.+) {_USES}", _together_usage),
    (r"the same robot must do (\S+) and (\S+); (\S+) only (.+) can do, (\S+) only (.+)", _by_the_same),
    (r"the same robots must do (\S+) and (\S+); (\S+) needs (\d+) robots?, (\S+) (\d+) robots?", _of_sizes),
    (r"different robots must do (\S+) and (\S+), and only (\S+) can do them", _by_others),
    (rf"only .+ can do them, and in every order it would {_BREAKS}{_UNTIL}", _however),
    (r"only (\S+) can do them: (.+)", _one_after_the_other),
    (rf"however .+ share them out, one of the robots would {_BREAKS}{_UNTIL}", _however),
    (r"(however) .+ share them out, one of the robots would need more than its capacity", lambda *_: True),
)
