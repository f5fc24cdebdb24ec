"""A world that a recorder hears, with the options that only some worlds have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from inspect import Parameter, signature
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.motion.laws import PROFILE
from muster.running.worlds import MakeWorld, world_named
from muster.simulation.batteries import NO_CHARGES, NO_DRAINS, Charges, Drains
from muster.simulation.wind import CALM, Wind

if TYPE_CHECKING:
    from muster.execution import Recorder, Report
    from muster.mission.model import Mission
    from muster.simulation import SimulatedWorld


def recorded_world(
    name: str,
    mission: Mission,
    recorder: Recorder | None,
    *,
    law: str = PROFILE,
    wind: Wind = CALM,
    batteries: Charges = NO_CHARGES,
    drain: Drains = NO_DRAINS,
    rotor_level: bool = False,
    snapshot: Mapping[str, Any] | None = None,
    **how: Any,
) -> SimulatedWorld:
    """The world of that name for a mission, which tells a recorder where bodies are.

    Raises
    ------
    ParameterError
        for a law, wind, batteries or rotors that the world does not have. Worlds of other packages need not know of
        them.
    """
    make = world_named(name)
    if recorder is not None:
        how |= {"observer": recorder.on_step, "observe_s": 0.1}
    if law != PROFILE:
        how["law"] = _taken(make, "law", law, f"expected {PROFILE}: the world {name} has no other")
    if wind.blows:
        how["wind"] = _taken(make, "wind", wind, f"expected none: the world {name} has no wind; physics has")
    if batteries:
        how["batteries"] = _taken(make, "batteries", batteries, f"expected none: the world {name} has no batteries")
    if drain:
        how["drain"] = _taken(make, "drain", drain, f"expected none: the world {name} has no batteries")
    if rotor_level:
        why = f"expected the world physics: {name} has no rotors"
        how["rotor_level"] = _taken(make, "rotor_level", rotor_level, why)
    if snapshot is not None:
        how["snapshot"] = _taken(make, "snapshot", "of bodies", f"expected none: the world {name} cannot be resumed")
        how["snapshot"] = snapshot
    return make(mission, **how)


def _taken(make: MakeWorld, option: str, value: Any, expected: str) -> Any:
    """The value, if the world takes the option."""
    taken = signature(make).parameters
    if option not in taken and not any(parameter.kind is Parameter.VAR_KEYWORD for parameter in taken.values()):
        raise ParameterError(f"{option}: {value}; {expected}")
    return value


def with_tracking(report: Report, world: SimulatedWorld) -> Report:
    """A report that tells, too, by how much robots were off the trajectories that they followed."""
    from muster.simulation.world_base import WorldBase

    error = world.tracking_error_m if isinstance(world, WorldBase) else None
    if error is None:
        return report
    remark = f"trajectories followed: off by {error[0]:.4f} m on average, {error[1]:.4f} m at most"
    return replace(report, remarks=(*report.remarks, remark))
