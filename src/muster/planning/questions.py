"""What can be done of a mission, and why a plan is as it is: the functions `check` and `explain` of the package."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any, overload

from muster.mission.ignorable_rules import ignored_rules
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_of
from muster.planning.request import require_mission

if TYPE_CHECKING:
    from muster.planning.explaining import LeftOut, OneTask, Possible

GivenPlan = Plan | Mapping[str, Any]


def check(mission: Mission, *, ignore: str | Collection[str] = (), time_limit: float | None = 2.0) -> Possible:
    """Find the tasks of a mission that can never be done, and whether one plan can do all others.

    Parameters
    ----------
    ignore
        rules that do not hold.
    time_limit
        seconds for finding out whether all others can be done in one plan; None: that stays unknown.

    Raises
    ------
    MissionError, NotSupportedError
        if the mission cannot be planned at all, or its map is wrong.
    """
    from muster.planning.explaining import possible

    require_mission(mission)
    return possible(mission, ignored=ignored_rules(ignore), time_limit=time_limit)


@overload
def explain(
    mission: Mission,
    plan: GivenPlan,
    task: None = None,
    *,
    ignore: str | Collection[str] = (),
    time_limit: float | None = 10.0,
) -> LeftOut: ...


@overload
def explain(
    mission: Mission,
    plan: GivenPlan,
    task: str,
    *,
    ignore: str | Collection[str] = (),
    time_limit: float | None = 10.0,
) -> OneTask: ...


def explain(
    mission: Mission,
    plan: GivenPlan,
    task: str | None = None,
    *,
    ignore: str | Collection[str] = (),
    time_limit: float | None = 10.0,
) -> LeftOut | OneTask:
    """Explain why tasks are left out of a plan; or why a task is done by this robot and not by another.

    Parameters
    ----------
    plan
        a plan; or a mapping, as for `verify`.
    task
        the id of one task; None: all that are left out.
    ignore
        rules that do not hold.
    time_limit
        seconds after which nothing more is looked for (`cut_short`); None: no limit.

    Raises
    ------
    ParameterError
        if the mission has no such task, or the plan is none.
    PlanError
        if the plan is not one of this mission, or a mapping is no plan.
    """
    from muster.allocation.stop import Stop
    from muster.planning.explaining import left_out, one_task, require_fit

    require_mission(mission)
    stop = Stop(time_limit=time_limit)
    ignored = ignored_rules(ignore)
    explained = plan_of(plan)
    require_fit(mission, explained, "<plan>", ignored)
    if task is None:
        return left_out(mission, explained, ignored, stop)
    return one_task(mission, explained, task, ignored, stop)
