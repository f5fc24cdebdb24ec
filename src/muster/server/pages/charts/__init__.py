"""Charts of a plan as elements of pages, drawn by scripts of their own: who does what when, and how planning goes."""

from muster.server.pages.charts.element import Curve, Gantt

__all__ = ["Curve", "Gantt"]
