"""The state of a mission under way as input of replanning: the remaining problem, and the plan of the whole mission."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from muster.execution.replanning.relations import as_bound, binding_of
from muster.execution.replanning.remaining_problem import RemainingMission, RobotSnapshot
from muster.execution.replanning.transports import deliveries_aboard, load_after_work, on_board, transports
from muster.execution.replanning.travel import Spot
from muster.execution.replanning.worthwhile import NEARLY_THERE_S, Heading
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.station_calls import with_calls
from muster.execution.stations.slots import AT_STATION, Stations
from muster.execution.stations.station_service import to_add
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Reason, Route, RouteStop, Unassigned
from muster.mission.value_types import shown
from muster.model.energy_under_way import Held
from muster.model.measured_energy import EnergyLeft
from muster.model.under_way import UnderWay
from muster.state.goods_ledger import GoodsLedger
from muster.state.task_ledger import Ledger


@dataclass(frozen=True)
class Part:
    """Some robots, with all tasks of their routes and some tasks that no robot has."""

    robots: Collection[str]
    tasks: Collection[str]


def required_routes(mission: Mission, plan: Plan) -> dict[str, tuple[RouteStop, ...]]:
    """The routes of a plan that the mission can have, with the stations on them, and what these add.

    Raises
    ------
    ParameterError
        for robots and tasks that there are not, or that stand twice.
    """
    robots = {robot.id for robot in mission.robots}
    model = UnderWay(mission, mission.tasks, plan.ignored)
    tasks = {task.id: model.is_for_team(task.id) for task in mission.tasks}
    seen: set[str] = set()
    stations = {station.id for station in mission.stations}
    routes: dict[str, tuple[RouteStop, ...]] = {}
    for route in plan.routes:
        if route.robot not in robots or route.robot in routes:
            raise ParameterError(f"plan: robot {shown(route.robot)}; expected each robot of the mission at most once")
        for name in route.tasks:
            if name in stations:
                continue
            if name not in tasks or (name in seen and not tasks[name]) or route.tasks.count(name) > 1:
                raise ParameterError(f"plan: task {shown(name)}; expected each task of the mission at most once")
            seen.add(name)
        told = route.stops if tuple(stop.name for stop in route.stops) == route.tasks else ()
        routes[route.robot] = told or tuple(RouteStop(n, 0.0, 0.0, 0.0, n in stations) for n in route.tasks)
    return routes


def remaining_mission_of(
    mission: Mission,
    plan: Plan,
    crew: Mapping[str, RobotState],
    ledger: Ledger,
    now: float,
    stations: Stations,
    goods: GoodsLedger,
    *,
    on_duty: bool = False,
    part: Part | None = None,
) -> RemainingMission:
    """What is left of the mission, or of a part of it."""
    present = [state for state in crew.values() if not state.out and (part is None or state.robot.id in part.robots)]
    at_work = {state.route[0]: now + state.work_left_s(now) for state in present if state.activity is Activity.WORKING}
    under_way, ends_s = at_work.keys(), {**ledger.ends_s, **at_work}
    open_tasks = ledger.open if part is None else [ledger.tasks[name] for name in part.tasks]
    left = [task for task in open_tasks if task.id not in under_way]
    robots = {robot.id: robot for robot in mission.robots}  # also those that have an executor of their own
    robots |= {name: state.robot for name, state in crew.items()}
    here = crew.values() if part is None else present  # those that are out had tasks, too
    bindings = {task.id: binding_of(task.id, ledger, under_way, robots) for task in left}
    carried = on_board(crew, ledger, goods)
    transported, nowhere = transports(left, carried, ledger)
    return RemainingMission(
        mission=mission,
        ignored=plan.ignored,
        now_s=now,
        crew=[
            _snapshot(state, now, stations, load_after_work(state, ledger, goods), _done(state, ledger))
            for state in present
        ],
        tasks=[as_bound(task, bindings[task.id], ledger, ends_s) for task in transported],
        ended=ledger.ends_s.keys(),
        delays_s=ledger.delays_s,
        refusals=ledger.refusals,
        routes={state.robot.id: [name for name in state.route if name not in under_way] for state in present},
        former={name: ", ".join(robots) for name, robots in _former(here, under_way).items()},
        bindings=bindings,
        expired={**ledger.barred, **nowhere},
        stations=stations.working,
        aboard=deliveries_aboard(left, carried),
        objective=plan.objective,
        on_duty=on_duty,
    )


def _former(crew: Iterable[RobotState], under_way: Collection[str]) -> dict[str, list[str]]:
    """For each task of a route the robots that were to do it."""
    former: dict[str, list[str]] = {}
    for state in crew:
        for name in state.route:
            if name not in under_way:
                former.setdefault(name, []).append(state.robot.id)
    return former


def _done(state: RobotState, ledger: Ledger) -> tuple[Task, ...]:
    """What a robot has done when its work under way is done."""
    under_way = state.route[:1] if state.activity is Activity.WORKING else []
    return tuple(ledger.tasks[name] for name in (*state.done, *under_way) if name in ledger.tasks)


def _snapshot(
    state: RobotState, now: float, stations: Stations, load: Mapping[str, float], done: tuple[Task, ...]
) -> RobotSnapshot:
    works = state.activity is Activity.WORKING
    point = state.work.exit if works and state.work is not None else state.position
    at_task = state.activity in (Activity.WORKING, Activity.DRIVING, Activity.WAITING)
    before = state.done[-1] if state.done and not state.at_home else state.robot.id
    if state.activity in AT_STATION:
        before = state.station
    return RobotSnapshot(
        robot=_with_capacity(state.robot, state.capacity),
        home=state.home,
        spot=Spot(point, state.route[0] if at_task else before, point if works else state.refuge),
        free_s=now + state.work_left_s(now) + state.service_left_s(now),
        used=state.used_after(now) if works else state.used,
        task=state.route[0] if works else None,
        measured=_measured(state),
        energy=_held(state, now, stations),
        load=load,
        done=done,
        left_s=state.known.left_s,
        limits=state.limits,
        heading=_heading(state),
    )


def _heading(state: RobotState) -> Heading | None:
    """The task that a robot is on the way to, or waits at."""
    waits = state.activity is Activity.WAITING
    if not state.route or not (waits or state.activity is Activity.DRIVING):
        return None
    return Heading(state.route[0], waits or state.travel_left_s <= NEARLY_THERE_S)


def _held(state: RobotState, now: float, stations: Stations) -> Held | None:
    """What a robot holds when the work or service under way is over."""
    energy, works = state.energy, state.activity is Activity.WORKING
    if energy is None:
        return None
    used = state.used_after(now) if works else state.used
    served = to_add(stations, state) if state.activity is Activity.SERVED else 0.0
    return Held(energy.level + served - energy.drain * (used - state.used), energy.drain, used)


def _with_capacity(robot: Robot, capacity: float | None) -> Robot:
    return robot if robot.work_capacity == capacity else robot.changed(work_capacity=capacity)


def _measured(state: RobotState) -> EnergyLeft | None:
    if state.told_share is None:
        return None
    most = state.robot.work_capacity if state.energy is None else state.energy.capacity
    return EnergyLeft(left=state.told_share, used=state.used, capacity=math.inf if most is None else most)


def whole_plan(
    mission: Mission, plan: Plan, crew: Mapping[str, RobotState], ledger: Ledger, left_out: Mapping[str, str]
) -> Plan:
    """The plan of the whole mission, what is done included; without figures."""
    routes = tuple(
        Route(state.robot.id, (*state.known.stops, *(with_calls(state.route, state.calls) if not state.out else ())))
        for state in crew.values()
    )
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
