"""The messages of MAVLink by pymavlink: their encoding and decoding.

pymavlink is LGPL-3: an optional part (extra `mavlink`), imported here alone, and nothing of it is copied.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from muster.mission.errors import MissingExtraError

try:
    from pymavlink.dialects.v20 import ardupilotmega as mavlink
except ImportError:
    raise MissingExtraError("mavlink", "a drone that speaks MAVLink") from None

__all__ = ["GROUND_STATION", "PLANNER", "Codec", "Message", "mavlink", "name_of"]

Message = Any
"""A message of pymavlink: `get_type()` is its name, its fields are attributes."""

GROUND_STATION, PLANNER = 255, mavlink.MAV_COMP_ID_MISSIONPLANNER
"""The system and component that Muster is."""


def name_of(enum: str, value: int) -> str:
    """What a value of an enum is called; one that this dialect does not know, by its number."""
    entry = mavlink.enums[enum].get(value)
    return str(value) if entry is None else str(entry.name)


class Codec:
    """Messages to bytes and back, at one end of a link.

    Parameters
    ----------
    system, component
        who speaks here.
    """

    def __init__(self, system: int = GROUND_STATION, component: int = PLANNER) -> None:
        self.make = mavlink.MAVLink(None, srcSystem=system, srcComponent=component)
        self.make.robust_parsing = True

    def pack(self, message: Message) -> bytes:
        """The bytes of a message, MAVLink 2."""
        return bytes(message.pack(self.make))

    def parse(self, data: bytes) -> Iterator[Message]:
        """The messages that these bytes complete. What is damaged, or not MAVLink, is left out."""
        for message in self.make.parse_buffer(bytearray(data)) or ():
            if message.get_type() != "BAD_DATA" and not message.get_type().startswith("UNKNOWN"):
                yield message
