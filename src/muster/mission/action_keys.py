"""The keys that each task action has in a mission file. `motion.actions` defines what the actions do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.system.plugins import Registry
from muster.mission.value_types import Fault, JsonSchema, Key, shown

ACTION_GROUP = "muster.actions"


@dataclass(frozen=True, kw_only=True)
class ActionKeys:
    """What a mission says of an action besides its name.

    Parameters
    ----------
    needed, optional
        names of fields of `model.Action`, or of `own`.
    has_geometry
        whether its cost follows from way points, so that a mission must not type it. Without geometry the robot is at
        the task's position, as in `go-to-goal`.
    own
        keys that are no fields of `model.Action`: `Action.extra` holds their values.
    """

    needed: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    has_geometry: bool = True
    own: Mapping[str, Key] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """All keys that a mission may give."""
        return (*self.needed, *self.optional)


GO_TO_GOAL = ActionKeys(has_geometry=False)
STATIONARY_OBSERVATION = ActionKeys(needed=("width_m",), optional=("heading_deg",))
RASTER_SEARCH = ActionKeys(needed=("side_m", "height_m"), optional=("spacing_m", "overlap"))
COVERAGE = ActionKeys(
    needed=("area",),
    optional=(
        "holes",
        "cross_holes",
        "height_m",
        "fov_deg",
        "width_m",
        "overlap",
        "front_overlap",
        "heading_deg",
        "split",
        "part",
    ),
)
GROUND_PATROL = ActionKeys(needed=("side_m",))
DELIVERY = ActionKeys(needed=("pickup",))
SENSOR_ACTIVATION = ActionKeys(needed=("duration_s",), has_geometry=False)

_SHIPPED = (GO_TO_GOAL, STATIONARY_OBSERVATION, RASTER_SEARCH, COVERAGE, GROUND_PATROL, DELIVERY, SENSOR_ACTIVATION)
_FIELDS = frozenset(key for keys in _SHIPPED for key in keys.names)


def keys_of(name: str, found: object) -> ActionKeys:
    """The keys of a loaded action: themselves, or those of an implementation (`motion.actions.TaskAction`).

    Raises
    ------
    ParameterError
        if it is no action, or has another name.
    """
    found = found() if isinstance(found, type) else found
    keys = found if isinstance(found, ActionKeys) else getattr(found, "keys", None)
    if not isinstance(keys, ActionKeys):
        raise ParameterError(f"it is a {type(found).__name__}; expected an action: name, keys and plan")
    called = getattr(found, "name", name)
    if called != name:
        raise ParameterError(f"it is called {called}; expected the name of its entry point")
    known = {*_FIELDS, *keys.own}
    for key in keys.names:
        if key not in known:
            raise ParameterError(f"key {key}; expected keys of {', '.join(sorted(known))}")
    return keys


ACTION_KEYS: Registry[ActionKeys] = Registry("action", ACTION_GROUP, keys_of)
"""By name, those of installed packages included. `motion.actions.register` adds to them."""


WITH_AREA: JsonSchema = {
    "required": ["action"],
    "properties": {"action": {"type": "object", "required": ["area"]}},
}
"""Of a task that may be without a position: its area has a middle."""

_FROM_CAMERA = "height_m, from which the camera looks; or width_m, the width of a tool"


def coverage_faults(values: Mapping[str, Any]) -> Iterable[Fault]:
    """What is wrong between the keys of `coverage`."""
    if values.get("width_m") is None and values.get("height_m") is None:
        yield Fault(("height_m",), "missing", _FROM_CAMERA)
    if values.get("width_m") is not None and values.get("fov_deg") is not None:
        yield Fault(("fov_deg",), shown(values["fov_deg"]), "width_m or fov_deg, not both")
    part, split = values.get("part"), values.get("split")
    if part is not None and split is None:
        yield Fault(("part",), shown(part), "split beside it: into how many parts the area is split")
    elif part is not None and part > split:
        yield Fault(("part",), shown(part), f"a whole number from 1 to split ({split})")
