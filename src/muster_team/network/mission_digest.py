"""A digest of what robots must have in common to agree: the mission with its tables and maps, and the terms."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields
from hashlib import blake2b
from typing import Any

from muster.allocation.auctions.auction_terms import Terms
from muster.mission.yaml_writer import plain
from muster.model.problem import Problem
from muster.motion.map_world import World

DIGEST_BYTES = 16


def mission_digest(problem: Problem, terms: Any) -> bytes:
    """Sixteen bytes that are equal where robots take part in the same auction.

    The digest covers the meaning of the mission, not the form of its file: the order of robots, tasks and keys and the
    file's location do not count. Of files that it names the contents count: travel tables, and the cells of a map.

    Raises
    ------
    MissionError, MissingExtraError
        if the mission's map cannot be read.
    """
    mission = problem.mission
    said = {
        "mission": plain(mission),
        "robots": [plain(robot) for robot in problem.robots],
        "tasks": [plain(task) for task in problem.tasks],
        "tables": {name: [table.places, table.metres] for name, table in mission.travel_tables.items()},
        "objective": problem.objective,
        "ignored": problem.ignored,
        "fixed": problem.fixed,
        "terms": _terms(problem, terms),
    }
    del said["mission"]["robots"], said["mission"]["tasks"]
    digest = blake2b(json.dumps(_numbers_alike(said), sort_keys=True).encode(), digest_size=DIGEST_BYTES)
    if mission.map is not None and mission.map.boundary is None:
        image = World.of(mission).image
        assert image is not None
        digest.update(repr((image.shape, image.resolution_m, image.origin)).encode() + image.blocked.tobytes())
    return digest.digest()


def _numbers_alike(value: Any) -> Any:
    """Plain data in which integers are floats, as 1 equals 1.0."""
    if isinstance(value, Mapping):
        return {key: _numbers_alike(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_numbers_alike(item) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _terms(problem: Problem, terms: Any) -> dict[str, Any]:
    """The method's parameters, with its module's name; no bid stands for that of the objective."""
    said = {f.name: getattr(terms, f.name) for f in fields(terms)}
    if isinstance(terms, Terms):
        said["bid"] = terms.bid or problem.objective
    return {"of": type(terms).__module__, **said}
