"""The allocators by name, including those of installed packages."""

from __future__ import annotations

from muster.allocation.algorithms.function_allocator import AllocatingFunction, allocator_from
from muster.allocation.allocator import Allocator
from muster.allocation.capabilities import offer
from muster.mission.errors import ParameterError
from muster.mission.system.plugins import Registry, require_own_name
from muster.mission.value_types import shown


def _checked(name: str, found: object) -> Allocator:
    allocator = found if isinstance(found, Allocator) else allocator_from(found, name)
    require_own_name(name, allocator.name)
    return allocator


ALLOCATORS: Registry[Allocator] = Registry(
    "allocator",
    "muster.allocators",
    _checked,
)

offer(lambda: {name: allocator.can for name, allocator in ALLOCATORS.usable().items()})


def allocator_named(name: str) -> Allocator:
    """The allocator of that name.

    Raises
    ------
    ParameterError
        if there is none.
    PluginError
        if its package cannot be loaded.
    """
    return ALLOCATORS.named(name)


def allocator_of(given: str | Allocator | AllocatingFunction) -> Allocator:
    """The allocator that is meant: by its name, itself, or a function that makes routes (`allocator_from`).

    Raises
    ------
    ParameterError
        if there is none of that name, or the function cannot be called as an allocator.
    PluginError
        if its package cannot be loaded.
    """
    if isinstance(given, str):
        return allocator_named(given)
    if isinstance(given, Allocator):
        return given
    if not callable(given):
        raise ParameterError(f"allocator: {shown(given)}; expected a name, an Allocator or a function")
    return allocator_from(given)
