"""Plans side by side in one figure: their routes from above or in space, or places without routes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.report import plot_routes
from muster.report.figures.canvas import named_rows, new_figure
from muster.report.figures.styles import TEXT
from muster.verification import Verdict, verify

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH_IN, _LEGEND_IN, _HEIGHT_IN = 5.0, 2.4, 5.4


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanPanel:
    """One plan of a figure.

    Parameters
    ----------
    title
        above the panel: the letter of the print, and what is seen.
    ignored
        rules that do not hold for the plan.
    spatial
        seen in space rather than from above.
    elev, azim
        degrees, from where a panel in space is seen.
    draw
        draws on the axes in place of the routes, where given.
    """

    title: str
    mission: Mission
    plan: Plan
    ignored: tuple[str, ...] = ()
    spatial: bool = False
    elev: float = 25.0
    azim: float = -60.0
    draw: Callable[[Axes], Any] | None = None

    @property
    def verdict(self) -> Verdict:
        return verify(self.mission, self.plan, ignore=self.ignored)


def plan_figure(panels: Sequence[PlanPanel], columns: int = 3, scale: float = 1.0) -> Figure:
    """Draw plans side by side, `columns` in a row, panels `scale` times as large as usual.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    robots = max(len(panel.mission.robots) for panel in panels)
    height = max(scale * _HEIGHT_IN, 0.19 * (named_rows(robots) + 6) + 1.0)
    figure = new_figure((scale * _WIDTH_IN + _LEGEND_IN) * columns, height * rows)
    parts: Any = figure.subfigures(rows, columns, squeeze=False)
    for part, panel in zip(parts.ravel(), panels, strict=False):
        ax = part.add_subplot(projection="3d" if panel.spatial else None)
        if panel.spatial:
            ax.view_init(elev=panel.elev, azim=panel.azim)
        if panel.draw is None:
            plot_routes(panel.mission, panel.plan, panel.verdict, ax=ax)
        else:
            panel.draw(ax)
        part.suptitle(panel.title, fontsize=11, fontweight="bold", color=TEXT, x=0.02, ha="left")
    return figure
