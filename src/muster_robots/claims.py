"""What runs with the fleets of the bridges claim: no two runs may command the same robots."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from muster_robots.fleet_settings import MavlinkSettings, Ros1Settings, Ros2Settings, RosSettings


def ros1_claims(settings: Ros1Settings) -> Iterator[str]:
    """Yield a namespace, whichever the master, for one master goes by many names."""
    yield f"{_namespace(settings)} of ROS 1"


def ros2_claims(settings: Ros2Settings) -> Iterator[str]:
    """Yield a namespace of a domain."""
    domain = settings.domain
    text = (os.environ.get("ROS_DOMAIN_ID") or "0") if domain is None else str(domain)
    yield f"{_namespace(settings)} of domain {text.strip().lstrip('0') or '0'} of ROS 2"


def _namespace(settings: RosSettings) -> str:
    name = settings.namespace.strip("/")
    return f"namespace {name}" if name else "the root namespace"


def mavlink_claims(settings: MavlinkSettings) -> Iterator[str]:
    """Yield each line (a UDP port that is listened at, an address that is called, a device).

    Which systems are on a line does not matter: two processes do not share one.
    """
    for endpoint in settings.endpoints.values():
        yield _line(endpoint.partition("#")[0].strip())


def _line(text: str) -> str:
    """A normalised name of a line."""
    if listens := re.fullmatch(r"udp(?:in)?:[^:]+:0*(\d+)", text):
        return f"UDP port {listens[1]}"
    if wire := re.fullmatch(r"serial:([^:]+)(?::\d+)?", text):
        return f"device {os.path.realpath(wire[1])}"
    return text.lower()
