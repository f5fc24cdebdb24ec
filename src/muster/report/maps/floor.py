"""The map beneath the routes: walls of an image, boundary, zones with their heights."""

from __future__ import annotations

from typing import Any

import numpy as np

from muster.mission.model import Map, Mission, Point, Zone
from muster.motion.grid import Grid
from muster.report.figures.canvas import write
from muster.report.figures.styles import FAINT, FRAME, QUIET_TEXT, WALL

_HATCH = {"ground": "///", "air": "\\\\\\"}


def map_image(mission: Mission) -> Grid | None:
    """Read the cells of the mission's map, where it is an image."""
    from muster.motion.map_world import World

    return None if mission.map is None or mission.map.boundary is not None else World.of(mission).image


def draw_map(ax: Any, chart: Map, image: Grid | None = None, *, spatial: bool) -> list[tuple[Any, str]]:
    """Draw a map, lightly; returns the zones' entries for the legend.

    Parameters
    ----------
    chart
        the mission's map, of which boundary and zones are drawn.
    image
        the cells of a map that is an image (`World.image`), drawn where origin and yaw place them; on 3-D axes on the
        ground, as the outlines of its walls.
    spatial
        whether the axes have a z axis.
    """
    from matplotlib.patches import Patch

    if image is not None:
        _draw_image_in_space(ax, image) if spatial else _draw_image(ax, image)
    if chart.boundary is not None:
        _polygon(ax, chart.boundary, 0.0, spatial, facecolor="none", edgecolor=FRAME, linewidth=1.2, gid="boundary")
    entries: dict[str, Patch] = {}
    for k, zone in enumerate(chart.zones):
        look: dict[str, Any] = {"facecolor": FAINT, "edgecolor": FRAME, "linewidth": 0.8}
        look["hatch"] = "".join(_HATCH[kind] for kind in zone.closed_to)
        if zone.open:
            look |= {"facecolor": "none", "linestyle": ":"}
        for level in _levels(zone) if spatial else (0.0,):
            _polygon(ax, zone.polygon, level, spatial, gid=f"zone-{k}-at-{level:g}", **look)
        if spatial and zone.ceiling_m is not None:
            _draw_sides(ax, zone, k)
        _name_heights(ax, zone, k, spatial)
        label = "door, open at first" if zone.open else f"no entry: {', '.join(sorted(zone.closed_to))}"
        entries[label] = Patch(**look)
    return [(patch, label) for label, patch in entries.items()]


def map_corners(chart: Map, image: Grid | None = None) -> list[Point]:
    """List the places that a picture of a map must hold: (x, y), and (x, y, z) where a zone ends at a height."""
    corners = list(chart.boundary or ())
    for zone in chart.zones:
        top = (max(_levels(zone)),) if zone.floor_m or zone.ceiling_m else ()
        corners += [(*corner, *top) for corner in zone.polygon]
    if image is not None:
        corners += [(float(x), float(y)) for x, y in image.to_map(_corners(image))]
    return corners


def map_outlines(chart: Map) -> list[Any]:
    """List the outlines of boundary and zones as closed lines (n, 2)."""
    polygons = [*([chart.boundary] if chart.boundary is not None else []), *(zone.polygon for zone in chart.zones)]
    return [np.array([*polygon, polygon[0]], dtype=np.float64) for polygon in polygons]


def wall_places(image: Grid) -> Any:
    """List the middles (n, 2) of the edges between free and blocked cells."""
    places: Any = image.to_map(_edges(image.blocked).mean(axis=1))
    return places


def _corners(image: Grid) -> Any:
    rows, columns = image.shape
    return np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)], dtype=np.float64)


