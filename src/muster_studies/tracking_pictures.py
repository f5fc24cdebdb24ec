"""Draws a robot's reference and flights on the map, their deviation over time, and measures as bars with spreads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev
from typing import TYPE_CHECKING, Any

from muster.mission.model import Map
from muster.report.figures.canvas import new_figure, quiet_frame
from muster.report.figures.styles import ALARM, DASHED, QUIET_TEXT, TEXT, robot_style
from muster.report.maps.floor import draw_map
from muster.report.route_lines import Places

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PANEL_IN = 4.6
_DEVIATION_IN = 1.9


@dataclass(frozen=True, kw_only=True, eq=False)
class Tracked:
    """One flight of one robot.

    Parameters
    ----------
    name
        the kind of flight; flights of a kind have one colour.
    places
        (k, 2) metres.
    times, aside
        (k,) seconds, and metres from the reference.
    """

    name: str
    places: Places
    times: Places
    aside: Places


def plot_tracking(
    chart: Map | None,
    reference: Places,
    flights: Sequence[Tracked],
    goals: Mapping[str, tuple[float, float]],
    title: str,
    points: Mapping[str, Places] | None = None,
) -> Figure:
    """Draw the reference (k, 2) and the flights on the map, beneath them how far aside each was over time.

    `goals` are marked with their names, `points` (k, 2) by what they are: up to four kinds, the first
    with dots.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    figure = new_figure(_PANEL_IN, _PANEL_IN + _DEVIATION_IN)
    above, below = figure.subplots(2, 1, height_ratios=(_PANEL_IN, _DEVIATION_IN))
    if chart is not None:
        draw_map(above, chart, spatial=False)
    above.plot(*reference.T, color=TEXT, linestyle=DASHED, linewidth=1.2, label="reference", zorder=4, gid="reference")
    for index, kind in enumerate(dict.fromkeys(flight.name for flight in flights)):
        for k, flight in enumerate(flight for flight in flights if flight.name == kind):
            look: dict[str, Any] = {
                "color": robot_style(index).color,
                "linewidth": 1.0,
                "zorder": 3 - 0.1 * index,
                "label": kind if k == 0 else "_",  # one entry of the legend for all of a kind
            }
            above.plot(*flight.places.T, **look)
            below.plot(flight.times, 1000 * flight.aside, **look)
    above.plot(*reference[0], "s", color=TEXT, markersize=5, zorder=5)
    for name, (x, y) in goals.items():
        above.plot(x, y, "o", color=ALARM, markersize=5, zorder=5)
        above.annotate(name, (x, y), (6, 4), textcoords="offset points", fontsize=7, color=QUIET_TEXT)
    for (kind, places), (marker, size) in zip((points or {}).items(), _MARKERS.items(), strict=False):
        above.plot(*places.T, marker, color=TEXT, markersize=size, fillstyle="none", zorder=6, label=kind)
    above.set_aspect("equal", adjustable="datalim")
    above.set_xlabel("x [m]")
    above.set_ylabel("y [m]")
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7, frameon=False)
    below.set_xlabel("time [s]")
    below.set_ylabel("aside [mm]")
    below.set_ylim(bottom=0.0)
    finish(figure, title)
    return figure


_MARKERS = {".": 1.5, "^": 5.0, "o": 5.0, "x": 5.0}
"""And their sizes."""


@dataclass(frozen=True, kw_only=True)
class Measure:
    """One measure: its mean and spread by robot, in the unit that `label` states; `printed`, a published value."""

    label: str
    means: Mapping[str, float]
    spreads: Mapping[str, float]
    printed: float | None = None

    @classmethod
    def of(cls, label: str, values: Mapping[str, Sequence[float]], printed: float | None = None) -> Measure:
        """Return the measure whose `values` were found for each robot, one a run; the spread of one value is 0."""
        return cls(
            label=label,
            means={robot: fmean(each) for robot, each in values.items()},
            spreads={robot: stdev(each) if len(each) > 1 else 0.0 for robot, each in values.items()},
            printed=printed,
        )


def plot_measures(measures: Sequence[Measure], title: str, columns: int = 4) -> Figure:
    """Draw each measure in a panel of its own, `columns` a row: a bar for each robot, the spread as error bar.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    columns = min(columns, len(measures))
    rows = -(-len(measures) // columns)
    figure = new_figure(2.9 * columns, 2.6 * rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax, measure in zip(axes, measures, strict=False):
        _draw_measure(ax, measure)
    for ax in axes[len(measures) :]:
        ax.remove()
    finish(figure, title)
    return figure


def _draw_measure(ax: Any, measure: Measure) -> None:
    for index, (robot, mean) in enumerate(measure.means.items()):
        ax.bar(robot, mean, width=0.6, color=robot_style(index).color, alpha=0.85)
        ax.errorbar(robot, mean, yerr=measure.spreads[robot], color=TEXT, capsize=4, linewidth=1.0)
    if measure.printed is not None:
        ax.axhline(measure.printed, color=ALARM, linestyle=DASHED, linewidth=1.0)
        ax.annotate("paper, most", (0.02, measure.printed), (0, -9), color=ALARM, fontsize=7, **_AT_LEFT)
    ax.set_title(measure.label, fontsize=8, color=TEXT, loc="left")


_AT_LEFT: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "textcoords": "offset points"}


def finish(figure: Figure, title: str) -> None:
    """Give all axes of a figure quiet frames, and the figure its title."""
    for ax in figure.axes:
        quiet_frame(ax)
    figure.suptitle(title, fontsize=10, fontweight="bold", color=TEXT)
