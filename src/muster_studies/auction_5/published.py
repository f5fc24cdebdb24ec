"""The published tables of the chapter, as the library holds them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from muster.library import as_corrected, published
from muster.verification import Verdict
from muster_studies.runs import judged

_SECTIONS = ("auction-1", "auction-2")


@cache
def content(number: str) -> Mapping[str, Any]:
    """The published table of that number."""
    tables: Mapping[str, Any] = next(data for data in map(published, _SECTIONS) if number in data["tables"])["tables"]
    found: Mapping[str, Any] = tables[number]
    return found


@cache
def paths(number: str) -> Mapping[str, tuple[str, ...]]:
    """The navigation path of each drone."""
    table = as_corrected(content(number))
    routes = {drone: route["tasks"] for drone, route in table["plans"][0]["routes"].items()} if "plans" in table else {}
    return {drone: tuple(tasks) for drone, tasks in {**table.get("paths", {}), **routes}.items()}


@cache
def judged_paths(number: str) -> Verdict:
    """The verdict on published navigation paths."""
    return judged(content(number)["plans"][0]["run_as"], (), paths(number))