def _draw_image(ax: Any, image: Grid) -> None:
    """Draw the cells of a grid, blocked ones grey and free ones white."""
    from matplotlib.colors import ListedColormap
    from matplotlib.transforms import Affine2D

    x, y, yaw = image.origin
    rows, columns = image.shape
    size = image.resolution_m
    cells = ax.imshow(
        image.blocked,
        cmap=ListedColormap(["white", WALL]),
        vmin=0,
        vmax=1,
        origin="lower",
        extent=(0, columns * size, 0, rows * size),
        interpolation="antialiased",
        zorder=0.5,
        gid="image",
    )
    cells.set_transform(Affine2D().rotate(yaw).translate(x, y) + ax.transData)


def _draw_image_in_space(ax: Any, image: Grid) -> None:
    """Draw the edges between free and blocked cells as lines on the ground."""
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    edges = image.to_map(_edges(image.blocked).reshape(-1, 2)).reshape(-1, 2, 2)
    lines = np.concatenate([edges, np.zeros((len(edges), 2, 1))], axis=2)
    ax.add_collection3d(Line3DCollection(lines, colors=WALL, linewidths=0.6, zorder=0.5, gid="image"))


def _edges(blocked: Any) -> Any:
    """Find the edges between free and blocked cells (n, 2 ends, 2), in cells."""
    fenced = np.pad(blocked, 1, constant_values=True)
    row, column = np.nonzero(fenced[1:, 1:-1] != fenced[:-1, 1:-1])
    level = np.stack([np.column_stack([column, row]), np.column_stack([column + 1, row])], axis=1)
    row, column = np.nonzero(fenced[1:-1, 1:] != fenced[1:-1, :-1])
    upright = np.stack([np.column_stack([column, row]), np.column_stack([column, row + 1])], axis=1)
    return np.concatenate([level, upright]).astype(np.float64)


def _levels(zone: Zone) -> list[float]:
    """Find the heights at which a zone's outline is drawn in 3-D: its floor and its ceiling."""
    levels = [zone.floor_m or 0.0]
    return levels if zone.ceiling_m is None else [*levels, zone.ceiling_m]


def _draw_sides(ax: Any, zone: Zone, k: int) -> None:
    """Draw the upright sides of a zone, so thinly that one sees what is behind."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    low, high = _levels(zone)
    sides = [
        [(*start, low), (*end, low), (*end, high), (*start, high)]
        for start, end in zip(zone.polygon, (*zone.polygon[1:], zone.polygon[0]), strict=True)
    ]
    look = {"facecolor": (0.8, 0.8, 0.8, 0.25), "edgecolor": FRAME, "linewidth": 0.5, "zorder": 0.7}
    ax.add_collection3d(Poly3DCollection(sides, gid=f"sides-{k}", **look))


def _name_heights(ax: Any, zone: Zone, k: int, spatial: bool) -> None:
    """Write a zone's heights, if it has any, above its northernmost corner."""
    if zone.floor_m is None and zone.ceiling_m is None:
        return
    if zone.ceiling_m is None:
        text = f"from {zone.floor_m:g} m"
    else:
        text = f"{zone.floor_m:g}-{zone.ceiling_m:g} m" if zone.floor_m else f"to {zone.ceiling_m:g} m"
    x, y = max(zone.polygon, key=lambda corner: corner[1])
    place = (x, y, _levels(zone)[-1]) if spatial else (x, y)
    write(ax, place, text, (0, 5), gid=f"heights-{k}", fontsize=6, color=QUIET_TEXT, zorder=1.5, halo=True)


def _polygon(ax: Any, corners: tuple[Point, ...], level: float, spatial: bool, **look: Any) -> None:
    if spatial:
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection

        faces = [[(*corner[:2], level) for corner in corners]]
        look["facecolor"] = (1.0, 1.0, 1.0, 0.0)  # "none" is too little for matplotlib 3.8
        ax.add_collection3d(Poly3DCollection(faces, zorder=0.7, **look))
    else:
        from matplotlib.patches import Polygon

        ax.add_patch(Polygon([corner[:2] for corner in corners], closed=True, zorder=0.7, **look))
