"""Common parts of all pictures: axes, titles, legends, text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from muster.mission.plan import Plan
from muster.mission.system.extras import needs_extra
from muster.motion.grid import Floats
from muster.report.fonts import Names
from muster.report.styles import ALARM, FRAME, GRID, QUIET_TEXT, TEXT
from muster.verification import Verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEGEND_ROWS = 24
"""Robots that a legend names; of more than these it names the first 20."""
_NAMED_OF_MANY = 20
_LONGEST_TITLE = 60
_LONGEST_NAME = 24


def map_axes(low: Floats, high: Floats, long_side_in: float, least_in: float = 2.5) -> Axes:
    """Axes for a map in the plane between two corners: so long on its long side, at least so high, beside a legend.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    width, height = long_side_in * (high - low) / (high - low).max()
    return new_axes(width + 2.6, max(height + 1.0, least_in))


def new_axes(width_in: float, height_in: float, *, spatial: bool = False) -> Axes:
    """Make axes on a figure of their own, in inches, without pyplot and without a window.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    figure = new_figure(width_in, height_in)
    from matplotlib import rc_context

    from muster.report.picture_axes import PictureAxes, PictureAxes3D

    if not spatial:
        return figure.add_subplot(axes_class=PictureAxes)
    with rc_context({"grid.color": GRID, "grid.linewidth": 0.6}):  # 3-D axes read these once, when they are made
        axes: Axes = figure.add_subplot(axes_class=PictureAxes3D, computed_zorder=False)
    return axes


def new_figure(width_in: float, height_in: float) -> Figure:
    """A figure of several panels of its own, laid out by constraints; nothing is known to pyplot.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    require_matplotlib()
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_in, height_in), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def limits(points: NDArray[np.float64], margin: float, *, on_ground: bool) -> tuple[Any, Any]:
    """Find the lower and the upper corner of a picture of points `(n, 2 or 3)`; no side is very short.

    Parameters
    ----------
    points
        what the picture must hold.
    margin
        around it, as a share of the longest side.
    on_ground
        whether a 3-D picture stands on the lowest point: nothing is below the ground.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    longest = float((high - low).max()) or 1.0
    missing, around = np.maximum(0.3 * longest - (high - low), 0.0), margin * longest
    below, above = missing / 2 + around, missing / 2 + around
    if on_ground and len(low) == 3:
        below[2], above[2] = 0.0, missing[2] + around
    return low - below, high + above


def require_matplotlib() -> None:
    """Raise MissingExtraError where matplotlib is not installed."""
    with needs_extra("plot", "drawing"):
        import matplotlib  # noqa: F401


def is_spatial(ax: Axes) -> bool:
    """Tell whether the axes have a z axis."""
    return hasattr(ax, "get_zlim")


def frame_of_map(ax: Any, low: NDArray[np.float64], high: NDArray[np.float64]) -> None:
    """Let axes show the map frame from a lower to an upper corner, metres, equal in scale."""
    for axis, least, most in zip("xyz", low, high, strict=False):
        getattr(ax, f"set_{axis}lim")(least, most)
        getattr(ax, f"set_{axis}label")(f"{axis} [m]")
    ax.set_aspect("equal", adjustable="box")
    quiet_frame(ax)


def quiet_frame(ax: Any) -> None:
    """Draw frame and grid lightly, so that the data stands out."""
    ax.tick_params(labelsize=8, color=FRAME)
    ax.xaxis.label.set_size(9)
    ax.yaxis.label.set_size(9)
    if is_spatial(ax):
        for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
            axis.set_pane_color((0.985, 0.985, 0.985))
            axis.line.set_color(FRAME)
        ax.zaxis.label.set_size(9)
        return
    for spine in ax.spines.values():
        spine.set_color(FRAME)
    ax.set_axisbelow(True)
    ax.grid(visible=True, color=GRID, linewidth=0.6)


def add_title(ax: Axes, name: str, facts: Sequence[str], alarm: str = "") -> None:
    """Write the mission's name above the axes, and beneath it a line of facts."""
    from matplotlib import rcParams

    ax.set_title(
        shortened(name, _LONGEST_TITLE),
        loc="left",
        fontsize=11,
        fontweight="bold",
        color=TEXT,
        pad=20,
        parse_math=False,
        fontfamily=rcParams["font.family"],  # a title is older than the text that is written into it
    )
    line: dict[str, Any] = {
        "xycoords": "axes fraction",
        "textcoords": "offset points",
        "fontsize": 8.5,
        "annotation_clip": False,
        "parse_math": False,
    }
    text = ax.annotate(" · ".join(facts), (0, 1), (0, 7), color=QUIET_TEXT, gid="facts", **line)
    if alarm:
        beside = {**line, "xycoords": text, "va": "bottom"}
        ax.annotate(f" · {alarm}", (1, 0), (0, 0), color=ALARM, gid="alarm", **beside)


