"""Messages as UDP datagrams: to explicit peers, or to a multicast group. No server."""

from __future__ import annotations

from collections.abc import Mapping

Address = tuple[str, int]


class UdpTransport:
    """Datagrams. `UdpTransport(("0.0.0.0", 7783), {"r_1": ("10.0.0.2", 7783)})`, or `UdpTransport.multicast()`."""

    def __init__(self, bind: Address, peers: Mapping[str, Address], *, room: int = 1200) -> None:
        raise NotImplementedError

    @classmethod
    def multicast(
        cls, group: Address = ("239.255.77.83", 7783), *, interface: str | None = None, hops: int = 1, room: int = 1200
    ) -> UdpTransport:
        raise NotImplementedError
