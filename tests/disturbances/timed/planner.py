"""A planner for disturbed missions: task after task, each by the robots with the fewest tasks that are enough for it.

It looks at neither windows nor deadlines, so that they are missed; who does what it respects.
"""

from muster.execution.reallocation import Revision
from muster.execution.relations import Binding
from muster.execution.teams import lacking, units_of
from muster.mission.plan import Plan, Route


def plan_of(mission):
    routes = _routes(mission.tasks, mission.robots, {}, lambda task, robot: True, set())
    return Plan(routes=tuple(Route(name, tuple(route)) for name, route in routes.items()))


def planned_again(rest):
    """The rest planned from the beginning, as `Executor` has it."""
    crew = [snapshot.robot for snapshot in rest.crew]

    def may(task, robot):
        refused = robot.id in rest.refusals.get(task.id, {})
        return not refused and rest.bindings.get(task.id, Binding()).allows(robot.id)

    lost = dict(rest.expired)
    done = {*rest.ended, *(snapshot.task for snapshot in rest.crew if snapshot.task)}
    routes = _routes([task for task in rest.tasks if task.id not in lost], crew, lost, may, done)
    there = {name for route in routes.values() for name in route}
    left_out = {task.id: lost.get(task.id, "") for task in rest.tasks if task.id not in there}
    return Revision(
        routes={name: tuple(route) for name, route in routes.items()},
        ahead={name: {} for name in routes},
        moved={},
        forced=frozenset(),
        added={},
        dropped=tuple(name for name in left_out if name in rest.former),
        left_out=left_out,
    )


def _routes(tasks, robots, lost, may, done):
    routes = {robot.id: [] for robot in robots}
    team_of = {}
    units = units_of(tasks)
    for unit in dict.fromkeys(units.values()):
        found, why = _teams(unit, {task.id: task for task in tasks}, robots, routes, team_of, may, done)
        if why:
            lost |= dict.fromkeys(unit, why)
            continue
        for name, team in found.items():
            team_of[name] = team
            for robot in team:
                routes[robot].append(name)
    return routes


def _teams(unit, by_id, robots, routes, team_of, may, done):
    """A team for each task of a unit, of different robots; or why there is none."""
    found, busy = {}, set()
    for name in unit:
        task, team = by_id[name], []
        missing = [before for before in task.prerequisites if before not in done and before not in team_of]
        if missing:
            return {}, f"prerequisite: {missing[0]} is not going to be done"
        same = [team_of[other] for other in task.same_robot_as if other in team_of]
        other = {robot for one in task.other_robot_than for robot in team_of.get(one, ())}
        able = [r for r in robots if may(task, r) and r.id not in busy | other and set(task.requires) <= set(r.skills)]
        able = [robot for robot in able if not same or robot.id in same[0]]
        for robot in sorted(able, key=lambda robot: (len(routes[robot.id]), robot.id)):
            before = lacking(task, team)
            if before and lacking(task, [*team, robot]) != before:
                team.append(robot)
        need = lacking(task, team)
        if need or (same and {robot.id for robot in team} != set(same[0])):
            return {}, f"team: {need or 'not the same robots'}"
        found[name] = [robot.id for robot in team]
        busy |= set(found[name])
    return found, ""
