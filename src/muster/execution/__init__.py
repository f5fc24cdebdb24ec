"""Carrying a plan out: dispatch, monitoring, re-allocation. Robots are reached through ports alone."""

from muster.execution.executor import Executor, Happening
from muster.execution.monitor import Limits
from muster.execution.reallocation import Reallocation, Revision
from muster.execution.record import Observer, Recorder
from muster.execution.report import Report, report_of
from muster.execution.rewiring import rewire
from muster.execution.travel import travel_of, way_of

__all__ = [
    "Executor",
    "Happening",
    "Limits",
    "Observer",
    "Reallocation",
    "Recorder",
    "Report",
    "Revision",
    "report_of",
    "rewire",
    "travel_of",
    "way_of",
]
