"""Values of published instances with which plans are compared: the content of `references.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from muster.mission.texts.packaged_files import packaged_data


@cache
def references() -> Mapping[str, Any]:
    """Return all values, by kind."""
    return MappingProxyType(packaged_data("muster_studies.instances", "references.yaml"))


def numbered(kind: str) -> Mapping[tuple[str, int], float]:
    """Return the values of a kind by instance and number: of robots, or the seed."""
    rows = references()[kind].items()
    return MappingProxyType({(name, number): value for name, row in rows for number, value in row.items()})
