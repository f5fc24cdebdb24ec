"""The generators by name, including those of installed packages."""

from __future__ import annotations

from muster.generation.generator import Generator
from muster.mission.errors import ParameterError
from muster.mission.system.plugins import Registry, require_own_name


def _checked(name: str, found: object) -> Generator:
    if not isinstance(found, Generator):
        raise ParameterError(f"it is a {type(found).__name__}; expected a Generator")
    require_own_name(name, found.name)
    return found


GENERATORS: Registry[Generator] = Registry(
    "generator",
    "muster.generators",
    _checked,
)
