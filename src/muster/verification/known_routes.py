"""The part of a plan's routes whose robots and tasks exist and do not repeat."""

from __future__ import annotations

from muster.mission.model import Mission, Task
from muster.mission.plan import Plan
from muster.verification.verdict import Violation


def other_mission(mission: Mission, plan: Plan) -> list[Violation]:
    """A violation if the plan names another mission; a plan that names none, as from elsewhere, is taken as of this."""
    if plan.mission in (None, mission.name):
        return []
    return [Violation("mission", None, None, f"the plan is of {plan.mission}; expected {mission.name}, or no name")]


def known_routes(mission: Mission, plan: Plan, teams: bool) -> tuple[dict[str, list[Task]], list[Violation]]:
    """Take from the plan what exists and does not repeat: each robot's tasks; and a violation for all else.

    With `teams` a task for a team may stand in several routes, once in each.
    """
    violations: list[Violation] = []
    robots = {robot.id for robot in mission.robots}
    tasks = {task.id: task for task in mission.tasks}
    routes: dict[str, list[Task]] = {}
    robot_of: dict[str, str] = {}
    for route in plan.routes:
        if route.robot not in robots:
            violations.append(Violation("unknown-robot", route.robot, None, "no robot of the mission; route left out"))
            continue
        if route.robot in routes:
            violations.append(
                Violation("repeated-robot", route.robot, None, "a further route of this robot; route left out")
            )
            continue
        known = routes[route.robot] = []
        for name in route.tasks:
            if name not in tasks:
                violations.append(Violation("unknown-task", route.robot, name, "no task of the mission"))
            elif name in robot_of and not (teams and tasks[name].is_for_team and tasks[name] not in known):
                detail = f"already in the route of {robot_of[name]}"
                violations.append(Violation("repeated-task", route.robot, name, detail))
            else:
                robot_of[name] = route.robot
                known.append(tasks[name])
    return routes, violations
