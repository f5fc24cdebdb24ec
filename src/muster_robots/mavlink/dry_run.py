"""The way points that would be sent if all went as planned, checked against the fence."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan
from muster.motion.port import Waypoint
from muster_robots.mavlink.fleet import MavlinkFleet
from muster_robots.mavlink.frames import DEGREES_E7
from muster_robots.mavlink.planned_legs import Way, order_of
from muster_robots.mavlink.session import Session


@dataclass(frozen=True)
class Line:
    """One way point: degrees (None in a mission without an origin), metres above home, seconds."""

    robot: str
    task: str
    lat_deg: float | None
    lon_deg: float | None
    above_home_m: float
    hold_s: float

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def lines_of(mission: Mission, plan: Plan, fleet: MavlinkFleet, way: Way) -> list[Line]:
    """Every way point of a plan, robot by robot: of works, and around zones on the way there and in between.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, or a way point lies outside the fence.
    """
    tasks, robots = {task.id: task for task in mission.tasks}, {robot.id: robot for robot in mission.robots}
    lines: list[Line] = []
    for route in plan.routes:
        for name in route.tasks:
            if route.robot not in robots or name not in tasks:
                raise ParameterError(f"plan: {route.robot} does {name}; expected robots and tasks of the mission")
        if route.tasks:
            lines += _route(robots[route.robot], [tasks[name] for name in route.tasks], fleet, way)
    return lines


def _route(robot: Robot, tasks: Sequence[Task], fleet: MavlinkFleet, way: Way) -> Iterator[Line]:
    session = fleet.sessions[robot.id]
    here = session.drone.telemetry.start
    for task in tasks:
        order = order_of(task, robot, here, way)
        if isinstance(order, str):
            raise ParameterError(f"plan: {robot.id} does {task.id}; {order}")
        here = order[-1].position
        flown = session.drone.flown(order)
        refusal = session.fence(flown[0].position, flown)
        if refusal:
            raise ParameterError(f"{robot.id}: task {task.id}: {refusal}")
        yield from (_line(robot.id, task.id, waypoint, session) for waypoint in flown)


def _line(robot: str, task: str, waypoint: Waypoint, session: Session) -> Line:
    earth = session.drone.telemetry.earth
    if earth is None:
        return Line(robot, task, None, None, waypoint.position[2] - session.drone.telemetry.start[2], waypoint.hold_s)
    lat, lon, above = earth.to_drone(waypoint.position)
    return Line(robot, task, lat / DEGREES_E7, lon / DEGREES_E7, above, waypoint.hold_s)
