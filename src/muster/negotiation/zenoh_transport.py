"""Messages over Zenoh (extra `net`): peer to peer, or through routers."""

from __future__ import annotations

from collections.abc import Sequence


class ZenohTransport:
    """A Zenoh session. `ZenohTransport(mission_name, robot, connect=("tcp/10.0.0.1:7447",))`."""

    def __init__(
        self, mission: str, robot: str, *, connect: Sequence[str] = (), listen: Sequence[str] = (), mode: str = "peer"
    ) -> None:
        raise NotImplementedError
