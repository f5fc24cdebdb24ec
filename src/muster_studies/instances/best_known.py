"""The best values published of instances, of `best_known.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from muster.mission.packaged_files import packaged_data

_TABLES: Mapping[str, Mapping[str, Any]] = packaged_data("muster_studies.instances", "best_known.yaml")


def best_known(table: str) -> Mapping[str, Any]:
    """Return a table by instance, as it stands in the file."""
    return MappingProxyType(_TABLES[table])


def by_robots(table: str) -> Mapping[tuple[str, int], float]:
    """Return a table by instance and number of robots."""
    parts = {name.rpartition("-"): value for name, value in _TABLES[table].items()}
    return MappingProxyType({(name, int(robots)): value for (name, _, robots), value in parts.items()})
