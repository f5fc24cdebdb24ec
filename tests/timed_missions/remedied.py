"""Missions as remedies would have them, and whether these keep what they promise: beside every plan of the mission."""

from dataclasses import replace

from tests.timed_missions.every_plan import EveryPlan
from tests.timed_missions.meaning import Meaning, with_last_end

LESS = 1e-6  # relative: by how much less than what is said to be needed is tried
LIMITS = {"window": "window", "deadline": "deadline_s", "shift": "available_until_s"}
UNPROVEN = (*LIMITS, "duty", "relation", "min-tasks")
"""Changes with which a plan was found: without them there may be another."""


def changed(mission, i, j, remedy, **until):
    """The mission with the changes of a remedy for robot i and task j; `until`: other ends than those it names."""
    said = remedy.as_dict()
    ends = {key: said[key] and said[key]["until_s"] for key in LIMITS} | until
    robot, task = _robot(mission.robots[i], said, ends), _task(mission, i, j, said, ends)
    more = tuple(replace(mission.robots[i], **one) for one in said["team"] or ())
    tasks = [_untied(other, mission.tasks[j], said["relation"] or ()) for other in mission.tasks]
    tasks[j] = task
    robots = (*(robot if k == i else other for k, other in enumerate(mission.robots)), *more)
    return replace(mission, robots=robots, tasks=tuple(tasks), suitability=_suitability(mission, said["suitability"]))


def _robot(robot, said, ends):
    capacity, enough = robot.work_capacity, said["capacity"]["enough"]
    return replace(
        robot if ends["shift"] is None else with_last_end(robot, ends["shift"]),
        skills=(*robot.skills, *said["skills"]),
        min_tasks=said["min_tasks"]["enough"] if said["min_tasks"] else robot.min_tasks,
        longest_duty_s=None if said["duty"] else robot.longest_duty_s,
        work_capacity=capacity if capacity is None or enough is None else max(capacity, enough),
    )


def _task(mission, i, j, said, ends):
    task = mission.tasks[j]
    if ends["window"] is not None:
        *others, (opens, _) = sorted(task.window_s, key=lambda window: window[0])
        task = replace(task, window_s=(*others, (opens, ends["window"])))
    if ends["deadline"] is not None:
        task = replace(task, deadline_s=ends["deadline"])
    if said["lock"]:
        task = replace(task, only_robots=(*task.only_robots, mission.robots[i].id))
    for one in said["relation"] or ():
        left = tuple(name for name in getattr(task, one["relation"]) if name != one["task"])
        task = replace(task, **{one["relation"]: left})
    return task


def _untied(other, task, relations):
    for one in relations:
        if one["task"] == other.id:
            left = tuple(name for name in getattr(other, one["relation"]) if name != task.id)
            other = replace(other, **{one["relation"]: left})
    return other


def _suitability(mission, low):
    table = mission.suitability
    if low is None:
        return table
    return table | {low["robot_type"]: {**table[low["robot_type"]], low["task_type"]: low["needed"]}}


class Remedied:
    """A remedy with which robot i could do task j beside all tasks of some routes."""

    def __init__(self, mission, ignored, routes, i, j, remedy):
        self.mission, self.ignored, self.routes, self.i, self.j, self.remedy = mission, ignored, routes, i, j, remedy

    def wrong(self):
        """What is not as it is said to be."""
        if self.remedy.enough:
            yield from self._not_enough()
        for key in LIMITS:
            change = self.remedy.changes.get(key)
            if change is not None and self._less_will_do(key, change.at_least_s):
                yield f"{key}: less than {change.at_least_s} is enough"
        yield from self._needless()

    def _not_enough(self):
        """The routes of the remedy break a rule of the changed mission, or leave out a task of the plan."""
        new = changed(self.mission, self.i, self.j, self.remedy)
        number = {task.id: k for k, task in enumerate(new.tasks)}
        by_robot = {route.robot: tuple(number[name] for name in route.tasks) for route in self.remedy.routes}
        routes = tuple(by_robot[robot.id] for robot in new.robots)
        faults = Meaning(new, ignored=self.ignored).faults(routes)
        if faults:
            yield f"the changed mission's plan {routes} breaks {faults}"
        wanted = {self.j}.union(*self.routes)
        if self.j not in routes[self.i] or not wanted.issubset({k for route in routes for k in route}):
            yield f"the changed mission's plan {routes} does not do {wanted}"

    def _less_will_do(self, key, end):
        """Whether a plan does the task by the robot with an end a little earlier, whatever the capacity."""
        robot, task = self.mission.robots[self.i], self.mission.tasks[self.j]
        now = {"window": task.window_s and task.window_s[-1][1], "deadline": task.deadline_s}
        if end is None or end <= now.get(key, robot.available_until_s) * (1 + 2 * LESS):
            return False
        new = changed(self.mission, self.i, self.j, self.remedy, **{key: end - LESS * (1 + abs(end))})
        return self._can(new)

    def _can(self, mission):
        robots = tuple(replace(r, work_capacity=None) if k == self.i else r for k, r in enumerate(mission.robots))
        meaning = Meaning(replace(mission, robots=robots), ignored=self.ignored)
        return any(self.j in routes[self.i] for routes in EveryPlan(meaning).admissible)

    def _needless(self):
        """Changes that are said to be needed, without which a plan does the task by the robot, the others made."""
        for word in self.remedy.changes:
            if word in UNPROVEN:
                continue
            rest = {other: change for other, change in self.remedy.changes.items() if other != word}
            if self._can(changed(self.mission, self.i, self.j, replace(self.remedy, changes=rest))):
                yield f"{word}: {self.remedy.changes[word].short} is not needed"
        more = self.remedy.changes.get("team")
        if more is not None and len(more.robots) > 1:
            fewer = replace(more, robots=more.robots[1:])
            if self._can(changed(self.mission, self.i, self.j, _with(self.remedy, "team", fewer))):
                yield f"one robot less than {more.short} is enough"


def _with(remedy, word, change):
    return replace(remedy, changes={**remedy.changes, word: change})
