"""Stations on the ground: their marks, and their names in brackets."""

from __future__ import annotations

from typing import Any

from muster.mission.model import Mission, Point
from muster.mission.stations import station_sign
from muster.report.figures.fonts import Names
from muster.report.figures.styles import SERVICE, SERVICE_EDGE
from muster.report.route_lines import Places

MOST_STATIONS = 40
"""Stations up to which each is named."""
_FONT = 6.5


def draw_stations(ax: Any, where: Places) -> list[tuple[Any, str]]:
    """Draw a cross at each station `(n, 2 or 3)`; the entry of a legend, if there is any."""
    from matplotlib.lines import Line2D

    if not len(where):
        return []
    look: dict[str, Any] = {
        "marker": "P",
        "markersize": 9.0 if len(where) <= MOST_STATIONS else 5.0,
        "color": SERVICE,
        "markeredgecolor": SERVICE_EDGE,
        "markeredgewidth": 1.0,
        "linestyle": "none",
    }
    ax.plot(*where.T, gid="stations", zorder=2.94, **look)
    return [(Line2D([], [], **look), "[station]")]


def station_names(mission: Mission, names: Names) -> list[tuple[Point, str, dict[str, Any]]]:
    """Where which name is to be written, and its look; none where there are too many to be read."""
    if len(mission.stations) > MOST_STATIONS:
        return []
    look = {"fontsize": _FONT, "color": SERVICE_EDGE, "fontweight": "bold", "zorder": 4}
    return [
        (station.position, station_sign(names.station(station.id)), {**look, "gid": f"station-name-{station.id}"})
        for station in mission.stations
    ]
