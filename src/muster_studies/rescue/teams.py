"""The teams of the study: the paper's with obstacles, the same with two robots per skill, the richer mission's."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.judging import verify
from muster.planning.solve import solve
from muster.verification import Verdict
from muster_studies.runs import mission_named

ARENA, RICHER = "market-rescue-arena", "market-rescue-20"
PAIRS, POINTS = "two a skill", "two a skill, points"
"""The arena with a second robot of each kind; and the same with robots without bodies, which pass each other."""
SECOND_POSITIONS = {"handBot": (1.0, 1.78), "eyeBot": (0.2, 1.75), "rangeBot": (1.75, 1.75)}
"""Where they start: chosen here."""

BODY_RADIUS_M = 0.065
"""Of a Khepera-III, which is 0.13 m wide. The mission's radii have a margin beside it."""


@cache
def mission_of(team: str) -> Mission:
    """The mission of a team, without events."""
    if team not in (PAIRS, POINTS):
        return mission_named(team)
    arena = mission_named(ARENA)
    second = [replace(robot, id=f"{robot.id}2", position=SECOND_POSITIONS[robot.id]) for robot in arena.robots]
    robots = [replace(robot, radius_m=0.0 if team == POINTS else robot.radius_m) for robot in (*arena.robots, *second)]
    return replace(arena, name=team, robots=tuple(robots))


@cache
def plan_of(team: str, iterations: int) -> Plan:
    """The market's plan for a team, with seed 0."""
    return solve(mission_of(team), "market", iterations=iterations)


@cache
def verdict_of(team: str, iterations: int) -> Verdict:
    """The verdict on that plan."""
    return verify(mission_of(team), plan_of(team, iterations))


def sent(team: str, iterations: int) -> tuple[str, ...]:
    """The robots that have something to do."""
    return tuple(route.robot for route in verdict_of(team, iterations).routes if route.tasks)
