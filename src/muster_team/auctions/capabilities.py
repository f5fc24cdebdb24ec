"""What rules of time, teams and relations robots can agree on without a centre; missions with others are refused."""

from __future__ import annotations

from collections.abc import Sequence

from muster.allocation.capabilities import FOR_GOOD, those_that_can
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Task
from muster.model.problem import Problem
from muster_team.knowledge.rules import joint_among

AGREED = FOR_GOOD - {"load", "battery", "rests", "duty", "either-or"}
"""What the auction agrees on: without a centre nobody shares out the slots of stations, or knows what lies where.

Nor do robots agree on a begin that their rests allow, leave late for each other, or drop what is done in another way.
"""


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
    new = [event.new_task for event in mission.events if event.new_task is not None]
    whole = mission.at_once(robots=mission.all_robots, tasks=(*mission.tasks, *new))
    problem = Problem.compile(whole)
    refuse_what_is_not_agreed(problem, can)
    refuse_once_together(problem.tasks, (problem.holds("team"), problem.holds("relation")))


def refuse_once_together(tasks: Sequence[Task], tied: tuple[bool, bool], given: Sequence[Task] = ()) -> None:
    """Refuse tasks that several robots begin and that must not be begun twice: a team begins again after a fault.

    Parameters
    ----------
    tied
        whether teams, and whether relations, hold.
    given
        tasks that there were before; where they are wrong themselves, only what others add to that is refused.

    Raises
    ------
    ParameterError
        with the tasks.
    """
    joint, before = joint_among(tasks, tied), joint_among(given, tied)
    once = [t.id for t in tasks if t.id in joint - before and t.across_partition == "at-most-once"]
    if once:
        raise ParameterError(
            f"across_partition: at-most-once of {', '.join(once)}; expected at-least-once for tasks that several "
            "robots begin together without a centre, as they begin again when one of them fails"
        )
