"""Which rules a plan breaks: DESIGN section 4, [tcf-thesis] (3.14)-(3.16)."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan
from muster.motion.actions import Impossible
from muster.verification.measure import MeasuredRoute
from muster.verification.travel import doing_at
from muster.verification.verdict import Violation

CAPACITY_TOLERANCE = 1e-9
"""Relative. A route that fills its capacity exactly may come out above it, the order of additions being free."""


def known_routes(mission: Mission, plan: Plan) -> tuple[dict[str, list[Task]], list[Violation]]:
    """Take from the plan what exists and does not repeat: each robot's tasks; and a violation for all else."""
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
            elif name in robot_of:
                detail = f"already in the route of {robot_of[name]}"
                violations.append(Violation("repeated-task", route.robot, name, detail))
            else:
                robot_of[name] = route.robot
                known.append(tasks[name])
    return routes, violations


def broken_rules(
    mission: Mission, ignored: Collection[str], routes: Sequence[MeasuredRoute], unit: str, tolerance: float
) -> Iterator[Violation]:
    """Find every broken rule, robot by robot in the order of the routes; deadlocks are for the schedule to find.

    `tolerance` is that of travel, relative.
    """
    done = {step.task.id for route in routes for step in route.steps}
    for route in routes:
        for step in route.steps:
            yield from _pair(mission, ignored, route.robot, step.task)
            if "prerequisite" not in ignored:
                yield from _missing_prerequisites(route.robot, step.task, done)
        yield from _unreachable(route)
        yield from _above_capacity(mission, ignored, route, unit, max(CAPACITY_TOLERANCE, tolerance))


def _pair(mission: Mission, ignored: Collection[str], robot: Robot, task: Task) -> Iterator[Violation]:
    """Check the rules on who may do what; suitability is [tcf-thesis] (3.15)."""
    if "skill" not in ignored:
        lacking = [skill for skill in task.requires if skill not in robot.skills]
        if lacking:
            yield Violation("skill", robot.id, task.id, f"the robot lacks {', '.join(lacking)}")
    doing = doing_at(robot, task)
    if isinstance(doing, Impossible):  # whatever is ignored: there is nothing that it could do
        yield Violation("skill", robot.id, task.id, doing.reason)
    if mission.suitability is not None and "suitability" not in ignored:
        assert robot.type is not None  # where there is a table, every robot and task has a type
        assert task.type is not None
        score, least = mission.suitability[robot.type].get(task.type, 0.0), mission.rules.min_suitability
        if score < least:
            detail = f"{robot.type} scores {score:g} for {task.type}, at least {least:g} is needed"
            yield Violation("suitability", robot.id, task.id, detail)
    if "lock" not in ignored and task.only_robots is not None and robot.id not in task.only_robots:
        yield Violation("lock", robot.id, task.id, f"only for {', '.join(task.only_robots)}")


def _missing_prerequisites(robot: Robot, task: Task, done: set[str]) -> Iterator[Violation]:
    """Check [tcf-thesis] (3.16)."""
    for name in task.prerequisites:
        if name not in done:
            yield Violation("prerequisite", robot.id, task.id, f"its prerequisite {name} is not in the plan")


def _unreachable(route: MeasuredRoute) -> Iterator[Violation]:
    here = "its start"
    for step in route.steps:
        if not step.leg.exists:
            yield Violation("unreachable", route.robot.id, step.task.id, f"no way from {here}")
        if not step.passable:
            geometry = step.task.action is not None and step.task.action.has_geometry
            way = "along the way points of its action" if geometry else "from its entry to its exit"
            yield Violation("unreachable", route.robot.id, step.task.id, f"no way {way}")
        here = f"task {step.task.id}"
    if route.last_leg is not None and not route.last_leg.exists:
        yield Violation("unreachable", route.robot.id, None, f"no way from {here} to where the route must end")


def capacity_of(mission: Mission, ignored: Collection[str], robot: Robot) -> float | None:
    """Return what the robot may use, in the unit of usage; None where it is unlimited or the rule is ignored."""
    if robot.work_capacity is None or "capacity" in ignored:
        return None
    return (1 - mission.rules.capacity_reserve) * robot.work_capacity


def _above_capacity(
    mission: Mission, ignored: Collection[str], route: MeasuredRoute, unit: str, tolerance: float
) -> Iterator[Violation]:
    """Check [tcf-thesis] (3.14)."""
    capacity = capacity_of(mission, ignored, route.robot)
    if capacity is not None and route.usage > capacity * (1 + tolerance):
        detail = f"usage {route.usage:.10g} {unit}, at most {capacity:.10g} {unit}"
        yield Violation("capacity", route.robot.id, None, detail)
