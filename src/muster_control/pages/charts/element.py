"""Charts as elements of NiceGUI; their data are plain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from nicegui.element import Element


class Curve(Element, component="curve.js"):
    """The objective of the best plan so far, over time, and its lower bound."""

    def __init__(self) -> None:
        super().__init__()
        self.props["history"] = []
        self.props["bound"] = None
        self.props["until"] = 0.0

    def show(self, history: Sequence[Sequence[float]], bound: float | None, until: float) -> None:
        """Show [seconds, objective] of each improvement, the bound if there is one, up to a time in seconds."""
        self.props["history"] = [list(point) for point in history]
        self.props["bound"] = bound
        self.props["until"] = until


class Gantt(Element, component="gantt.js"):
    """The schedule of each robot: travel, waiting, work, service at stations, its battery, and what is asked of time.

    Emits `choose` with `{what: task or station, id}`.
    """

    def __init__(self) -> None:
        super().__init__()
        self.props["rows"] = []
        self.props["marks"] = []
        self.props["clock"] = None

    def show(self, verdict: Mapping[str, Any]) -> None:
        """Show a verdict's `routes`, `{robot, stops, leaves_s, back_s, level}`.

        `stops` are `{name, is_station, arrives_s, starts_s, ends_s, charged}`. `level`, `marks` and `clock_start_s` are
        as the worker's verdict has them.
        """
        self.props["rows"] = [dict(row) for row in verdict["routes"]]
        self.props["marks"] = [dict(mark) for mark in verdict["marks"]]
        self.props["clock"] = verdict["clock_start_s"]
