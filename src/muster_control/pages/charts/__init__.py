"""Charts as page elements drawn by scripts: the schedule of a plan, and the progress of planning."""

from muster_control.pages.charts.element import Curve, Gantt

__all__ = ["Curve", "Gantt"]
