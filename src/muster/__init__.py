"""Muster plans missions of robot teams: who does what, in which order.

import muster

mission = muster.load("31T-6R50")
plan = muster.solve(mission, time_limit=1.0)
assert muster.verify(mission, plan).valid
"""

from __future__ import annotations

TYPE_CHECKING = False  # `typing` takes longer to import than all that stands here
if TYPE_CHECKING:
    from typing import Any

    from muster.comparison.compare import compare
    from muster.comparison.comparison import Comparison
    from muster.execution import Report
    from muster.generation.generate import generate
    from muster.generation.generator import Generator
    from muster.library import MissionSummary, missions
    from muster.mission.errors import (
        Finding,
        InputError,
        MissingExtraError,
        MissionError,
        MusterError,
        NetworkError,
        NotSupportedError,
        ParameterError,
        PlanError,
        PluginError,
    )
    from muster.mission.model import (
        Action,
        Battery,
        Camera,
        Event,
        Found,
        Lag,
        Landmark,
        Lane,
        Lanes,
        Map,
        Mission,
        Origin,
        Robot,
        Rules,
        Station,
        Tag,
        Task,
        TeamPart,
        Zone,
    )
    from muster.mission.plan import Plan, Route
    from muster.mission.plan_reader import read_plan
    from muster.planning.exporting import export
    from muster.planning.importing import read_site
    from muster.planning.judging import verify
    from muster.planning.loading import load
    from muster.planning.options import PlanningOptions
    from muster.planning.pictures import gantt, plot
    from muster.planning.questions import check, explain
    from muster.planning.solve import solve
    from muster.running.carry_out import carry_out
    from muster.running.negotiated.simulation import Negotiation
    from muster.running.simulate import simulate
    from muster.running.simulation import Simulation
    from muster.verification import Verdict

__all__ = [
    "Action",
    "Battery",
    "Camera",
    "Comparison",
    "Event",
    "Finding",
    "Found",
    "Generator",
    "InputError",
    "Lag",
    "Landmark",
    "Lane",
    "Lanes",
    "Map",
    "MissingExtraError",
    "Mission",
    "MissionError",
    "MissionSummary",
    "MusterError",
    "Negotiation",
    "NetworkError",
    "NotSupportedError",
    "Origin",
    "ParameterError",
    "Plan",
    "PlanError",
    "PlanningOptions",
    "PluginError",
    "Report",
    "Robot",
    "Route",
    "Rules",
    "Simulation",
    "Station",
    "Tag",
    "Task",
    "TeamPart",
    "Verdict",
    "Zone",
    "carry_out",
    "check",
    "compare",
    "explain",
    "export",
    "gantt",
    "generate",
    "load",
    "missions",
    "plot",
    "read_plan",
    "read_site",
    "simulate",
    "solve",
    "verify",
]

_LOADED_AT_FIRST_USE = {
    "Action": "muster.mission.model",
    "Battery": "muster.mission.model",
    "Camera": "muster.mission.model",
    "Comparison": "muster.comparison.comparison",
    "Event": "muster.mission.model",
    "Finding": "muster.mission.errors",
    "Found": "muster.mission.model",
    "Generator": "muster.generation.generator",
    "InputError": "muster.mission.errors",
    "Lag": "muster.mission.model",
    "Landmark": "muster.mission.model",
    "Lane": "muster.mission.model",
    "Lanes": "muster.mission.model",
    "Map": "muster.mission.model",
    "MissingExtraError": "muster.mission.errors",
    "Mission": "muster.mission.model",
    "MissionError": "muster.mission.errors",
    "MissionSummary": "muster.library",
    "MusterError": "muster.mission.errors",
    "Negotiation": "muster.running.negotiated.simulation",
    "NetworkError": "muster.mission.errors",
    "NotSupportedError": "muster.mission.errors",
    "Origin": "muster.mission.model",
    "ParameterError": "muster.mission.errors",
    "Plan": "muster.mission.plan",
    "PlanError": "muster.mission.errors",
    "PlanningOptions": "muster.planning.options",
    "PluginError": "muster.mission.errors",
    "Report": "muster.execution",
    "Robot": "muster.mission.model",
    "Route": "muster.mission.plan",
    "Rules": "muster.mission.model",
    "Simulation": "muster.running.simulation",
    "Station": "muster.mission.model",
    "Tag": "muster.mission.model",
    "Task": "muster.mission.model",
    "TeamPart": "muster.mission.model",
    "Verdict": "muster.verification",
    "Zone": "muster.mission.model",
    "carry_out": "muster.running.carry_out",
    "check": "muster.planning.questions",
    "compare": "muster.comparison.compare",
    "explain": "muster.planning.questions",
    "export": "muster.planning.exporting",
    "gantt": "muster.planning.pictures",
    "generate": "muster.generation.generate",
    "load": "muster.planning.loading",
    "missions": "muster.library",
    "plot": "muster.planning.pictures",
    "read_plan": "muster.mission.plan_reader",
    "read_site": "muster.planning.importing",
    "simulate": "muster.running.simulate",
    "solve": "muster.planning.solve",
    "verify": "muster.planning.judging",
}


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


def __getattr__(name: str) -> Any:
    if name in _LOADED_AT_FIRST_USE:
        from importlib import import_module

        return getattr(import_module(_LOADED_AT_FIRST_USE[name]), name)
    if name == "__version__":
        from importlib.metadata import version

        return version("muster-robotics")
    raise AttributeError(f"module 'muster' has no attribute {name!r}")
