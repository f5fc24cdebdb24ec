"""The situation while a mission is carried out, as planning needs it: the rest, and the plan of the whole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from muster.execution.remaining_problem import Rest, Standing
from muster.execution.robot_state import Activity, Hand
from muster.execution.task_ledger import Ledger
from muster.execution.travel import Spot
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, Reason, Route, Unassigned
from muster.mission.value_types import shown


def required_routes(mission: Mission, plan: Plan) -> dict[str, tuple[str, ...]]:
    """The routes of a plan that the mission can have.

    Raises
    ------
    ParameterError
        for robots and tasks that there are not, or that stand twice.
    """
    robots, tasks = {robot.id for robot in mission.robots}, {task.id for task in mission.tasks}
    routes: dict[str, tuple[str, ...]] = {}
    for route in plan.routes:
        if route.robot not in robots or route.robot in routes:
            raise ParameterError(f"plan: robot {shown(route.robot)}; expected each robot of the mission at most once")
        for name in route.tasks:
            if name not in tasks:
                raise ParameterError(f"plan: task {shown(name)}; expected each task of the mission at most once")
            tasks.remove(name)
        routes[route.robot] = route.tasks
    return routes


def rest_of(mission: Mission, plan: Plan, crew: Mapping[str, Hand], ledger: Ledger, now: float) -> Rest:
    """What is left of the mission."""
    present = [hand for hand in crew.values() if not hand.out]
    under_way = {hand.route[0]: hand for hand in present if hand.activity is Activity.WORKING}
    return Rest(
        mission=mission,
        ignored=plan.ignored,
        now_s=now,
        crew=[_standing(hand, now) for hand in present],
        tasks=[task for task in ledger.open if task.id not in under_way],
        ended=ledger.ends_s.keys(),
        delays_s=ledger.delays_s,
        refusals=ledger.refusals,
        routes={hand.robot.id: [name for name in hand.route if name not in under_way] for hand in present},
        former={name: hand.robot.id for hand in crew.values() for name in hand.route if name not in under_way},
    )


def _standing(hand: Hand, now: float) -> Standing:
    works = hand.activity is Activity.WORKING
    point = hand.work.exit if works and hand.work is not None else hand.position
    at_task = hand.activity in (Activity.WORKING, Activity.DRIVING, Activity.WAITING)
    before = hand.done[-1] if hand.done and not hand.at_home else hand.robot.id
    return Standing(
        robot=replace(hand.robot, work_capacity=hand.capacity),
        home=hand.home,
        spot=Spot(point, hand.route[0] if at_task else before, point if works else hand.refuge),
        free_s=now + hand.work_left_s(now),
        used=hand.used_after(now) if works else hand.used,
        task=hand.route[0] if works else None,
    )


def whole_plan(
    mission: Mission, plan: Plan, crew: Mapping[str, Hand], ledger: Ledger, left_out: Mapping[str, str]
) -> Plan:
    """The plan of the whole mission, what is done included; without figures."""
    routes = tuple(Route(hand.robot.id, (*hand.done, *(hand.route if not hand.out else ()))) for hand in crew.values())
    there = {name for route in routes for name in route.tasks}
    return Plan(
        mission=mission.name,
        allocator=plan.allocator,
        ignored=plan.ignored,
        objective=plan.objective,
        routes=routes,
        unassigned=tuple(
            Unassigned(name, (Reason("", "not-chosen", left_out.get(name, "cancelled")),))
            for name in ledger.tasks
            if name not in there
        ),
    )
