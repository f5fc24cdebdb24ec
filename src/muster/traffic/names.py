"""Names of the ways in which traffic is managed, and which missions have whose. No heavy module is imported."""

from __future__ import annotations

from typing import TYPE_CHECKING

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.motion.avoidance_names import AUTO as ANY_AVOIDANCE
from muster.motion.laws import PROFILE

if TYPE_CHECKING:
    from muster.mission.model import Mission, Robot

AUTO, FREE, RESERVE = TRAFFIC = ("auto", "free", "reserve")
"""`reserve` where robots can jam, close others out, or are faster so, else `free`; as robots meet; in the order of one
plan for all."""
DEFAULT = AUTO


def of_run(traffic: str, *, avoidance: str = ANY_AVOIDANCE, law: str = PROFILE) -> str:
    """`free` for `auto` where a method of avoidance is asked for, or a law by which robots leave straight ways."""
    return FREE if traffic == AUTO and (avoidance != ANY_AVOIDANCE or law != PROFILE) else traffic


def drives(robot: Robot) -> bool:
    """Whether a robot takes part in traffic."""
    return robot.kind == "ground" and robot.radius_m > 0


def may_reserve(traffic: str, mission: Mission) -> bool:
    """Whether robots of a mission can pass by reservation; with `auto` its roadmap tells the rest.

    Given lanes lead a single robot too.

    Raises
    ------
    ParameterError
        if there is no traffic of that name, or `reserve` is asked for where no two robots drive.
    """
    if traffic not in TRAFFIC:
        expected = f"{', '.join(TRAFFIC)}{did_you_mean(str(traffic), TRAFFIC)}"
        raise ParameterError(f"traffic: {shown(traffic)}; expected {expected}")
    driving = sum(map(drives, mission.all_robots))
    enough = driving >= 2 or (driving == 1 and mission.driven_lanes is not None)
    if traffic == RESERVE and not enough:
        reason = "fewer than two robots of kind ground have a radius above 0"
        raise ParameterError(f"traffic: {traffic}; expected free: {reason}")
    has_roadmap = traffic == RESERVE or mission.driven_lanes is not None or mission.travel_off_lanes == "map"
    return traffic != FREE and enough and has_roadmap
