"""The real robots that a run commands: no two runs may have one in common."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from muster.mission.errors import MusterError
from muster.running.worlds import WORLDS


def claims_of(world: str, settings: Mapping[str, Any]) -> frozenset[str]:
    """What a run claims, in words; nothing in a simulated world.

    On ROS 1 that is a namespace, whichever the master, for one master goes by many names. On ROS 2 it is a namespace
    of a domain. Over MAVLink it is each line (a UDP port that is listened at, an address that is called, a device),
    whichever systems are on it: two processes do not share one. A fleet of another package declares its claims by
    `muster.running.fleets.claims`; one that does not is claimed as a whole.

    Raises
    ------
    PluginError
        if a fleet of another package cannot be loaded, or declares what is no list of texts.
    """
    if world in WORLDS:
        return frozenset()
    if world in _CLAIMS:
        return frozenset(_CLAIMS[world](settings))
    from muster.running.fleets import declared_claims

    declared = declared_claims(world, settings)
    return frozenset({f"fleet {world}"}) if declared is None else declared


def claims_as_far_as_known(world: str, settings: Mapping[str, Any]) -> frozenset[str]:
    """As `claims_of`; the whole fleet where its package cannot be loaded any more."""
    try:
        return claims_of(world, settings)
    except MusterError:
        return frozenset({f"fleet {world}"})


def _ros1(settings: Mapping[str, Any]) -> Iterator[str]:
    yield f"{_namespace(settings)} of ROS 1"


def _ros2(settings: Mapping[str, Any]) -> Iterator[str]:
    domain = settings.get("domain")
    text = (os.environ.get("ROS_DOMAIN_ID") or "0") if domain is None else str(domain)
    yield f"{_namespace(settings)} of domain {text.strip().lstrip('0') or '0'} of ROS 2"


def _namespace(settings: Mapping[str, Any]) -> str:
    name = str(settings.get("namespace", "")).strip().strip("/")
    return f"namespace {name}" if name else "the root namespace"


def _mavlink(settings: Mapping[str, Any]) -> Iterator[str]:
    for endpoint in settings.get("endpoints", {}).values():
        yield _line(endpoint.partition("#")[0].strip())


def _line(text: str) -> str:
    """A normalised name of a line."""
    if listens := re.fullmatch(r"udp(?:in)?:[^:]+:0*(\d+)", text):
        return f"UDP port {listens[1]}"
    if wire := re.fullmatch(r"serial:([^:]+)(?::\d+)?", text):
        return f"device {os.path.realpath(wire[1])}"
    return text.lower()


_CLAIMS: Mapping[str, Callable[[Mapping[str, Any]], Iterator[str]]] = {
    "ros1": _ros1,
    "ros2": _ros2,
    "mavlink": _mavlink,
}
