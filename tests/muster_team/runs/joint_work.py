"""What a simulated team has done: each task by whom, and whether all of them began it at one moment."""

from collections import defaultdict

from tests.muster_team.runs.simulated_team import LOOK_S

MOMENT_S = LOOK_S + 1e-9
"""Each robot looks at the clock so often: begins that lie so close together are one."""


def deeds(team, tasks=()):
    """For each task that was done the teams that have done it, each with when all of its robots began; None: never.

    `tasks` are those that were added. A robot that broke its work off has begun for nothing, unless its part was done
    by then: it only waited.
    """
    lasts_s = {task.id: task.duration_s for task in (*team.problem.tasks, *tasks)}
    begun, found = defaultdict(list), defaultdict(dict)
    for at_s, robot, kind, data in team.told:
        task = data.get("task")
        if kind == "starts":
            begun[robot, task].append(at_s)
        elif kind == "work_broken_off" and at_s - begun[robot, task][-1] < lasts_s[task] - MOMENT_S:
            begun[robot, task].pop()
        elif kind == "ends":
            members = tuple(data.get("team", (robot,)))
            found[task][members] = _one_moment([begun[one, task] for one in members])
    return found


def _one_moment(begins):
    """The last moment at which all began, of the times at which each did."""
    first, *others = begins
    for at_s in reversed(first):
        near = [[s for s in theirs if abs(s - at_s) <= MOMENT_S] for theirs in others]
        if all(near):
            return max([at_s, *(max(times) for times in near)])
    return None


def is_able(task, robots):
    """Whether robots are enough for a task, with what they can."""
    if len(robots) < (task.robots_needed or 1):
        return False
    if not all(set(task.requires) <= set(robot.skills) for robot in robots):
        return False
    if task.team and (len(robots) != len(task.team) or not _fill(task.team, robots)):
        return False
    return all(
        sum(robot.abilities.get(kind, 0.0) for robot in robots) >= least for kind, least in (task.needs or {}).items()
    )


def _fill(parts, robots):
    """Whether each part of a team has a robot of its own that can do it."""
    if not parts:
        return True
    first, *others = parts
    able = [robot for robot in robots if set(first.requires) <= set(robot.skills)]
    return any(_fill(others, [other for other in robots if other is not robot]) for robot in able)


def check_nobody_was_alone(team):
    """Every task was done by as many as it needs, who began at the same moment and did not stop."""
    tasks = {task.id: task for task in team.problem.tasks}
    robots = {robot.id: robot for robot in team.problem.robots}
    for name, teams in deeds(team).items():
        for members, begun in teams.items():
            assert is_able(tasks[name], [robots[one] for one in members]), (name, members)
            assert begun is not None, (name, members)
