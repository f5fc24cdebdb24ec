"""Links and the drones on them: the sender of each message that arrives, and the link for each that is sent.

A telemetry radio, MAVProxy or mavlink-router brings several drones by one line; their system ids tell them apart.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from muster.mission.errors import ParameterError
from muster_robots.mavlink.dialect import Codec, Message, mavlink
from muster_robots.mavlink.endpoints import Endpoint, Line, Peer, endpoint_of, line_to


class Link:
    """One line.

    Parameters
    ----------
    name
        of the line, as the endpoint has it.
    line
        opened.
    systems
        for each robot on it its system id; None of one that is there alone: that of the first autopilot heard.
    """

    def __init__(self, name: str, line: Line, systems: Mapping[str, int | None]) -> None:
        self.name = name
        self.others: set[int] = set()  # system ids heard beside that of one that should be there alone
        self._line, self._codec = line, Codec()
        self._systems, self._alone = dict(systems), None in systems.values()
        self._parsers: dict[Peer, Codec] = {}
        self._peers: dict[str, Peer] = {}

    def hear(self) -> Iterator[tuple[str, Message]]:
        """What autopilots say, and which robots they are. Cameras and gimbals on board are none."""
        for peer, data in self._line.read():
            for message in self._parsers.setdefault(peer, Codec()).parse(data):
                robot = self._whose(message) if message.get_srcComponent() == mavlink.MAV_COMP_ID_AUTOPILOT1 else None
                if robot is not None:
                    self._peers[robot] = peer
                    yield robot, message

    def say(self, robot: str, message: Message) -> None:
        self._line.write(self._codec.pack(message), self._peers.get(robot))

    def close(self) -> None:
        self._line.close()

    def system_of(self, robot: str) -> int | None:
        return self._systems[robot]

    def _whose(self, message: Message) -> str | None:
        system = message.get_srcSystem()
        for robot, own in self._systems.items():
            if own == system:
                return robot
        if message.get_type() != "HEARTBEAT" or message.autopilot == mavlink.MAV_AUTOPILOT_INVALID:
            return None
        for robot, own in self._systems.items():
            if own is None:
                self._systems[robot] = system
                return robot
        if self._alone:
            self.others.add(system)
        return None


def links_of(endpoints: Mapping[str, str]) -> dict[str, Link]:
    """For each robot its link, opened; robots on one line share it.

    Raises
    ------
    ParameterError
        if an endpoint is none, or robots on one line have not each a system id of their own.
    NetworkError
        if a line cannot be opened.
    """
    lines: dict[str, dict[str, int | None]] = {}
    for robot, text in endpoints.items():
        endpoint = endpoint_of(text)
        on_it = lines.setdefault(endpoint.line, {})
        _require_own_system(robot, endpoint, on_it)
        on_it[robot] = endpoint.system
    links: dict[str, Link] = {}
    try:
        for name, systems in lines.items():
            links |= dict.fromkeys(systems, Link(name, line_to(name), systems))
    except BaseException:
        for link in links.values():
            link.close()
        raise
    return links


def _require_own_system(robot: str, endpoint: Endpoint, on_it: Mapping[str, int | None]) -> None:
    if on_it and (endpoint.system in (None, *on_it.values()) or None in on_it.values()):
        others = ", ".join(on_it)
        raise ParameterError(
            f"endpoint: {endpoint.line} of {others} and {robot}; expected a system id for each: {endpoint.line}#1"
        )
