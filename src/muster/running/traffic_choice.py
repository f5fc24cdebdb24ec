"""Which manager steers the traffic of a run: by the option, and by what else is asked of the run."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.avoidance_names import AUTO as ANY_AVOIDANCE
from muster.motion.laws import PROFILE
from muster.motion.map_world import World
from muster.traffic.journeys.forecast import forecast, is_forecast
from muster.traffic.manager import TrafficManager
from muster.traffic.managers import manager_named
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.names import RESERVE, of_run
from muster.traffic.roadmaps.roadmap import MARGIN_M

LOOSE_MARGIN_M = 0.1
"""What robots keep between them that do not drive exactly as told, or do not know exactly where they are."""
FORECAST_ERRS = 1.2
"""By how many times traffic by reservation may take longer than its forecast."""

FreeTraffic = Callable[[Plan, float], float]
"""Seconds that a plan takes in free traffic, inf if not all is done well within the seconds given."""


def manager_for(
    traffic: str,
    mission: Mission,
    *,
    seed: int = 0,
    avoidance: str = ANY_AVOIDANCE,
    law: str = PROFILE,
    exact: bool = False,
    world: World | None = None,
    real: bool = False,
    in_thread: bool = False,
    plan: Plan | None = None,
    free_s: FreeTraffic | None = None,
) -> TrafficManager | None:
    """The manager of a run's traffic; None where robots pass each other as they meet.

    `auto` leaves traffic free where a method of avoidance is asked for, or a law by which robots leave straight ways.

    Parameters
    ----------
    exact
        whether robots drive exactly as told, and know where they are.
    real
        whether they are real: each order costs them time.
    in_thread
        whether time goes on while traffic is planned.
    world
        of the mission, where it is at hand.
    plan, free_s
        which plan is carried out, and how long it takes in free traffic: then `auto` is by reservation also where
        robots have room to pass each other, if that is faster.

    Raises
    ------
    ParameterError
        if reservation is asked for robots that leave straight ways; and as `manager_named`.
    """
    if law != PROFILE and traffic == RESERVE:
        raise ParameterError(f"traffic: {traffic}; expected free: by law {law} robots leave straight ways")
    chosen = of_run(traffic, avoidance=avoidance, law=law)
    margin_m = MARGIN_M if exact else LOOSE_MARGIN_M
    named = partial(
        manager_named, chosen, mission, seed, world=world, margin_m=margin_m, real=real, in_thread=in_thread
    )
    if plan is None or free_s is None:
        return named()
    return named(is_faster=partial(_is_faster, mission, plan, free_s))


def _is_faster(mission: Mission, plan: Plan, free_s: FreeTraffic, made: MissionRoadmap) -> bool:
    """Whether robots are faster by reservation than in free traffic, by forecasts of both."""
    if not is_forecast(mission, made.roadmap) or any(len(route.stops) != len(route.tasks) for route in plan.routes):
        return False
    reserved_s = forecast(mission, {route.robot: route.stops for route in plan.routes}, made.plan()).with_traffic_s
    if reserved_s is None:
        return False
    at_most_s = FORECAST_ERRS * reserved_s
    return at_most_s < free_s(plan, at_most_s)
