"""The keys that each task action has in a mission file: the words of `motion.actions`, which tells what they do."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ActionKeys:
    """What a mission says of an action besides its name.

    Parameters
    ----------
    needed, optional
        names of fields of `model.Action`.
    has_geometry
        whether its cost follows from way points, so that a mission must not type it. Without geometry the robot is at
        the task's position, as in `go-to-goal`.
    """

    needed: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    has_geometry: bool = True


ACTION_KEYS: dict[str, ActionKeys] = {
    "go-to-goal": ActionKeys(has_geometry=False),
    "stationary-observation": ActionKeys(needed=("width_m",), optional=("heading_deg",)),
    "raster-search": ActionKeys(needed=("side_m", "height_m", "spacing_m")),
    "ground-patrol": ActionKeys(needed=("side_m",)),
    "delivery": ActionKeys(needed=("pickup",)),
    "sensor-activation": ActionKeys(needed=("duration_s",), has_geometry=False),
}
"""By name. `motion.actions.register` adds to them."""
