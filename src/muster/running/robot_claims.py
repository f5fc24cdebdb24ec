"""The real robots that a run commands: no two runs may have one in common."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from muster.mission.errors import MusterError, PluginError
from muster.mission.value_types import shown
from muster.running.fleet_registry import FLEETS, OpenFleet
from muster.running.worlds import WORLDS

Claims = Callable[[Mapping[str, Any]], Iterable[str]]
"""Returns what a run with some settings claims: words for robots, the same for the same robots."""


def claims(of: Claims) -> Callable[[OpenFleet], OpenFleet]:
    """Declare what runs with a fleet claim: two runs that claim the same never command robots at the same time.

    A fleet without a declaration is claimed as a whole: one run at a time.

    Parameters
    ----------
    of : callable
        Returns the claims of a run by its settings, such as `[settings["url"]]`; it is called before the fleet is
        opened, in another process.
    """

    def declared(open_fleet: OpenFleet) -> OpenFleet:
        open_fleet.claims = of  # type: ignore[attr-defined]
        return open_fleet

    return declared


def claims_of(world: str, settings: Mapping[str, Any]) -> frozenset[str]:
    """Return what a run claims, in words: what its fleet declares, else the fleet; nothing in a simulated world.

    Raises
    ------
    ParameterError, PluginError
        if there is no such fleet, its package cannot be loaded, or its declaration is no list of texts.
    """
    if world in WORLDS:
        return frozenset()
    of = getattr(FLEETS.named(world), "claims", None)
    if of is None:
        return frozenset({f"fleet {world}"})
    try:
        found = list(of(settings))
    except Exception as error:  # the code of another package may raise anything
        raise PluginError(f"fleet {world}: its claims: {type(error).__name__}: {error}") from error
    if not all(isinstance(claim, str) for claim in found):
        raise PluginError(f"fleet {world}: its claims: {shown(found)}; expected texts")
    return frozenset(found)


def claims_as_far_as_known(world: str, settings: Mapping[str, Any]) -> frozenset[str]:
    """As `claims_of`; the whole fleet where its package cannot be loaded any more."""
    try:
        return claims_of(world, settings)
    except MusterError:
        return frozenset({f"fleet {world}"})


def ros1_claims(settings: Mapping[str, Any]) -> Iterator[str]:
    """Yield a namespace, whichever the master, for one master goes by many names."""
    yield f"{_namespace(settings)} of ROS 1"


def ros2_claims(settings: Mapping[str, Any]) -> Iterator[str]:
    """Yield a namespace of a domain."""
    domain = settings.get("domain")
    text = (os.environ.get("ROS_DOMAIN_ID") or "0") if domain is None else str(domain)
    yield f"{_namespace(settings)} of domain {text.strip().lstrip('0') or '0'} of ROS 2"


def _namespace(settings: Mapping[str, Any]) -> str:
    name = str(settings.get("namespace", "")).strip().strip("/")
    return f"namespace {name}" if name else "the root namespace"


def mavlink_claims(settings: Mapping[str, Any]) -> Iterator[str]:
    """Yield each line (a UDP port that is listened at, an address that is called, a device).

    Which systems are on a line does not matter: two processes do not share one.
    """
    for endpoint in settings.get("endpoints", {}).values():
        yield _line(endpoint.partition("#")[0].strip())


def _line(text: str) -> str:
    """A normalised name of a line."""
    if listens := re.fullmatch(r"udp(?:in)?:[^:]+:0*(\d+)", text):
        return f"UDP port {listens[1]}"
    if wire := re.fullmatch(r"serial:([^:]+)(?::\d+)?", text):
        return f"device {os.path.realpath(wire[1])}"
    return text.lower()
