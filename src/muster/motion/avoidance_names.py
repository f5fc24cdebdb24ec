"""Names of the methods of collision avoidance, and which of them a mission may have."""

from __future__ import annotations

from muster.mission.errors import ParameterError
from muster.mission.values.keywords import require_one_of

AUTO, NONE = "auto", "none"
"""The method that gets all done soonest in simulated worlds (docs/avoidance.md): `hrvo` in the plane, else `orca`."""
METHODS = ("orca", "rvo", "hrvo", "avo", NONE)
AVOIDANCE = (AUTO, *METHODS)
_IN_THE_PLANE = ("rvo", "hrvo", "avo")


def require_avoidance(avoidance: str, dimensions: int) -> None:
    """Refuse a name that no method has, and methods of the plane for a mission in space.

    Raises
    ------
    ParameterError
    """
    require_one_of("avoidance", avoidance, AVOIDANCE)
    if avoidance in _IN_THE_PLANE and dimensions == 3:
        raise ParameterError(f"avoidance: {avoidance}; expected orca or none: the mission is in space")


def method_for(avoidance: str, dimensions: int) -> str:
    """The method of a name, in so many dimensions.

    Raises
    ------
    ParameterError
        as `require_avoidance`.
    """
    require_avoidance(avoidance, dimensions)
    if avoidance != AUTO:
        return avoidance
    return "hrvo" if dimensions == 2 else "orca"
