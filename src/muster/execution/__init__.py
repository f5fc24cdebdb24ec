"""Carrying a plan out: dispatch, monitoring, re-allocation. Robots are reached through ports alone."""

from muster.allocation.algorithms.rewiring import rewire
from muster.execution.executor import Executor
from muster.execution.record import Observer, Recorder
from muster.execution.replanning.reallocation import Reallocation, Revision
from muster.execution.replanning.travel import travel_of, way_of
from muster.execution.reports.broken_off import broken_off, compared_in_part
from muster.execution.reports.report import Report, report_of
from muster.execution.robots.monitor import Limits
from muster.execution.standing import Standing
from muster.execution.status import RobotStatus, Status, status_of
from muster.state import ExecutionEvent

__all__ = [
    "ExecutionEvent",
    "Executor",
    "Limits",
    "Observer",
    "Reallocation",
    "Recorder",
    "Report",
    "Revision",
    "RobotStatus",
    "Standing",
    "Status",
    "broken_off",
    "compared_in_part",
    "report_of",
    "rewire",
    "status_of",
    "travel_of",
    "way_of",
]
