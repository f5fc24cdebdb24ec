"""What robots cannot agree on without a centre: rules of time, teams and relations. Such missions are refused.

Bids and the base of an epoch respect routes, capacities and the order of prerequisites. They do not keep the times of
other robots, which windows, lags and teams depend on; so a plan with such rules could be wrong.
"""

from __future__ import annotations

from muster.allocation.capabilities import required
from muster.allocation.problem import Problem
from muster.allocation.registry import ALLOCATORS
from muster.mission.errors import ParameterError
from muster.mission.model import Mission


def refuse_what_is_not_agreed(problem: Problem) -> None:
    """Refuse a problem with rules that robots cannot keep without a centre.

    Raises
    ------
    ParameterError
        with the keys, their tasks or robots, and the central allocators that can do all that the problem asks for.
    """
    asked = required(problem)
    if asked:
        places = "; ".join(f"{where} ({word})" for word, where in asked.items())
        usable = ALLOCATORS.usable().items()
        able = " or ".join(name for name, allocator in usable if asked.keys() <= allocator.can)
        raise ParameterError(
            f"robots without a centre cannot agree on {places}; expected a plan of {able or 'an allocator that can'}"
        )


def refuse_mission(mission: Mission) -> None:
    """Refuse a mission as `refuse_what_is_not_agreed`, also for robots and tasks that its events bring.

    Raises
    ------
    ParameterError
        as there.
    """
    joining = [event.robot_joins for event in mission.events if event.robot_joins is not None]
    new = [event.new_task for event in mission.events if event.new_task is not None]
    whole = mission.at_once(robots=(*mission.robots, *joining), tasks=(*mission.tasks, *new))
    refuse_what_is_not_agreed(Problem.compile(whole))
