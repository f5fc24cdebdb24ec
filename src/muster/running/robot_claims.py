"""The real robots that a run commands: no two runs may have one in common."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from muster.mission.errors import MusterError, PluginError
from muster.mission.value_types import shown
from muster.running.fleet_registry import FLEETS
from muster.running.run_request import RunRequest
from muster.running.worlds import WORLDS


def claims_of_request(request: RunRequest) -> frozenset[str]:
    """Return what a run claims, in words: what its fleet declares, else the fleet; nothing in a simulated world.

    Raises
    ------
    PluginError
        if the package of the fleet cannot be loaded, or its declaration is no list of texts.
    """
    world = request.world
    if world in WORLDS:
        return frozenset()
    of = FLEETS.named(world).claims
    if of is None:
        return frozenset({f"fleet {world}"})
    try:
        found = list(of(request.settings))
    except Exception as error:  # the code of another package may raise anything
        raise PluginError(f"fleet {world}: its claims: {type(error).__name__}: {error}") from error
    if not all(isinstance(claim, str) for claim in found):
        raise PluginError(f"fleet {world}: its claims: {shown(found)}; expected texts")
    return frozenset(found)


def claims_of(world: str, settings: Mapping[str, Any]) -> frozenset[str]:
    """Return what a run claims by its settings in the form of the API; see `claims_of_request`."""
    return claims_of_request(RunRequest.from_settings(world, settings))


def claims_as_far_as_known(world: str, settings: Mapping[str, Any]) -> frozenset[str]:
    """As `claims_of`; the whole fleet where its package cannot be loaded any more."""
    try:
        return claims_of(world, settings)
    except MusterError:
        return frozenset({f"fleet {world}"})
