"""The allocators of a comparison: registered ones, those of a module of one's own, functions."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from importlib import import_module
from pathlib import Path
from typing import Any

from muster.allocation.algorithms.function_allocator import AllocatingFunction
from muster.allocation.allocator import Allocator, make_parameters
from muster.allocation.registry import allocator_of
from muster.mission.errors import MusterError, ParameterError
from muster.mission.value_types import shown
from muster_studies.comparison.specs import spec_of

AllocatorSpec = str | Allocator | AllocatingFunction
"""A name with parameters, `genetic:population_size=40`; MODULE:NAME; an allocator; a function that makes routes."""


@dataclass(frozen=True)
class Contestant:
    """An allocator of a comparison.

    Parameters
    ----------
    name
        what results call it.
    what
        the name of a registered allocator, MODULE:NAME, an allocator or a function.
    values
        of its parameters, by name.
    """

    name: str
    what: AllocatorSpec
    values: Mapping[str, Any] = field(default_factory=dict)

    def allocator(self) -> Allocator:
        """The allocator itself.

        Raises
        ------
        ParameterError, PluginError
            if there is none.
        """
        if isinstance(self.what, str) and ":" in self.what:
            return allocator_of(_imported(self.what))
        return allocator_of(self.what)

    def parameters(self, allocator: Allocator) -> Any:
        """The allocator's parameters; one thread where it has a choice, as all runs have one processor each.

        Raises
        ------
        ParameterError
            for a parameter that it does not have, or a value out of range.
        """
        has_threads = any(f.name == "threads" for f in fields(allocator.parameters))
        try:
            return make_parameters(allocator, ({"threads": 1} if has_threads else {}) | dict(self.values))
        except ParameterError as error:
            said = str(error)
            raise ParameterError(
                said if said.startswith(f"{allocator.name} ") else f"allocator {self.name}: {said}"
            ) from None


def contestants_of(given: AllocatorSpec | Iterable[AllocatorSpec] | Mapping[str, AllocatorSpec]) -> list[Contestant]:
    """The contestants that are meant: one or several, or by the names that results shall call them.

    Raises
    ------
    ParameterError
        if one cannot be used, or two have one name.
    """
    if isinstance(given, str | Allocator) or callable(given):
        given = [given]
    named = given.items() if isinstance(given, Mapping) else ((None, one) for one in given)
    found: dict[str, Contestant] = {}
    for name, what in named:
        contestant = _contestant(name, what)
        if contestant.name in found:
            raise ParameterError(
                f"allocators: {contestant.name} twice; expected names of their own: {{name: allocator}}"
            )
        contestant.parameters(contestant.allocator())
        found[contestant.name] = contestant
    if not found:
        raise ParameterError("allocators: none; expected one at least")
    return list(found.values())


def _contestant(name: str | None, what: object) -> Contestant:
    if isinstance(what, str):
        spec = spec_of(what)
        return Contestant(name or what, spec.name, spec.values)
    if isinstance(what, Allocator):
        return Contestant(name or what.name, what)
    if callable(what):
        return Contestant(name or str(getattr(what, "__name__", type(what).__name__)), what)
    raise ParameterError(f"allocators: {shown(what)}; expected a name, MODULE:NAME, an Allocator or a function")


def _imported(path: str) -> Any:
    """What MODULE:NAME stands for, of a file in this folder or an installed package.

    Raises
    ------
    ParameterError
        if there is none, or the module cannot be loaded.
    """
    module, _, name = path.partition(":")
    with_folder = str(Path.cwd())
    if with_folder not in sys.path:
        sys.path.insert(0, with_folder)
    try:
        found: Any = import_module(module)
        for part in name.split("."):
            found = getattr(found, part)
    except MusterError:
        raise
    except Exception as error:  # the code of others may raise anything
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        raise ParameterError(f"allocator {path}: {reason}; expected MODULE:NAME, from here or installed") from None
    return found
