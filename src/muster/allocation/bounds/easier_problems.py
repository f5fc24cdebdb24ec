"""Problems whose least objective is no greater than that of another: of time alone, with routes that end anywhere."""

from __future__ import annotations

from dataclasses import replace

from muster.model.problem import Problem


def in_time(problem: Problem) -> Problem:
    """The problem whose usage is time; its capacities mean nothing."""
    return replace(problem, mission=replace(problem.mission, rules=replace(problem.mission.rules, usage="time")))


def opened(problem: Problem) -> Problem:
    """The problem whose routes may end anywhere."""
    robots = tuple(replace(robot, return_to_start=False, end_position=None) for robot in problem.robots)
    return replace(problem, robots=robots)
