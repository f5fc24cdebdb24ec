"""Muster plans missions of robot teams: who does what, in which order.

import muster

mission = muster.load("31T-6R50")
plan = muster.solve(mission, time_limit=1.0)
assert muster.verify(mission, plan).valid
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # `typing` takes longer to import than all that stands here
if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec
    from typing import Any

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
    from muster.mission.reading.plan_reader import read_plan
    from muster.planning.exporting import export
    from muster.planning.judging import verify
    from muster.planning.loading import load
    from muster.planning.options import PlanningOptions
    from muster.planning.pictures import gantt, plot
    from muster.planning.questions import check, explain
    from muster.planning.solve import solve
    from muster.running.carry_out import carry_out
    from muster.running.simulate import simulate
    from muster.running.simulation import Simulation
    from muster.verification import Verdict
    from muster_files.importing import read_site
    from muster_studies.comparison.compare import compare
    from muster_studies.comparison.comparison import Comparison
    from muster_team.runs.negotiation import Negotiation

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

_NAMES_OF = {
    "muster_studies.comparison.compare": "compare",
    "muster_studies.comparison.comparison": "Comparison",
    "muster.execution": "Report",
    "muster.generation.generate": "generate",
    "muster.generation.generator": "Generator",
    "muster.library": "MissionSummary missions",
    "muster.mission.errors": (
        "Finding InputError MissingExtraError MissionError MusterError NetworkError NotSupportedError "
        "ParameterError PlanError PluginError"
    ),
    "muster.mission.model": (
        "Action Battery Camera Event Found Lag Landmark Lane Lanes Map Mission Origin Robot Rules Station Tag "
        "Task TeamPart Zone"
    ),
    "muster.mission.plan": "Plan Route",
    "muster.mission.reading.plan_reader": "read_plan",
    "muster.planning.exporting": "export",
    "muster_files.importing": "read_site",
    "muster.planning.judging": "verify",
    "muster.planning.loading": "load",
    "muster.planning.options": "PlanningOptions",
    "muster.planning.pictures": "gantt plot",
    "muster.planning.questions": "check explain",
    "muster.planning.solve": "solve",
    "muster.running.carry_out": "carry_out",
    "muster_team.runs.negotiation": "Negotiation",
    "muster.running.simulate": "simulate",
    "muster.running.simulation": "Simulation",
    "muster.verification": "Verdict",
}
"""By module the names that are loaded from it at their first use."""
_MODULE_OF = {name: module for module, names in _NAMES_OF.items() for name in names.split()}

_MOVED = {
    "muster.allocation.problem": "muster.model.problem",
    "muster.bridges": "muster_robots",
    "muster.client": "muster_control.client",
    "muster.comparison": "muster_studies.comparison",
    "muster.exchange": "muster_files",
    "muster.negotiation.memory_network": "muster_team.network.memory_network",
    "muster.negotiation.methods": "muster_team.negotiators.methods",
    "muster.negotiation.robot_view": "muster_team.negotiators.robot_view",
    "muster.negotiation": "muster_team",
    "muster.report.film": "muster_physics.film",
    "muster.server": "muster_control",
    "muster.simulation.physics": "muster_physics",
}
"""The new names of packages that have moved, with all that is in them, and of documented modules that moved again.

The old names can still be imported. A module stands before its package.
"""


class _OldNames:
    """Finds modules by the names that they had before they moved.

    It comes before other finders: these would find what is in a package that has moved a second time.
    """

    @staticmethod
    def find_spec(name: str, *_: object) -> ModuleSpec | None:
        old = name.startswith("muster.") and next((o for o in _MOVED if f"{name}.".startswith(f"{o}.")), None)
        if not old:
            return None
        from muster.mission.system.moved import moved

        return moved(name, _MOVED[old] + name.removeprefix(old))


sys.meta_path.insert(0, _OldNames)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


def __getattr__(name: str) -> Any:
    if name in _MODULE_OF:
        from importlib import import_module

        return getattr(import_module(_MODULE_OF[name]), name)
    if name == "__version__":
        from importlib.metadata import version

        return version("muster-robotics")
    raise AttributeError(f"module 'muster' has no attribute {name!r}")
