"""Values of published instances with which plans are compared: the content of `references.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any

import yaml


@cache
def references() -> Mapping[str, Any]:
    """Return all values, by kind."""
    content = (files("muster_studies.instances") / "references.yaml").read_text(encoding="utf-8")
    return MappingProxyType(yaml.safe_load(content))


def numbered(kind: str) -> Mapping[tuple[str, int], float]:
    """Return the values of a kind by instance and number: of robots, or the seed."""
    rows = references()[kind].items()
    return MappingProxyType({(name, number): value for name, row in rows for number, value in row.items()})
