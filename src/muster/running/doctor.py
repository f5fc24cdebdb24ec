"""Whether what is installed works: every optional package is imported in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from importlib.metadata import packages_distributions

from muster.mission.system.installation import Part
from muster.mission.system.platforms import usable_processors

_LONGEST_IMPORT_S = 120.0


@dataclass(frozen=True, kw_only=True)
class ExtraHealth:
    """One extra: what it needs, what of it is missing, and for packages that cannot be imported the reason."""

    name: str
    parts: tuple[Part, ...]
    faults: Mapping[str, str]

    @property
    def missing(self) -> tuple[str, ...]:
        return tuple(part.name for part in self.parts if part.version is None)

    @property
    def state(self) -> str:
        """`broken`, `absent` (nothing of its own is there), `incomplete` or `works`."""
        if self.faults:
            return "broken"
        if not self.missing:
            return "works"
        return "absent" if len(self.missing) == len(self.parts) else "incomplete"


def health(extras: Mapping[str, tuple[Part, ...]]) -> tuple[ExtraHealth, ...]:
    """The state of each extra; `extras` as `muster.mission.system.installation.extras` gives them."""
    faults = import_faults({p.name for parts in extras.values() for p in parts if p.version is not None})
    return tuple(
        ExtraHealth(name=name, parts=parts, faults={p.name: faults[p.name] for p in parts if p.name in faults})
        for name, parts in extras.items()
    )


def import_faults(packages: Iterable[str]) -> dict[str, str]:
    """Why packages cannot be imported, of those that cannot; one crashing takes no other with it."""
    names = sorted(packages)
    with ThreadPoolExecutor(usable_processors()) as pool:
        return {name: fault for name, fault in zip(names, pool.map(_fault, names), strict=True) if fault}


def _fault(package: str) -> str | None:
    command = [sys.executable, "-c", f"import {module_of(package)}"]
    try:
        ended = subprocess.run(command, capture_output=True, timeout=_LONGEST_IMPORT_S, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return f"not imported within {_LONGEST_IMPORT_S:g} s"
    said = ended.stderr.decode(errors="replace").strip().splitlines()
    if ended.returncode == 0:
        return None
    return said[-1] if said and ended.returncode > 0 else f"crashes when imported (exit code {ended.returncode})"


def module_of(package: str) -> str:
    """The module of an installed package: of the public ones that it brings that whose name is most of its own."""
    own = _as_name(package)
    public = sorted(module for module in _modules().get(own, ()) if not module.startswith("_"))
    return max(public, key=lambda module: len(module) * (module.lower() in own), default=package)


@cache
def _modules() -> Mapping[str, list[str]]:
    """The modules of each installed package."""
    found: dict[str, list[str]] = {}
    for module, packages in packages_distributions().items():
        for package in packages:
            found.setdefault(_as_name(package), []).append(module)
    return found


def _as_name(package: str) -> str:
    return package.lower().replace("-", "_").replace(".", "_")
