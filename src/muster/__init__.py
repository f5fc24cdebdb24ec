"""Muster plans missions of robot teams: who does what, in which order.

import muster

mission = muster.load("31T-6R50")
plan = muster.solve(mission, time_limit=1.0)
assert muster.verify(mission, plan).valid
"""

from typing import TYPE_CHECKING, Any

from muster.mission.errors import (
    Finding,
    InputError,
    MissingExtraError,
    MissionError,
    MusterError,
    NotSupportedError,
    ParameterError,
    PlanError,
)
from muster.mission.model import Event, Mission, Robot, Rules, Task
from muster.mission.plan import Plan, Route, read_plan
from muster.planning.judging import plot, verify
from muster.planning.loading import load
from muster.planning.solving import solve
from muster.running.running import carry_out, simulate

if TYPE_CHECKING:
    from muster.running.negotiated.simulation import Negotiation
    from muster.running.simulation import Simulation

__all__ = [
    "Event",
    "Finding",
    "InputError",
    "MissingExtraError",
    "Mission",
    "MissionError",
    "MusterError",
    "Negotiation",
    "NotSupportedError",
    "ParameterError",
    "Plan",
    "PlanError",
    "Robot",
    "Route",
    "Rules",
    "Simulation",
    "Task",
    "carry_out",
    "load",
    "plot",
    "read_plan",
    "simulate",
    "solve",
    "verify",
]


def __getattr__(name: str) -> Any:
    if name == "Simulation":  # carrying out is imported when it is wanted
        from muster.running.simulation import Simulation

        return Simulation
    if name == "Negotiation":
        from muster.running.negotiated.simulation import Negotiation

        return Negotiation
    if name == "__version__":
        from importlib.metadata import version

        return version("muster-robotics")
    raise AttributeError(f"module 'muster' has no attribute {name!r}")
