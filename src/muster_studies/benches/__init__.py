"""The benches of `muster bench`: functions of a number of runs. Each module is imported when its bench runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from types import MappingProxyType

from muster_studies.benches.measurement import Measurement

Bench = Callable[[int], list[Measurement]]

BENCHES: Mapping[str, str] = MappingProxyType(
    {
        "greedy-small": "allocation:greedy_small",
        "genetic": "allocation:genetic_iterations",
        "greedy-large": "allocation:greedy_large",
        "auction-large": "allocation:auction_large",
        "search": "search_quality:search_quality",
        "schedules": "schedules:schedules",
        "avoidance": "avoidance:avoidance",
        "start-up": "start_up:start_up",
        "path": "motion:across_a_grid",
        "travel": "motion:travel",
        "paths": "paths:paths",
        "simulation": "simulation:simulation",
        "physics": "physics:physics",
        "lasers": "lasers:lasers",
        "perception": "perception:perception",
        "reallocation": "execution:reallocation",
        "standing": "standing:hour",
        "standing-live": "standing:live",
        "standing-charging": "standing:charging",
        "lifelong": "lifelong_lanes:small",
        "lifelong-large": "lifelong_lanes:large",
        "standing-rule": "standing:by_nearest_free",
        "auction": "auction:auction",
        "ros1": "ros1:ros1",
        "traffic": "joint_paths:traffic",
        "server-start": "server:start",
        "server-watched": "server:watched",
        "server-queue": "server:queued",
    }
)
"""The benches by name: the module in this package, and the function."""


def bench_named(name: str) -> Bench:
    """The bench of that name, which BENCHES has.

    Raises
    ------
    MissingExtraError
        if its module needs a part that is not installed.
    """
    module, function = BENCHES[name].split(":")
    bench: Bench = getattr(import_module(f"{__name__}.{module}"), function)
    return bench
