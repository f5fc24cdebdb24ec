"""What is asked of an autopilot, step by step: modes, arming, the upload of a mission, its start.

Sources: mavlink.io, services `mission` and `command`; PX4 and ArduCopter say in their heartbeat in what mode they are
and whether they are armed, which is the answer that counts: an acknowledgement may be lost, or be an earlier one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from muster.bridges.mavlink.autopilots import Autopilot
from muster.bridges.mavlink.conversation import Ask, Script, pause
from muster.bridges.mavlink.dialect import Message, mavlink
from muster.bridges.mavlink.faults import FaultError, Kind
from muster.bridges.mavlink.items import Item, Route

_AGAIN = 3
"""How often a command is given that is refused for the moment."""


def command(target: Message, number: int, *params: float) -> Message:
    """COMMAND_LONG to the sender of a heartbeat; parameters that are not given are 0."""
    seven = (*params, *(0.0,) * (7 - len(params)))
    return mavlink.MAVLink_command_long_message(target.get_srcSystem(), target.get_srcComponent(), number, 0, *seven)


def obeyed(
    target: Message,
    number: int,
    params: Sequence[float],
    shows: str,
    value: int,
    kind: Kind,
    *,
    takes_ack: bool = False,
) -> Script:
    """Give a command until the heartbeat shows that it was obeyed.

    Parameters
    ----------
    shows, value
        `mode`: the heartbeat's custom mode must be this; `armed`: it must be armed.
    kind
        of the fault if it is refused.
    takes_ack
        whether an acknowledgement is enough: a short mission may be over before the next heartbeat.
    """

    def answer(message: Message) -> Message | None:
        if message.get_type() == "HEARTBEAT":
            is_mode = shows == "mode" and message.custom_mode == value
            is_armed = shows == "armed" and message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
            return message if is_mode or is_armed else None
        answered = message.get_type() == "COMMAND_ACK" and message.command == number
        waits = (mavlink.MAV_RESULT_IN_PROGRESS, *(() if takes_ack else (mavlink.MAV_RESULT_ACCEPTED,)))
        return message if answered and message.result not in waits else None

    name = mavlink.enums["MAV_CMD"][number].name
    for _ in range(_AGAIN):
        said = yield Ask([command(target, number, *params)], answer, name)
        if said.get_type() == "HEARTBEAT" or said.result == mavlink.MAV_RESULT_ACCEPTED:
            return
        if said.result != mavlink.MAV_RESULT_TEMPORARILY_REJECTED:
            break
        yield pause(1.0)
    raise FaultError(kind, f"{name}: {mavlink.enums['MAV_RESULT'][said.result].name}")


def mode(target: Message, autopilot: Autopilot, wanted: int) -> Script:
    """Bring it into a mode."""
    params = (mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, *autopilot.mode_parameters(wanted))
    return obeyed(target, mavlink.MAV_CMD_DO_SET_MODE, params, "mode", wanted, Kind.COMMAND_REFUSED)


def armed(target: Message) -> Script:
    """Arm it. The second parameter stays 0: nothing is forced."""
    return obeyed(target, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, (1.0,), "armed", 1, Kind.ARM_REFUSED)


def started(target: Message, autopilot: Autopilot, first: int) -> Script:
    """Let it fly the mission that was uploaded, from its first item."""
    to = target.get_srcSystem(), target.get_srcComponent()

    def at_first(message: Message) -> Message | None:
        return message if message.get_type() == "MISSION_CURRENT" and message.seq == first else None

    yield Ask([mavlink.MAVLink_mission_set_current_message(*to, first)], at_first, "MISSION_SET_CURRENT")
    number = mavlink.MAV_CMD_MISSION_START
    yield from obeyed(target, number, (), "mode", autopilot.mission, Kind.COMMAND_REFUSED, takes_ack=True)


def upload(target: Message, route: Route) -> Script:
    """MISSION_COUNT; then each item that is asked for, as often as it is; then MISSION_ACK."""
    to, count = (target.get_srcSystem(), target.get_srcComponent()), len(route.items)
    last_sent = False

    def answer(message: Message) -> Message | None:
        name = message.get_type()
        if getattr(message, "mission_type", 0) != mavlink.MAV_MISSION_TYPE_MISSION:
            return None
        if name in ("MISSION_REQUEST_INT", "MISSION_REQUEST"):
            return message if message.seq < count else None
        late = message if name == "MISSION_ACK" else None  # an acknowledgement of the mission before may come late
        return late if late and (last_sent or late.type != mavlink.MAV_MISSION_ACCEPTED) else None

    said = yield Ask([mavlink.MAVLink_mission_count_message(*to, count)], answer, "MISSION_COUNT")
    seq = 0
    while said.get_type() != "MISSION_ACK":
        seq = said.seq
        last_sent = last_sent or seq == count - 1
        said = yield Ask([_message(to, seq, route.items[seq])], answer, f"MISSION_ITEM_INT {seq}")
    if said.type != mavlink.MAV_MISSION_ACCEPTED:
        raise FaultError(Kind.ITEM_REJECTED, f"item {seq}: {mavlink.enums['MAV_MISSION_RESULT'][said.type].name}")


def _message(to: tuple[int, int], seq: int, item: Item) -> Message:
    place = (item.x, item.y, item.z)
    return mavlink.MAVLink_mission_item_int_message(
        *to, seq, item.frame, item.command, int(seq == 0), 1, *item.params, *place
    )


def climb(target: Message, above_home_m: float) -> Script:
    """ArduPilot outside a mission: up to a height, before it follows way points."""

    def answer(message: Message) -> Message | None:
        if message.get_type() == "GLOBAL_POSITION_INT":
            return message if message.relative_alt / 1000 > above_home_m - 0.5 else None
        if message.get_type() == "LOCAL_POSITION_NED":
            return message if -message.z > above_home_m - 0.5 else None
        return None

    climbing = command(target, mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, math.nan, 0, 0, above_home_m)
    yield Ask([climbing], answer, "MAV_CMD_NAV_TAKEOFF", within_s=30.0, tries=2)
