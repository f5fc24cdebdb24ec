"""Implementations of an interface by name: those that ship, and those that installed packages register.

Each interface has a group of entry points, such as `muster.allocators`; what ships is declared in the same way, in
`pyproject.toml`. Nothing is imported before it is looked up by name.
"""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import cache, cached_property
from importlib.metadata import EntryPoint, distribution, entry_points
from typing import Any, Generic, TypeVar

from muster.mission.errors import MusterError, ParameterError, PluginError
from muster.mission.system.installation import DISTRIBUTION
from muster.mission.values.keywords import require_one_of

T = TypeVar("T")


def declared(group: str) -> tuple[EntryPoint, ...]:
    """The entry points of a group: first those of this distribution, in the order of `pyproject.toml`."""
    return _declared(group, tuple(sys.path))


@cache
def _declared(group: str, path: tuple[str, ...]) -> tuple[EntryPoint, ...]:
    return tuple(sorted(_installed(path).select(group=group), key=lambda entry: not is_shipped(entry)))


_installed = cache(lambda path: entry_points())
"""Entry points of all packages on a path; reading them takes longer than anything else that a lookup does."""


_own = cache(lambda path: frozenset(distribution(DISTRIBUTION).entry_points))
"""Entry points of this distribution: to ask each entry point for its package reads the metadata of that every time."""


def is_shipped(entry: EntryPoint) -> bool:
    """Whether an entry point is one of this distribution."""
    return entry in _own(tuple(sys.path))


class Registry(Mapping[str, T], Generic[T]):
    """The implementations of one interface, by name; those that ship come first, in the order given.

    Parameters
    ----------
    what
        one implementation, in a word, for messages: `allocator`.
    group
        the group of entry points in which packages register theirs.
    checked
        returns a loaded object as an implementation of that name; raises ParameterError where it is none.
    """

    def __init__(self, what: str, group: str, checked: Callable[[str, object], T]) -> None:
        self._what = what
        self._group = group
        self._checked = checked
        self._loaded: dict[str, T] = {}

    @property
    def shipped(self) -> tuple[str, ...]:
        """The names of the implementations that ship."""
        return tuple(entry.name for entry in declared(self._group) if is_shipped(entry))

    def __getitem__(self, name: str) -> T:
        """The implementation of that name.

        Raises
        ------
        KeyError
            if there is none.
        PluginError
            if its package cannot be loaded, or two packages register the name.
        """
        if name not in self._loaded:
            self._loaded[name] = self._load(name, self._entries[name])
        return self._loaded[name]

    def __contains__(self, name: object) -> bool:
        """Whether there is an implementation of that name; it is not loaded."""
        return name in self._entries

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def named(self, name: str) -> T:
        """The implementation of that name.

        Raises
        ------
        ParameterError
            if there is none.
        PluginError
            if its package cannot be loaded, or two packages register the name.
        """
        require_one_of(self._what, name, self)
        return self[name]

    def usable(self) -> dict[str, T]:
        """All implementations that can be loaded, by name; a warning names each package that cannot."""
        found: dict[str, T] = {}
        for name in self:
            try:
                found[name] = self[name]
            except MusterError as error:
                logging.getLogger("muster").warning("%s", error)
        return found

    def add(self, name: str, implementation: T) -> None:
        """Make an implementation known in this process.

        Raises
        ------
        ParameterError
            if the name is taken.
        """
        if name in self._entries:
            raise ParameterError(f"{self._what}: {name}; expected a name that no {self._what} has yet")
        try:
            self._loaded[name] = self._checked(name, implementation)
        except ParameterError as error:
            raise ParameterError(f"{self._what} {name}: {error}") from None
        self._entries[name] = []

    def remove(self, name: str) -> None:
        """Forget an implementation that `add` made known."""
        del self._loaded[name], self._entries[name]

    @cached_property
    def _entries(self) -> dict[str, list[EntryPoint]]:
        """The entry points by name; more than one where packages dispute the name."""
        found: dict[str, list[EntryPoint]] = {}
        for entry in declared(self._group):
            named = found.setdefault(entry.name, [])
            if all(other.value != entry.value for other in named):
                named.append(entry)
        return found

    def _load(self, name: str, entries: list[EntryPoint]) -> T:
        if len(entries) > 1:
            packages = " and ".join(map(_package, entries))
            raise PluginError(f"{self._what} {name}: registered by {packages}; expected one package for a name")
        (entry,) = entries
        try:
            return self._checked(name, entry.load())
        except ParameterError as error:
            raise PluginError(f"{self._what} {name} of the package {_package(entry)}: {error}") from None
        except MusterError:
            raise  # a missing extra says itself what to install
        except Exception as error:
            reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
            line = f"{self._what} {name} of the package {_package(entry)}: cannot be loaded: {reason}"
            raise PluginError(line) from error


def _package(entry: EntryPoint) -> str:
    return "unknown" if entry.dist is None else f"{entry.dist.name} {entry.dist.version}"


def function_expected(expected: str) -> Callable[[str, object], Any]:
    """What checks implementations that are functions or classes; `expected` says in messages what they should be."""

    def checked(name: str, found: object) -> Any:
        if not callable(found):
            raise ParameterError(f"it is a {type(found).__name__}; expected {expected}")
        return found

    return checked


def instance_expected(kind: type[T], expected: str = "") -> Callable[[str, object], T]:
    """Return the check of implementations that are instances of a class, and of the name that one says it has.

    Parameters
    ----------
    kind : type
        The class.
    expected : str
        How messages call what should be registered; by default `a` and the name of the class.
    """

    def checked(name: str, found: object) -> T:
        if not isinstance(found, kind):
            raise ParameterError(f"it is a {type(found).__name__}; expected {expected or f'a {kind.__name__}'}")
        require_own_name(name, getattr(found, "name", name))
        return found

    return checked


def declaring(**facts: object) -> Callable[[T], T]:
    """What marks an implementation with facts about itself, as attributes of these names."""

    def declared(implementation: T) -> T:
        for name, fact in facts.items():
            setattr(implementation, name, fact)
        return implementation

    return declared


def require_words(what: str, words: Collection[str], known: Collection[str]) -> None:
    """Refuse a declaration that uses other words than those that are known.

    Raises
    ------
    ParameterError
    """
    if unknown := [word for word in words if word not in known]:
        raise ParameterError(f"{what}: {unknown[0]}; expected {', '.join(known)}")


def require_own_name(name: str, own: str) -> None:
    """Refuse an implementation that is called otherwise than its entry point.

    Raises
    ------
    ParameterError
    """
    if own != name:
        raise ParameterError(f"it is called {own}; expected the name of its entry point")
