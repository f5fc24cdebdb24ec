"""Pictures of what is given: routes on the ground, charts over time; records and pages of what was carried out.

Matplotlib is loaded only when a picture is drawn, mcap only when a record is written or read.
"""

from muster.report.files import save_figure
from muster.report.gantt import plot_gantt
from muster.report.routes import plot_routes

__all__ = ["plot_gantt", "plot_routes", "save_figure"]
