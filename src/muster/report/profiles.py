"""Draws how allocators stand: performance profiles [dolan2002], and gaps to the best."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.values.arrays import Floats
from muster.report.canvas import new_axes, quiet_frame
from muster.report.styles import DASHED, PALETTE, QUIET_TEXT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Steps = tuple[str, Floats, Floats]
"""A name, ratios (k,) in order, and the share (k,) from each of them on."""

_SIZE_IN = (5.6, 3.7)
_LARGEST_RATIO = 10.0
_ROOM = 1.02
_LARGEST_GAP = 1000.0


def draw_profiles(profiles: Sequence[Steps], ax: Axes | None = None) -> Axes:
    """Draw performance profiles as steps, over a logarithmic axis of ratios from 1 to 10 at most.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    axes: Any = new_axes(*_SIZE_IN) if ax is None else ax
    ends = [min(_LARGEST_RATIO, float(ratios[-1])) for _, ratios, _ in profiles if len(ratios)]
    right = max([*ends, 1.001]) ** _ROOM
    for k, (name, ratios, shares) in enumerate(profiles):
        line, color = _stroke(k), PALETTE[k % len(PALETTE)]
        x, y = np.concatenate([[1.0], ratios, [max(right, 1.0)]]), np.concatenate([[0.0], shares, shares[-1:]])
        y = np.concatenate([y, [0.0]]) if not len(ratios) else y
        axes.step(x, y, where="post", label=name, color=color, linestyle=line, linewidth=1.8)
    axes.set_xscale("log")
    axes.set_xlim(1.0, right)
    axes.set_ylim(0.0, 1.03)
    _plain_ratios(axes, right)
    axes.set_xlabel("objective / best on the mission, at most")
    axes.set_ylabel("share of runs")
    quiet_frame(axes)
    axes.legend(loc="lower right", fontsize=8, frameon=True, framealpha=0.9, edgecolor="none")
    drawn: Axes = axes
    return drawn


def draw_gaps(gaps: Mapping[str, Sequence[float]], ax: Axes | None = None) -> Axes:
    """Draw for each allocator its gaps, per cent: quartiles as a box, the median, 5 to 95 per cent as whiskers.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    axes: Any = new_axes(_SIZE_IN[0], 1.0 + 0.42 * max(2, len(gaps))) if ax is None else ax
    for k, (name, values) in enumerate(gaps.items()):
        color = PALETTE[k % len(PALETTE)]
        if not values:
            axes.annotate(
                "no run to show", (0, k), (4, 0), textcoords="offset points", va="center", fontsize=8, color=QUIET_TEXT
            )
            continue
        low, first, middle, third, high = np.percentile(values, (5, 25, 50, 75, 95))
        axes.plot([low, high], [k, k], color=color, linewidth=1.4, solid_capstyle="butt")
        axes.barh(k, third - first, left=first, height=0.5, color=color, alpha=0.35, edgecolor=color)
        axes.plot([middle, middle], [k - 0.25, k + 0.25], color=color, linewidth=2.4, solid_capstyle="butt", label=name)
    axes.set_yticks(range(len(gaps)), list(gaps), parse_math=False)
    axes.set_ylim(len(gaps) - 0.4, -0.6)
    axes.set_xlim(left=0)
    axes.set_xlabel("above the best on the mission [%]")
    quiet_frame(axes)
    drawn: Axes = axes
    return drawn


def _stroke(index: int) -> Any:
    """The line of an allocator: after all colours, dashed."""
    return "-" if index < len(PALETTE) else DASHED


def _plain_ratios(axes: Any, right: float) -> None:
    """Ratios as plain numbers, some four of them."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

    steps = (1.001, 1.002, 1.005, 1.01, 1.02, 1.05, 1.1, 1.2, 1.5, 2, 3, 5, 10)
    inside = [step for step in steps if step <= right]
    chosen = [1.0, *inside[-4:]]
    apart = [b for a, b in pairwise(chosen) if np.log(b / a) > 0.07 * np.log(right)]
    axes.xaxis.set_major_locator(FixedLocator([1.0, *apart]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_locator(NullLocator())
