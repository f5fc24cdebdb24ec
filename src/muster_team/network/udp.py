"""Messages as UDP datagrams, to explicit peers or to a multicast group. No server.

A datagram larger than a link's packet is fragmented, and lost with any fragment. `room` is the size that fits
everywhere (`Codec.parts` keeps to it); larger data is sent all the same.
"""

from __future__ import annotations

import select
import socket
from collections.abc import Mapping
from os import fstat
from pathlib import Path
from typing import Any, Self
from zlib import crc32

from muster.mission.errors import NetworkError, ParameterError

Address = tuple[str, int]

PORT = 7783
GROUP: Address = ("239.255.77.83", PORT)
"""A group of administrative scope (RFC 2365): routers do not carry it out of a site."""

ROOM = 1200
"""Bytes of a datagram that every link takes: 1280, the least of IPv6, less headers and those of a tunnel."""

_LARGEST = 65_507
_BUFFER = 4 * 1024 * 1024  # for bursts while the robot thinks; the machine may grant less
_AT_ONCE = 4096

_TO_ALL = bytes(4)
_FOR = len(_TO_ALL)  # bytes at the front of a datagram to a group: its addressee

_Sockaddr = tuple[Any, ...]


class UdpTransport:
    """Datagrams from one socket.

    Parameters
    ----------
    bind
        host and port on which to listen; port 0: any that is free; host `0.0.0.0` or `::`: all of this machine's.
    peers
        host and port of each other robot. A message to a robot that is not among them is sent to all.
    room
        as `Transport.room`.

    Attributes
    ----------
    address
        host and port on which it listens.

    Raises
    ------
    NetworkError
        if a host is unknown, the port is in use, or the machine has no such address.
    """

    def __init__(self, bind: Address, peers: Mapping[str, Address], *, room: int = ROOM) -> None:
        family, own = _resolved(bind, socket.AF_UNSPEC)
        self._open(family, room, {name: _resolved(peer, family)[1] for name, peer in peers.items()})
        try:
            self._socket.bind(own)
        except OSError as error:
            self.close()
            raise _cannot_listen(bind, error) from None

    @classmethod
    def multicast(
        cls,
        group: Address = GROUP,
        *,
        robot: str | None = None,
        interface: str = "0.0.0.0",  # noqa: S104
        hops: int = 1,
        room: int = ROOM,
    ) -> Self:
        """Datagrams that all who have joined an IPv4 group receive, other processes of this machine too.

        Parameters
        ----------
        group
            224.0.0.0 to 239.255.255.255, and the port.
        robot
            who listens: what is for another robot is put aside unread, and need not be opened; None: all is taken.
        interface
            address of the network that is used; 0.0.0.0: as the machine's routes say.
        hops
            over how many routers less one it goes; 1: none.

        Raises
        ------
        NetworkError
            if the group cannot be joined.
        ParameterError
            if it is no group, or hops are none.
        """
        if not 1 <= hops <= 255:
            raise ParameterError(f"hops: {hops}; expected 1 to 255")
        _, address = _resolved(group, socket.AF_INET)
        _, network = _resolved((interface, 0), socket.AF_INET)
        if not 224 <= int(address[0].split(".")[0]) <= 239:
            raise ParameterError(f"group: {group[0]}; expected 224.0.0.0 to 239.255.255.255")
        transport = cls.__new__(cls)
        transport._open(socket.AF_INET, room - _FOR, {"": address})
        transport._for_whom = {_TO_ALL, _addressee(robot)} if robot is not None else None
        try:
            transport._join(address, network[0], hops)
        except OSError as error:
            transport.close()
            raise NetworkError(
                f"{group[0]}:{group[1]} on {interface}: {error.strerror}; expected a network that carries multicast: "
                "name one of this machine's addresses, or the peers"
            ) from None
        return transport

    def _open(self, family: int, room: int, peers: Mapping[str, _Sockaddr]) -> None:
        self.room, self.datagrams, self.bytes_sent, self._unsent = room, 0, 0, 0
        self._peers, self._dropped = dict(peers), 0
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
        self._in_group = False
        self._for_whom: set[bytes] | None = None
        self._inode = fstat(self._socket.fileno()).st_ino
        self._arrivals = select.poll()
        self._arrivals.register(self._socket, select.POLLIN)

    def _join(self, group: _Sockaddr, interface: str, hops: int) -> None:
        self._in_group = True
        mine, options = self._socket, socket.IPPROTO_IP
        mine.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        mine.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        mine.bind(group)  # to the group, so that nothing else that comes to the port is heard
        membership = socket.inet_aton(group[0]) + socket.inet_aton(interface)
        mine.setsockopt(options, socket.IP_ADD_MEMBERSHIP, membership)
        mine.setsockopt(options, socket.IP_MULTICAST_IF, socket.inet_aton(interface))
        mine.setsockopt(options, socket.IP_MULTICAST_TTL, hops)
        mine.setsockopt(options, socket.IP_MULTICAST_LOOP, 1)

    @property
    def address(self) -> Address:
        host, port = self._socket.getsockname()[:2]
        return host, port

    @property
    def lost_here(self) -> int:
        """Datagrams that came faster than they were read, as far as the machine tells, and those it did not send."""
        self._dropped = max(self._dropped, _dropped(self._socket.family, self._inode))
        return self._dropped + self._unsent

    def send(self, data: bytes, to: str | None = None) -> None:
        """Send to a robot; None, or one that is not known: to all.

        A network that is gone, or busy, loses what is sent: `lost_here` counts it.

        Raises
        ------
        NetworkError
            if it is larger than a datagram can be.
        """
        if len(data) > _LARGEST:
            raise NetworkError(f"a message of {len(data)} bytes; expected at most {_LARGEST}, all that UDP takes")
        if self._in_group:
            data = (_TO_ALL if to is None else _addressee(to)) + data
        peer = self._peers.get(to) if to is not None else None
        for address in self._peers.values() if peer is None else (peer,):
            try:
                self._socket.sendto(data, address)
            except OSError:
                self._unsent += 1
            else:
                self.datagrams += 1
                self.bytes_sent += len(data)

    def receive(self, wait_s: float) -> list[bytes]:
        """All datagrams that have arrived, at most some thousand at once."""
        came: list[bytes] = []
        if self._arrivals.poll(1000.0 * max(0.0, wait_s)):
            while len(came) < _AT_ONCE:
                try:
                    came.append(self._socket.recv(_LARGEST))
                except OSError:  # nothing more
                    break
        if self._in_group:
            return [data[_FOR:] for data in came if self._for_whom is None or data[:_FOR] in self._for_whom]
        return came

    def close(self) -> None:
        self._socket.close()


