"""What a simulated team has done: each task by whom, and whether all of them began it at one moment."""

from collections import defaultdict

from tests.running.negotiated.simulated_team import LOOK_S

MOMENT_S = LOOK_S + 1e-9
"""Each robot looks at the clock so often: begins that lie so close together are one."""


def deeds(team):
    """For each task that was done the teams that have done it, each with when all of its robots began; None: never.

    A robot that broke its work off has begun for nothing, unless its part was done by then: it only waited.
    """
    lasts_s = {task.id: task.duration_s for task in team.problem.tasks}
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


def needed(task):
    """How many robots a task needs at least."""
    return task.robots_needed or 2 * bool(task.is_for_team) or 1


def check_nobody_was_alone(team):
    """Every task was done by as many as it needs, who began at the same moment and did not stop."""
    tasks = {task.id: task for task in team.problem.tasks}
    for name, teams in deeds(team).items():
        for members, begun in teams.items():
            assert len(members) >= needed(tasks[name]), (name, members)
            assert begun is not None, (name, members)
