"""Pictures and records: routes on the ground, charts over time, records of missions and pages that show them.

Matplotlib is loaded only when a picture is drawn, mcap only when a record is written or read.
"""

from muster.report.figures.files import save_figure
from muster.report.maps.routes import plot_routes
from muster.report.time_charts.gantt import plot_gantt

__all__ = ["plot_gantt", "plot_routes", "save_figure"]