def _addressee(robot: str) -> bytes:
    return crc32(robot.encode()).to_bytes(_FOR, "big")


def _resolved(address: Address, family: int) -> tuple[int, _Sockaddr]:
    """Family, and address as the machine wants it."""
    host, port = address
    if not 0 <= port <= 65535:
        raise NetworkError(f"{host}:{port}: no such port; expected 0 to 65535")
    try:
        found = socket.getaddrinfo(host, port, family, socket.SOCK_DGRAM)[0]
    except (socket.gaierror, UnicodeError):
        kind = "" if family == socket.AF_UNSPEC else " of IPv6" if family == socket.AF_INET6 else " of IPv4"
        raise NetworkError(f"{host}:{port}: unknown host; expected a name or address{kind}") from None
    return found[0], found[4]


def _cannot_listen(bind: Address, error: OSError) -> NetworkError:
    host, port = bind
    return NetworkError(f"{host}:{port}: {error.strerror}; expected a free port of an address of this machine")


def _dropped(family: int, inode: int) -> int:
    """The number of datagrams that the operating system has dropped before they were read; 0 where that is unknown."""
    try:
        table = Path("/proc/net/udp6" if family == socket.AF_INET6 else "/proc/net/udp").read_text(encoding="ascii")
    except OSError:
        return 0
    rows = (line.split() for line in table.splitlines()[1:])
    return next((int(row[-1]) for row in rows if row[9] == str(inode)), 0)
