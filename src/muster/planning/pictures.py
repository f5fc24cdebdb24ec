"""Pictures of plans, each judged first. Matplotlib is imported where a picture is made."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_of
from muster.planning.judging import verify

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot(mission: Mission, plan: Plan | Mapping[str, Any], *, ax: Axes | None = None) -> Axes:
    """Draw the routes of a plan. Needs the extra `plot`.

    Parameters
    ----------
    plan
        a plan, or a mapping as `verify` takes it.
    ax
        axes to draw on; without them a new figure is made, which notebooks show.

    Returns
    -------
    The axes; `axes.figure.savefig(path)` writes the picture.
    """
    from muster.report import plot_routes

    plan = plan_of(plan)
    return plot_routes(mission, plan, verify(mission, plan, plan.ignored, plan.objective), ax=ax)


def gantt(mission: Mission, plan: Plan | Mapping[str, Any], *, ax: Axes | None = None) -> Axes:
    """Draw when each robot travels, works and waits. Needs the extra `plot`; parameters as for `plot`.

    Raises
    ------
    MusterError
        if the plan has no schedule because tasks wait for each other.
    """
    from muster.report import plot_gantt

    plan = plan_of(plan)
    return plot_gantt(mission, verify(mission, plan, plan.ignored, plan.objective), ax=ax)
