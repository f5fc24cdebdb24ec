"""Points of interest: what was seen, what was found, what is there ([tcf-thesis], Figures 6.4 and 6.5)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from muster.mission.model import Mission
from muster.perception.estimates import RawEstimates
from muster.perception.matching import ErrorTable, error_table
from muster.perception.point_search import FoundPoint
from muster.perception.points_of_interest import PointOfInterest
from muster.report.figures.canvas import add_title, frame_of_map, limits, new_axes
from muster.report.figures.files import save_figure
from muster.report.figures.styles import ALARM, QUIET_TEXT, TEXT, robot_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from muster.simulation.cameras import Look

_SIZE_IN = 6.4
_MARGIN = 0.06
_DEVIATIONS = 3.0
"""How many standard deviations an ellipse is wide to each side."""
FARTHEST_M = 1.0
"""What was found farther than this from every tag is where nothing is."""


class FoundByCameras:
    """Receives each look of a camera (`on_look`), and draws what was found."""

    def __init__(self) -> None:
        self._raw: list[RawEstimates] = []
        self._finds: tuple[FoundPoint, ...] = ()

    def __call__(self, look: Look) -> None:
        """Take in the estimates of one camera image."""
        self._raw.append(look.observation.estimates)
        self._finds = look.finds

    def plot(self, mission: Mission, file: Path) -> None:
        """Draw a map of all estimates, of what was found and of what is there ([tcf-thesis], Figure 6.4).

        Raises
        ------
        InputError
            if the file cannot be written.
        MissingExtraError
            if matplotlib is not installed.
        """
        points, raw = [find.point for find in self._finds], RawEstimates.joined(self._raw)
        truth = _named(mission)
        table = error_table([point.position for point in points], truth, farthest_m=FARTHEST_M)
        title = f"{mission.name}: found by cameras"
        save_figure(plot_found(raw, points, table, truth, title), file)


def plot_found(
    raw: RawEstimates,
    points: Sequence[PointOfInterest],
    table: ErrorTable,
    truth: dict[str, tuple[float, float]],
    title: str,
    ax: Axes | None = None,
) -> Axes:
    """Draw on the ground raw estimates in their robots' colours, filtered ones with 3-sigma ellipses, and the truth.

    What was missed, and what was found where nothing is, is red.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    ax = ax or new_axes(_SIZE_IN, _SIZE_IN)
    for index, robot in enumerate(sorted(set(raw.robots))):
        mine = raw.positions[[name == robot for name in raw.robots], :2]
        ax.plot(
            *mine.T, ".", color=robot_style(index).color, markersize=2, alpha=0.5, label=f"seen by {robot}", zorder=2
        )
    for point in points:
        _ellipse(ax, point)
    extra = set(table.extra)
    for place in (tuple(point.position.tolist()) for point in points):
        ax.plot(
            *place[:2], "o", markersize=5, markerfacecolor="none", color=ALARM if place in extra else TEXT, zorder=4
        )
    for name, (x, y) in truth.items():
        color = ALARM if name in table.missed else QUIET_TEXT
        ax.plot(x, y, "+", color=color, markersize=7, zorder=5)
        ax.annotate(name, (x, y), (5, 4), textcoords="offset points", fontsize=7, color=color, parse_math=False)
    for match in table.matches:
        ax.plot(*np.array([match.truth[:2], match.found[:2]]).T, color=TEXT, linewidth=0.8, zorder=3)
    _frame(ax, raw, truth)
    add_title(ax, title, _facts(table, len(truth)))
    if raw.robots:
        ax.legend(loc="best", fontsize=7, frameon=False, markerscale=4)
    return ax


def _facts(table: ErrorTable, there: int) -> list[str]:
    facts = [f"{len(table.matches)} of {there} found"]
    if table.matches:
        worst = table.matches[0]
        facts += [f"mean error {table.mean_error_m:.3f} m", f"greatest {worst.error_m:.3f} m ({worst.name})"]
    return facts + ([f"{len(table.extra)} where nothing is"] if table.extra else [])


def _ellipse(ax: Axes, point: PointOfInterest) -> None:
    if not np.isfinite(point.covariance).all():
        return
    from matplotlib.patches import Ellipse

    squares, axes = np.linalg.eigh(point.covariance[:2, :2])
    width, height = 2 * _DEVIATIONS * np.sqrt(np.maximum(squares, 0.0))
    turned = float(np.degrees(np.arctan2(axes[1, 0], axes[0, 0])))
    look: dict[str, Any] = {"facecolor": "none", "edgecolor": QUIET_TEXT, "linewidth": 0.7, "zorder": 3}
    ax.add_patch(Ellipse(tuple(point.position[:2]), width, height, angle=turned, **look))


def _frame(ax: Axes, raw: RawEstimates, truth: dict[str, tuple[float, float]]) -> None:
    places: npt.NDArray[np.float64] = np.array([*truth.values(), *raw.positions[:, :2]]).reshape(-1, 2)
    if len(places):
        frame_of_map(ax, *limits(places, _MARGIN, on_ground=False))


def _named(mission: Mission) -> dict[str, tuple[float, float]]:
    """The places of tags by their ids; the second one of an id is `7 (2)`."""
    seen: Counter[int] = Counter()
    named = {}
    for tag in mission.tags:
        seen[tag.id] += 1
        name = str(tag.id) + (f" ({seen[tag.id]})" if seen[tag.id] > 1 else "")
        named[name] = (tag.position[0], tag.position[1])
    return named
