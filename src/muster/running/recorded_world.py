"""A world that a recorder hears, with the options that only some worlds have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.value_types import shown
from muster.mission.yaml_writer import plain
from muster.motion.laws import PROFILE
from muster.motion.noise import CALM
from muster.running.worlds import MakeWorld, takes_setting, world_named, worlds_that

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
        for a setting that the world does not take. Worlds of other packages need not know of all.
    """
    from muster.simulation.declaration import SETTINGS

    name = request.world
    make = world_named(name)
    how = {field: getattr(request, field) for field in ("seed", "dt_s", "avoidance", "noise")}
    if recorder is not None:
        how |= {"observer": recorder.on_step, "observe_s": 0.1}
    for field in [setting for setting in SETTINGS if setting != "snapshot"]:
        value = getattr(request, field)
        if value and value not in (PROFILE, CALM):
            _require_taken(make, name, field, value)
            how[field] = value
    if snapshot is not None:
        _require_taken(make, name, "snapshot", "of bodies")
        how["snapshot"] = snapshot
    return make(mission, **how)


def _require_taken(make: MakeWorld, world: str, setting: str, value: Any) -> None:
    """Raise `ParameterError` unless a world takes a setting."""
    from muster.simulation.declaration import SETTINGS

    if takes_setting(make, setting):
        return
    lacks = SETTINGS[setting]
    others = worlds_that(lambda other: takes_setting(other, setting)) if "{others}" in lacks else ""
    expected = lacks.format(world=world, others=others)
    raise ParameterError(f"{setting}: {shown(plain(value))}; {expected}")


def with_tracking(report: Report, world: SimulatedWorld) -> Report:
    """A report that tells, too, by how much robots were off the trajectories that they followed."""
    from muster.simulation.world_base import WorldBase

    error = world.tracking_error_m if isinstance(world, WorldBase) else None
    if error is None:
        return report
    remark = f"trajectories followed: off by {error[0]:.4f} m on average, {error[1]:.4f} m at most"
    return replace(report, remarks=(*report.remarks, remark))
