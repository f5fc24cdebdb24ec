"""The tracks of a recording as a picture, seen from above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.report.figures.canvas import add_legend, add_title, frame_of_map, limits, new_axes
from muster.report.figures.styles import robot_style
from muster_robots.recordings.poses import PoseTrack

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LONG_SIDE_IN = 6.6
_MARGIN = 0.05
_NARROW, _STEPS = 1.2, 6
"""Lines become narrower from track to track, so that of those that lie on each other all are seen."""


def plot_tracks(name: str, tracks: Sequence[PoseTrack]) -> Axes:
    """Draw tracks, with a dot where each begins.

    Returns
    -------
    The axes, in metres of the tracks' frame, equal in scale.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    low, high = limits(np.concatenate([track.positions[:, :2] for track in tracks]), _MARGIN, on_ground=True)
    size = high - low
    wide, tall = _LONG_SIDE_IN * size / size.max()
    ax: Any = new_axes(wide + 2.6, max(tall + 1.0, 0.19 * len(tracks) + 0.6))
    frame_of_map(ax, low, high)
    entries = []
    for k, track in enumerate(tracks):
        color, wide_pt = robot_style(k).color, _NARROW + min(len(tracks) - 1 - k, _STEPS)
        (line,) = ax.plot(
            *track.positions[:, :2].T,
            color=color,
            linewidth=wide_pt,
            gid=f"track-{track.topic}",
        )
        ax.plot(*track.positions[0, :2], "o", color=color, markersize=4)
        entries.append((line, f"{track.topic} ({track.frame})" if track.frame else track.topic))
    add_legend(ax, entries)
    first, last = min(track.times_s[0] for track in tracks), max(track.times_s[-1] for track in tracks)
    add_title(ax, name, [f"{last - first:.1f} s", f"{len(tracks)} tracks"])
    return ax  # type: ignore[no-any-return]
