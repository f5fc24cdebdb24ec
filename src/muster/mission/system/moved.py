"""Modules that have moved to packages of their own, by their old names."""

from __future__ import annotations

import warnings
from importlib import import_module
from importlib.abc import Loader
from importlib.machinery import ModuleSpec
from types import ModuleType


class _Loader(Loader):
    """Gives the module of the new name under the old one: there is one object for both."""

    def __init__(self, name: str) -> None:
        self._name = name

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        warnings.warn(f"{spec.name} has moved: import {self._name}", DeprecationWarning, stacklevel=2)
        self._module = import_module(self._name)
        self._spec = self._module.__spec__
        return self._module

    def exec_module(self, module: ModuleType) -> None:
        """The module is loaded already; the import system has just described it by its old name."""
        module.__spec__ = self._spec


def moved(old: str, new: str) -> ModuleSpec:
    """What imports the module of a new name where the old one is asked for."""
    return ModuleSpec(old, _Loader(new))