def shortened(name: str, longest: int = _LONGEST_NAME) -> str:
    """Cut a name that is too long for a picture."""
    return name if len(name) <= longest else name[: longest - 1] + "…"


def facts_of(verdict: Verdict, plan: Plan | None = None) -> list[str]:
    """The allocator, the objective with its value and unit, and the tasks done."""
    value = verdict.value()
    unit = "s" if verdict.objective_name in ("makespan", "lateness") else verdict.usage_unit
    shown = "none" if value is None else f"{value:.2f} {unit}"
    done = f"tasks {verdict.tasks_completed}/{verdict.tasks_total}"
    by = [plan.allocator] if plan is not None and plan.allocator else []
    return [*by, f"{verdict.objective_name} {shown}", done]


def alarm_of(verdict: Verdict) -> str:
    """The text beside the figures of a plan that says that it is not admissible; empty for an admissible one."""
    count = len(verdict.violations)
    return "" if verdict.valid else f"not admissible: {count} violation{'s' if count > 1 else ''}"


def named_rows(count: int) -> int:
    """The number of robots, of `count`, that a legend names."""
    return count if count <= LEGEND_ROWS else _NAMED_OF_MANY


def add_legend(ax: Axes, entries: Sequence[tuple[Any, str]], title: str | None = None) -> None:
    """Draw a legend outside the axes, on the right; entries are handles with their labels."""
    legend = ax.legend(
        [handle for handle, _ in entries],
        ["?"] * len(entries),
        title=title,
        loc="upper left",
        bbox_to_anchor=(_right_end(ax), 1.0),
        borderaxespad=0.0,
        frameon=False,
        fontsize=8,
        title_fontsize=8,
        alignment="left",
        handlelength=2.6,
        labelspacing=0.55,
    )
    for text, (_, label) in zip(legend.get_texts(), entries, strict=True):
        text.set_parse_math(False)  # an id may hold a dollar sign, or begin with an underscore, which hides an entry
        text.set_text(label)


def note_entries(names: Names) -> list[tuple[Any, str]]:
    """Make the legend's lines on how names are written, where that is needed."""
    from matplotlib.lines import Line2D

    return [(Line2D([], [], linestyle="none"), note) for note in names.notes]


def _right_end(ax: Any) -> float:
    """Find where a legend may begin, as a share of the axes' width; 3-D axes write beyond their own box."""
    if not is_spatial(ax):
        return 1.01
    settle(ax)
    return float(ax.transAxes.inverted().transform(ax.get_tightbbox().max)[0]) + 0.06


def write(
    ax: Any,
    point: Sequence[float],
    text: str,
    offset: Sequence[float] = (0.0, 0.0),
    *,
    halo: bool = False,
    **style: Any,
) -> Any:
    """Write a text centred at a point of the data, shifted by an offset in points (1/72 inch); 2-D or 3-D.

    A halo separates the text from lines that it crosses.
    """
    from matplotlib.patheffects import withStroke
    from matplotlib.transforms import ScaledTranslation

    shift = ScaledTranslation(offset[0] / 72, offset[1] / 72, ax.figure.dpi_scale_trans)
    centred = {"ha": "center", "va": "center", "parse_math": False, "clip_on": True}
    if halo:
        style["path_effects"] = [withStroke(linewidth=1.6, foreground="white")]
    return ax.text(*point, text, transform=ax.transData + shift, **{**centred, **style})


def to_points(ax: Any, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Find where places of the data `(n, 2 or 3)` are on the page: `(n, 2)`, in points; NaN stays NaN."""
    if places.shape[1] == 3:
        from mpl_toolkits.mplot3d import proj3d

        x, y, _ = proj3d.proj_transform(*places.T, ax.get_proj())
        places = np.column_stack([np.asarray(x), np.asarray(y)])
    if not len(places):
        return np.empty((0, 2))
    points: NDArray[np.float64] = ax.transData.transform(places) * 72 / ax.figure.dpi
    return points


def settle(ax: Any) -> None:
    """Lay the figure out, so that places on the page no longer change."""
    if ax.figure.get_layout_engine() is not None:
        ax.figure.canvas.figure.draw_without_rendering()  # the outermost one, also from a subfigure
    else:
        ax.apply_aspect()
