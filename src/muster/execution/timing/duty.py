"""When robots may drive and work: within their shifts, and for no longer than a duty lasts at the most."""

from __future__ import annotations

import math

from muster.execution.robots.robot_state import RobotState


def over_by_s(state: RobotState, leaves_s: float = math.inf) -> float:
    """When a robot has to be at the end of its route, by its longest duty; inf: whenever. It leaves, if it has not."""
    longest, left = state.robot.longest_duty_s, state.known.left_s
    return math.inf if longest is None else (leaves_s if left is None else left) + longest


def back_s(state: RobotState, free_s: float, home_s: float) -> float:
    """When a robot that is free at a time is at the end of its route, so many seconds away; inf: never."""
    return state.robot.set_out(free_s, home_s) + home_s if home_s else free_s
