"""The generators by name, including those of installed packages."""

from __future__ import annotations

from muster.generation.generator import Generator
from muster.mission.errors import ParameterError
from muster.mission.plugins import Registry, require_own_name


def _checked(name: str, found: object) -> Generator:
    if not isinstance(found, Generator):
        raise ParameterError(f"it is a {type(found).__name__}; expected a Generator")
    require_own_name(name, found.name)
    return found


GENERATORS: Registry[Generator] = Registry(
    "generator",
    "muster.generators",
    {
        "uniform": "muster.generation.uniform:UNIFORM",
        "clustered": "muster.generation.clustered:CLUSTERED",
        "heterogeneous": "muster.generation.heterogeneous:HETEROGENEOUS",
        "orienteering": "muster.generation.orienteering:ORIENTEERING",
        "ordered": "muster.generation.ordered:ORDERED",
        "precedence": "muster.generation.precedence:PRECEDENCE",
        "windows": "muster.generation.windows:WINDOWS",
        "customers": "muster.generation.customers:CUSTOMERS",
        "transports": "muster.generation.transports:TRANSPORTS",
        "charging": "muster.generation.charging:CHARGING",
        "teams": "muster.generation.teams:TEAMS",
        "coalitions": "muster.generation.coalitions:COALITIONS",
        "warehouse": "muster.generation.warehouse:WAREHOUSE",
        "drones": "muster.generation.drones:DRONES",
        "moving": "muster.generation.moving:MOVING",
        "mixed": "muster.generation.mixed:MIXED",
    },
    _checked,
)
