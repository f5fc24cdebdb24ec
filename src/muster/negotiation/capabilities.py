"""What rules of time, teams and relations robots can agree on without a centre; missions with others are refused."""

from __future__ import annotations

from muster.allocation.capabilities import FOR_GOOD, those_that_can
from muster.allocation.problem import Problem
from muster.mission.errors import ParameterError
from muster.mission.model import Mission

AGREED = FOR_GOOD
"""What the auction agrees on."""

CARRIED_OUT = AGREED - {"team", "starts-with"}
"""What of it robots also carry out by themselves: they do not tell each other that all are there."""


def refuse_what_is_not_agreed(problem: Problem, can: frozenset[str]) -> None:
    """Refuse a problem with rules that robots cannot keep without a centre, by a method that keeps some of them.

    Raises
    ------
    ParameterError
        with the keys, their tasks or robots, and what can do all that the problem asks for.
    """
    asked = problem.asked
    lacking = [f"{where} ({word})" for word, where in asked.items() if word not in can]
    if lacking:
        method = ["the method auction"] if asked.keys() <= AGREED else []
        able = " or ".join([*method, f"a plan of {' or '.join(those_that_can(asked)) or 'an allocator that can'}"])
        raise ParameterError(f"robots without a centre cannot agree on {'; '.join(lacking)}; expected {able}")


def refuse_mission(mission: Mission, can: frozenset[str]) -> None:
    """Refuse a mission to be carried out as `refuse_what_is_not_agreed`, also for what its events bring.

    Parameters
    ----------
    can
        what the method agrees on.

    Raises
    ------
    ParameterError
        as there.
    """
    joining = [event.robot_joins for event in mission.events if event.robot_joins is not None]
    new = [event.new_task for event in mission.events if event.new_task is not None]
    whole = mission.at_once(robots=(*mission.robots, *joining), tasks=(*mission.tasks, *new))
    problem = Problem.compile(whole)
    refuse_what_is_not_agreed(problem, can)
    together = [f"{where} ({word})" for word, where in problem.asked.items() if word not in CARRIED_OUT]
    if together:
        raise ParameterError(
            f"robots without a centre agree on {'; '.join(together)}, and do not begin it together; "
            "expected a plan, of muster auction for example"
        )
