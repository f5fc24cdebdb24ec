"""Old names of modules that have moved to packages of their own: `import muster.client` still works, with a warning."""

from __future__ import annotations

import sys
import warnings
from importlib import import_module
from importlib.machinery import ModuleSpec

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import ModuleType

MOVED = {
    "muster.bridges": "muster_robots",
    "muster.client": "muster_control.client",
    "muster.comparison": "muster_studies.comparison",
    "muster.exchange": "muster_files",
    "muster.negotiation": "muster_team",
    "muster.report.film": "muster_physics.film",
    "muster.server": "muster_control",
    "muster.simulation.physics": "muster_physics",
}
"""The new name of each package, and with it of the modules in it."""


class _Moved:
    """Finds a module by an old name, and gives the one of the new name: there is one object for both."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        if not name.startswith("muster."):
            return None
        old = next((old for old in MOVED if name == old or name.startswith(f"{old}.")), None)
        return None if old is None else ModuleSpec(name, _Loader(MOVED[old] + name.removeprefix(old)))


class _Loader:
    def __init__(self, name: str) -> None:
        self._name = name

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        warnings.warn(f"{spec.name} has moved: import {self._name}", DeprecationWarning, stacklevel=2)
        self._module = import_module(self._name)
        self._spec = self._module.__spec__
        return self._module

    def exec_module(self, module: ModuleType) -> None:
        """The module is loaded already; `create_module` was about to describe it by its old name."""
        module.__spec__ = self._spec


def keep_old_names() -> None:
    """Let modules be imported by the names that they had before they moved.

    Comes before all other finders: these would find the modules of a package that has moved a second time.
    """
    sys.meta_path.insert(0, _Moved)  # type: ignore[arg-type]
