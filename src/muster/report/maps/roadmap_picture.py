"""A picture of a roadmap: lanes, one-way arrows, passages for one, dead ends, holding places."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Mission
from muster.motion.grid import Grid
from muster.report.figures.canvas import add_legend, add_title, frame_of_map, limits, map_axes
from muster.report.figures.styles import PALETTE, TEXT
from muster.report.maps.floor import draw_map, map_corners
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.passages import Passage
from muster.traffic.roadmaps.roadmap import Roadmap

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LONG_SIDE_IN = 9.0
_LANE, _PASSAGE, _DEAD_END, _HOLDING, _PLACE = "#9DB4C8", PALETTE[1], PALETTE[6], PALETTE[2], PALETTE[0]


def plot_roadmap(
    mission: Mission, made: MissionRoadmap, passages: Sequence[Passage], *, image: Grid | None = None
) -> Axes:
    """Draw the roadmap of a mission over its map.

    Parameters
    ----------
    mission
        whose map and places are drawn.
    made, passages
        its roadmap, and the passages for one of that.
    image
        the cells of a map that is an image (`World.image`).

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    roadmap = made.roadmap
    corners = [corner[:2] for corner in map_corners(mission.map, image)] if mission.map is not None else []
    low, high = limits(np.concatenate([roadmap.points, np.reshape(corners, (-1, 2))]), 0.03, on_ground=False)
    ax: Any = map_axes(low, high, _LONG_SIDE_IN)
    frame_of_map(ax, low, high)
    entries = draw_map(ax, mission.map, image, spatial=False) if mission.map is not None else []
    inch_per_m = _LONG_SIDE_IN / (high - low).max()
    entries = [
        *_draw_lanes(ax, roadmap, passages, inch_per_m),
        *_draw_arrows(ax, roadmap),
        *_draw_points(ax, roadmap, inch_per_m),
        *_draw_places(ax, made),
        *entries,
    ]
    add_legend(ax, entries)
    dead_ends = sum(one.is_dead_end for one in passages)
    radii = ", ".join(f"{radius_m:g}" for radius_m in roadmap.radii_m)
    facts = [
        f"roadmap for radius {radii} m: {len(roadmap.points)} points, {len(roadmap.edges)} edges",
        f"passages for one: {len(passages)}, of them dead ends: {dead_ends}",
    ]
    add_title(ax, mission.name, facts)
    return ax  # type: ignore[no-any-return]


def _draw_lanes(ax: Any, roadmap: Roadmap, passages: Sequence[Passage], inch_per_m: float) -> list[tuple[Any, str]]:
    """Draw every edge once: those that lead into passages stronger, into dead ends in another colour."""
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D

    kind = np.zeros(len(roadmap.points), dtype=np.int64)
    for one in passages:
        kind[one.points] = 2 if one.is_dead_end else 1
    first = roadmap.one_way | (roadmap.edges[:, 0] < roadmap.edges[:, 1])
    edges = roadmap.edges[first]
    of_edge = kind[edges].max(axis=1)
    thin = float(np.clip(3.0 * roadmap.reach * inch_per_m, 0.25, 0.9))
    entries = []
    looks = ((0, "lane", _LANE, thin), (1, "passage for one", _PASSAGE, 1.8), (2, "dead end", _DEAD_END, 1.8))
    for number, label, color, line_width in looks:
        pieces = roadmap.points[edges[of_edge == number]]
        if len(pieces):
            look: dict[str, Any] = {"linewidths": line_width, "colors": color, "zorder": 1.5 + 0.1 * number}
            ax.add_collection(LineCollection(list(pieces), gid=label.replace(" ", "-"), **look))
            entries.append((Line2D([], [], color=color, linewidth=max(line_width, 0.9)), label))
    return entries


def _draw_arrows(ax: Any, roadmap: Roadmap) -> list[tuple[Any, str]]:
    """Draw an arrow head on the middle of each one-way edge."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import FancyArrowPatch

    edges = roadmap.edges[roadmap.one_way]
    if not len(edges):
        return []
    look: dict[str, Any] = {"arrowstyle": "-|>", "mutation_scale": 12, "linewidth": 0.0, "color": TEXT, "zorder": 2.2}
    for k, (start, end) in enumerate(roadmap.points[edges].tolist()):
        head = (start[0] + 0.6 * (end[0] - start[0]), start[1] + 0.6 * (end[1] - start[1]))
        ax.add_patch(FancyArrowPatch(tuple(start), head, shrinkA=0, shrinkB=0, gid=f"one-way-{k}", **look))
    return [(Line2D([], [], color=TEXT, linestyle="none", marker=">", markersize=5), "one-way")]


def _draw_points(ax: Any, roadmap: Roadmap, inch_per_m: float) -> list[tuple[Any, str]]:
    size = float(np.clip(72 * inch_per_m * roadmap.reach * 0.25, 0.8, 4.5))
    found = []
    looks = (("holding place", roadmap.holding, _HOLDING), ("no place to rest", ~roadmap.holding, _PASSAGE))
    for label, which, color in looks:
        if which.any():
            look = {"linestyle": "none", "marker": ".", "markersize": 2 * size, "markeredgewidth": 0, "color": color}
            (mark,) = ax.plot(*roadmap.points[which].T, gid=label.replace(" ", "-"), zorder=2, **look)
            found.append((mark, label))
    return found


def _draw_places(ax: Any, made: MissionRoadmap) -> list[tuple[Any, str]]:
    """Draw where robots start, and the other places of the mission."""
    starts = {robot.position[:2] for robot in made.robots}
    places = dict.fromkeys(place for points in made.point_of for place in points)
    others = [place for place in places if place not in starts]
    found = []
    for label, those, marker in (("start", sorted(starts), "s"), ("task or end", others, "o")):
        if those:
            look = {"linestyle": "none", "markersize": 4.5, "markerfacecolor": "white", "markeredgewidth": 1.0}
            (mark,) = ax.plot(
                *np.array(those).T,
                marker=marker,
                markeredgecolor=_PLACE,
                gid=label.replace(" ", "-"),
                zorder=3,
                **look,
            )
            found.append((mark, label))
    return found
