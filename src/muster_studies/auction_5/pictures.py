"""Figures 5.1 to 5.23: drones in the physics world, their paths from above and in space, places of a scenario."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Mission, Robot, Task
from muster.report.figures.canvas import new_figure, quiet_frame
from muster.report.figures.styles import ALARM, QUIET_TEXT, TEXT
from muster_studies.auction_5.auctions import PUBLISHED_NAMES, Auction, AuctionResult, hold
from muster_studies.descriptions import captioned
from muster_studies.effort import Effort
from muster_studies.plan_pictures import PlanPanel, plan_figure
from muster_studies.runs import mission_named
from muster_studies.world_pictures import world_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SEEN_FROM = ((25.0, -60.0), (20.0, 30.0), (60.0, -60.0))
"""Elevations and azimuths, degrees: where the print has several views of the same paths."""


@dataclass(frozen=True)
class _Scenario:
    number: int
    mission: str
    placement: str

    def auction(self, bid: str) -> Auction:
        rule = "average-as-printed" if bid == "average" else bid
        return Auction(mission=self.mission, bid=rule, placement=self.placement)

    def paths(self, bid: str, spatial: bool, seen_from: int, effort: Effort) -> Figure:
        elev, azim = _SEEN_FROM[seen_from]
        mission, plan = mission_named(self.mission), _held(self.auction(bid)).plan
        title = f"Scenario {self.number}, {PUBLISHED_NAMES[bid]}"
        return plan_figure(
            [PlanPanel(title=title, mission=mission, plan=plan, spatial=spatial, elev=elev, azim=azim)], scale=1.3
        )

    def world(self, at_s: float, effort: Effort) -> Figure:
        mission, plan = mission_named(self.mission), _held(self.auction("total")).plan
        return world_figure(mission, plan, f"Scenario {self.number} in the physics world after {at_s:g} s", at_s=at_s)

    def places(self, drones: bool, tasks: bool, effort: Effort) -> Figure:
        return _places(mission_named(self.mission), drones, tasks)


@cache
def _held(auction: Auction) -> AuctionResult:
    return hold(auction)


def _places(mission: Mission, drones: bool, tasks: bool) -> Figure:
    """The places of drones, of tasks, or of both, from above and in space."""
    figure = new_figure(13.0, 6.0)
    marks: list[tuple[str, str, Sequence[Robot | Task], str]] = []
    if drones:
        marks.append(("s", TEXT, mission.robots, "drone"))
    if tasks:
        marks.append(("o", ALARM, mission.tasks, "task"))
    for k, projection in enumerate((None, "3d")):
        ax: Any = figure.add_subplot(1, 2, k + 1, projection=projection)
        for mark, color, things, label in marks:
            where = np.array([thing.position for thing in things])[:, : 2 + k]
            ax.plot(*where.T, mark, color=color, markersize=5, label=label, linestyle="none")
            for thing, place in zip(things, where, strict=True):
                name = thing.id.removeprefix("firefly").removeprefix("task")
                ax.text(*place, f" {name}", fontsize=7, color=QUIET_TEXT)
        ax.set_xlabel("x [m]")
        ax.set_ylabel("y [m]")
        if k:
            ax.set_zlabel("z [m]")
            ax.set_box_aspect(np.ptp([*ax.get_xlim3d(), *ax.get_ylim3d()]) * np.array([1.0, 1.0, 0.5]))
        else:
            ax.set_aspect("equal", adjustable="datalim")
            ax.legend(loc="best", fontsize=8, frameon=False)
            quiet_frame(ax)
    figure.suptitle(mission.name, fontsize=11, fontweight="bold", color=TEXT)
    return figure


_ONE = _Scenario(1, "auction-1", "append")
_TWO = _Scenario(2, "auction-2-as-run", "insert")
_THREE = _Scenario(3, "auction-3-seeded", "insert")

_PATHS = (
    (_ONE, "5.2", "total", False, 0),
    (_ONE, "5.3", "total", True, 0),
    (_TWO, "5.6", "total", False, 0),
    (_TWO, "5.7", "total", True, 0),
    (_TWO, "5.8", "total", True, 1),
    (_TWO, "5.9", "max", False, 0),
    (_TWO, "5.10", "max", True, 0),
    (_TWO, "5.11", "average", False, 0),
    (_TWO, "5.12", "average", True, 0),
    (_THREE, "5.16", "total", False, 0),
    (_THREE, "5.17", "total", True, 0),
    (_THREE, "5.18", "total", True, 1),
    (_THREE, "5.19", "total", True, 2),
    (_THREE, "5.20", "max", True, 1),
    (_THREE, "5.21", "max", True, 0),
    (_THREE, "5.22", "average", False, 0),
    (_THREE, "5.23", "average", True, 0),
)
"""The scenario, the figure, the objective, whether the paths are seen in space, and from where."""
_WORLDS = ((_ONE, "5.1", 8.0), (_TWO, "5.4", 10.0), (_TWO, "5.5", 25.0))
"""The scenario, the figure, and the seconds after which the world is drawn."""
_PLACES = ((_THREE, "5.13", True, False), (_THREE, "5.14", False, True), (_THREE, "5.15", True, True))
"""The scenario, the figure, whether drones are drawn, and whether tasks are."""


FIGURES = captioned(
    "auction-5",
    {
        **{number: partial(scenario.world, at_s) for scenario, number, at_s in _WORLDS},
        **{number: partial(scenario.places, drones, tasks) for scenario, number, drones, tasks in _PLACES},
        **{
            number: partial(scenario.paths, bid, spatial, seen_from)
            for scenario, number, bid, spatial, seen_from in _PATHS
        },
    },
)
