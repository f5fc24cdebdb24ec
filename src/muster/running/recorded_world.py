"""A world that a recorder hears, with the options that only some worlds have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from inspect import Parameter, signature
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.value_types import shown
from muster.mission.yaml_writer import plain
from muster.motion.laws import PROFILE
from muster.motion.noise import CALM
from muster.running.worlds import MakeWorld, world_named

if TYPE_CHECKING:
    from muster.execution import Recorder, Report
    from muster.mission.model import Mission
    from muster.running.run_request import RunRequest
    from muster.simulation import SimulatedWorld


def recorded_world(
    mission: Mission, request: RunRequest, recorder: Recorder | None, snapshot: Mapping[str, Any] | None = None
) -> SimulatedWorld:
    """The world of a request for a mission, which tells a recorder where bodies are, and goes on from a snapshot.

    Raises
    ------
    ParameterError
        for a law, wind, batteries or rotors that the world does not have. Worlds of other packages need not know of
        them.
    """
    name = request.world
    make = world_named(name)
    how = {field: getattr(request, field) for field in ("seed", "dt_s", "avoidance", "noise")}
    if recorder is not None:
        how |= {"observer": recorder.on_step, "observe_s": 0.1}
    for field, lacks in _OF_SOME_WORLDS.items():
        value = getattr(request, field)
        if value and value not in (PROFILE, CALM):
            how[field] = _taken(make, field, value, lacks.format(name))
    if snapshot is not None:
        _taken(make, "snapshot", "of bodies", f"expected none: the world {name} cannot be resumed")
        how["snapshot"] = snapshot
    return make(mission, **how)


_OF_SOME_WORLDS = {
    "law": f"expected {PROFILE}: the world {{}} has no other",
    "wind": "expected none: the world {} has no wind; physics has",
    "batteries": "expected none: the world {} has no batteries",
    "drain": "expected none: the world {} has no batteries",
    "rotor_level": "expected the world physics: {} has no rotors",
}
"""Fields of a request that only some worlds take, and what is said of others."""


def _taken(make: MakeWorld, option: str, value: Any, expected: str) -> Any:
    """The value, if the world takes the option."""
    taken = signature(make).parameters
    if option not in taken and not any(parameter.kind is Parameter.VAR_KEYWORD for parameter in taken.values()):
        raise ParameterError(f"{option}: {shown(plain(value))}; {expected}")
    return value


def with_tracking(report: Report, world: SimulatedWorld) -> Report:
    """A report that tells, too, by how much robots were off the trajectories that they followed."""
    from muster.simulation.world_base import WorldBase

    error = world.tracking_error_m if isinstance(world, WorldBase) else None
    if error is None:
        return report
    remark = f"trajectories followed: off by {error[0]:.4f} m on average, {error[1]:.4f} m at most"
    return replace(report, remarks=(*report.remarks, remark))
