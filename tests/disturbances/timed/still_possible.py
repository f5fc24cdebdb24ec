"""Whether tasks that were lost could still be done when a mission is over, by trying all teams.

It shares no code with planning and execution but the times of legs.
"""

from itertools import combinations, permutations
from math import dist, inf

from muster.mission.task_relations import alternatives_of
from muster.motion.leg_times import LegTimes

MARGIN_S = 1.0
"""Of what is this close to impossible nothing is said."""


def still_possible(executor, lost):
    """The lost tasks, with those that begin together, that robots could do from now on, each with such a team."""
    ledger = executor.ledger
    stand_ins = {name: names for names in alternatives_of(ledger.tasks.values()) for name in names}
    for unit in _units(ledger.tasks.values()):
        others = {name for task in unit for name in stand_ins.get(task.id, ())} - {task.id for task in unit}
        if others.isdisjoint(ledger.ends_s) and all(t.id in lost and t.id not in ledger.cancelled for t in unit):
            teams = next((teams for teams in _teams(executor, unit) if _in_time(executor, unit, teams)), None)
            if teams is not None:
                yield {task.id: [robot.id for robot in team] for task, team in zip(unit, teams, strict=True)}


def _units(tasks):
    """Tasks that begin at the same moment."""
    units = [{task.id, *task.starts_with} for task in tasks]
    for task in tasks:
        joined = set().union(*(unit for unit in units if task.id in unit))
        units = [unit for unit in units if task.id not in unit] + [joined]
    by_id = {task.id: task for task in tasks}
    return [[by_id[name] for name in sorted(unit)] for unit in units]


def _teams(executor, unit):
    """Teams for the tasks of a unit, without a common robot."""
    crew = [state for state in executor.crew.values() if not state.out]
    # Of robots with a least number of tasks the plan may have had none, as they would not have had enough.
    yield from _teams_of(executor, unit, [one.robot for one in crew if _is_free(one)])


def _is_free(state):
    """Whether nothing is asked of the whole route of a robot; one that rests, or is under way for too long, is not."""
    robot = state.robot
    return len(state.done) + 1 >= robot.min_tasks and not robot.shifts_s and robot.longest_duty_s is None


def _teams_of(executor, unit, robots):
    if not unit:
        yield []
        return
    task, *others = unit
    for size in range(1, len(robots) + 1):
        for team in combinations(robots, size):
            if covers(task, team) and _related(executor, task, team):
                rest = [robot for robot in robots if robot not in team]
                yield from ([team, *more] for more in _teams_of(executor, others, rest))


def covers(task, team):
    """Whether the robots are enough for the task, and none too many where their number is given."""
    if not all(set(task.requires) <= set(robot.skills) for robot in team):
        return False
    if task.needs:
        return all(
            sum((robot.abilities or {}).get(name, 0.0) for robot in team) >= least for name, least in task.needs.items()
        )
    if task.team:
        wanted = [part for part in task.team for _ in range(part.count)]
        return len(wanted) == len(team) and any(
            all(set(part.requires) <= set(robot.skills) for part, robot in zip(wanted, order, strict=True))
            for order in permutations(team)
        )
    return len(team) == (task.robots_needed or 1)


def _related(executor, task, team):
    """Whether relations to tasks that are done allow the team."""
    ledger, own = executor.ledger, {robot.id for robot in team}
    for other in ledger.tasks.values():
        if other.id in ledger.ends_s:
            did = set(ledger.members(other.id))
            if (other.id in task.same_robot_as or task.id in other.same_robot_as) and did != own:
                return False
            if (other.id in task.other_robot_than or task.id in other.other_robot_than) and did & own:
                return False
    return True


def _in_time(executor, unit, teams):
    """Whether the teams could go there now, begin together, and end in time."""
    ledger = executor.ledger
    if any(before not in ledger.ends_s for task in unit for before in task.prerequisites):
        return False
    begin = max(_there_s(executor, robot, task) for task, team in zip(unit, teams, strict=True) for robot in team)
    begin = max([begin, *(ledger.ends_s[b] + task.lag(b).after_s for task in unit for b in task.prerequisites)])
    begin = _next_common(unit, begin + MARGIN_S)
    if begin == inf:
        return False
    for task, team in zip(unit, teams, strict=True):
        lasts = max(task.duration_s / robot.efficiency for robot in team) + ledger.delays_s.get(task.id, 0.0)
        end = begin + lasts + MARGIN_S
        limits = [ledger.ends_s[b] + within for b in task.prerequisites if (within := task.lag(b).within_s) is not None]
        home = max(_home_s(executor, robot, task) for robot in team)
        shifts = [robot.available_until_s for robot in team if robot.available_until_s is not None]
        if begin > min(limits, default=inf) or end > (inf if task.deadline_s is None else task.deadline_s):
            return False
        if end + home > min(shifts, default=inf):
            return False
    return True


def _next_common(unit, begin):
    """The first time at which all tasks of the unit may begin; inf if there is none."""
    times = [begin, *(first for task in unit for first, _ in task.window_s if first > begin)]
    return min((at for at in times if all(_open(task, at) for task in unit)), default=inf)


def _open(task, at):
    return not task.window_s or any(first <= at and (last is None or at <= last) for first, last in task.window_s)


def _there_s(executor, robot, task):
    state = executor.crew[robot.id]
    return max(executor.now_s, robot.available_from_s) + _leg_s(executor, robot, state.position, task.position)


def _home_s(executor, robot, task):
    home = executor.crew[robot.id].home
    return 0.0 if home is None else _leg_s(executor, robot, (*task.position, 0.0), home)


def _leg_s(executor, robot, start, end):
    times = LegTimes.in_mission(robot, executor.mission)
    return float(times.seconds(dist(start[:2], end[:2])))
