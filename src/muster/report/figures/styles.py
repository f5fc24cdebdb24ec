"""The style of a robot in every picture: fixed by its place in the mission, whatever the plan.

Colours are those of [okabe2008], which readers of all kinds of colour vision distinguish. Their yellow, too faint on
white, is replaced by a wine red, and their black by a dark grey. After eight robots the colours repeat with another
marker and another stroke.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#882255", "#333333")
MARKERS = ("o", "s", "D", "h")
STROKES: tuple[Any, ...] = ("-", "hollow", (0, (7, 1.5, 1.5, 1.5)), (0, (1.2, 1.2)))

DASHED = (0, (4, 2.5))
LEFT_OUT = "#8A8A8A"
PREREQUISITE = "#BDBDBD"
FRAME = "#B0B0B0"
FAINT = "#E6E6E6"
WALL = "#C4C4C4"
GRID = "#E8E8E8"
TEXT = "#222222"
QUIET_TEXT = "#6B6B6B"
ALARM = "#B00020"
TRAFFIC = "#FFE14D"
"""Waiting in traffic, whatever the robot's own colour."""
SERVICE, SERVICE_EDGE = "#C9E8B5", "#3F7D20"
"""What robots do at stations, whatever the robot's own colour, and the mark of a station."""
LEVEL = "#2E2E2E"
"""The level of a battery."""
AREA, AREA_EDGE = "#F4F1E4", "#B5A979"
"""The ground of an area that is covered, and its outline."""
TRANSPORT = "#8064A2"
"""From where something is taken on board to where it is put down."""

MOST_ARROWS = 60
"""Prerequisites that are drawn; where there are more, none is."""
MOST_TRANSPORTS = 30
"""Deliveries whose transports are drawn; where there are more, none is."""


@dataclass(frozen=True)
class Style:
    """Colour (hex), marker and stroke of one robot; `stroke` is a line style, or "hollow": a line with a white core."""

    color: str
    marker: str
    stroke: Any

    @property
    def ink(self) -> str:
        """Return the colour of text upon the robot's colour."""
        return "white" if luminance(self.color) < 0.24 else "#111111"


def robot_style(index: int) -> Style:
    """Return the style of the robot at `index` of the mission."""
    cycle = index // len(PALETTE)
    return Style(PALETTE[index % len(PALETTE)], MARKERS[cycle % len(MARKERS)], STROKES[cycle % len(STROKES)])


def luminance(color: str) -> float:
    """Compute the relative luminance of "#rrggbb", 0 to 1 (WCAG 2, "relative luminance")."""
    channels = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue
