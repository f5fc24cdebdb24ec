"""Procedures of requests to an autopilot, step by step: modes, arming, the upload of a mission, its start.

Sources: mavlink.io, services `mission` and `command`; PX4 and ArduCopter say in their heartbeat in what mode they are
and whether they are armed, which is the answer that counts: an acknowledgement may be lost, or be an earlier one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from muster_robots.mavlink.autopilots import Autopilot
from muster_robots.mavlink.dialect import Message, mavlink, name_of
from muster_robots.mavlink.faults import FaultError, Kind
from muster_robots.mavlink.mission_items import Item, Route
from muster_robots.mavlink.requests import Request, Script, pause

_AGAIN = 3
"""How often a command is given that is refused for the moment."""
_TELEMETRY = (30, 32, 33, 147, 1, 42, 162, 245)
"""ATTITUDE, the two places, the two of the battery, MISSION_CURRENT, fence, EXTENDED_SYS_STATE."""
_TELEMETRY_US = 100_000
_NO_REFUSAL = (mavlink.MAV_RESULT_ACCEPTED, mavlink.MAV_RESULT_IN_PROGRESS)


def command(target: Message, number: int, *params: float) -> Message:
    """COMMAND_LONG to the sender of a heartbeat; parameters that are not given are 0."""
    seven = (*params, *(0.0,) * (7 - len(params)))
    return mavlink.MAVLink_command_long_message(target.get_srcSystem(), target.get_srcComponent(), number, 0, *seven)


def telemetry_requests(target: Message) -> list[Message]:
    """The commands by which a drone sends what Muster reads, 10 times a second."""
    return [command(target, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, _TELEMETRY_US) for number in _TELEMETRY]


def obeyed(
    target: Message,
    number: int,
    params: Sequence[float],
    shows: Callable[[Message], bool],
    kind: Kind,
    *,
    sightings: int = 1,
    with_it: Sequence[Message] = (),
) -> Script:
    """Repeat a command until telemetry shows its effect. An acknowledgement does not show that.

    Parameters
    ----------
    shows
        whether a message shows it; heartbeats that do not show that it is not so.
    kind
        of the fault if it is refused.
    sightings
        how many messages in a row must show it.
    with_it
        what is said before it, each time.
    """
    sighted = 0

    def answer(message: Message) -> Message | None:
        nonlocal sighted
        if shows(message) or message.get_type() == "HEARTBEAT":
            sighted = sighted + 1 if shows(message) else 0
            return message if sighted >= sightings else None
        answered = message.get_type() == "COMMAND_ACK" and message.command == number
        return message if answered and message.result not in _NO_REFUSAL else None

    name = name_of("MAV_CMD", number)
    for _ in range(_AGAIN):
        said = yield Request([*with_it, command(target, number, *params)], answer, name)
        if said.get_type() != "COMMAND_ACK":
            return
        if said.result != mavlink.MAV_RESULT_TEMPORARILY_REJECTED:
            break
        yield pause(1.0)
    raise FaultError(kind, f"{name}: {_result(said)}")


def _result(acknowledgement: Message) -> str:
    """The result of an acknowledgement, with its second parameter if there is one."""
    name, detail = name_of("MAV_RESULT", acknowledgement.result), acknowledgement.result_param2
    return f"{name}, {detail}" if detail else name


def mode(target: Message, autopilot: Autopilot, wanted: int, *, sightings: int = 1) -> Script:
    """Bring it into a mode."""
    params = _mode_parameters(autopilot, wanted)
    number = mavlink.MAV_CMD_DO_SET_MODE
    yield from obeyed(target, number, params, _beats(mode=wanted), Kind.COMMAND_REFUSED, sightings=sightings)


def armed(target: Message) -> Script:
    """Arm it. The second parameter stays 0: nothing is forced."""
    return obeyed(target, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, (1.0,), _beats(armed=True), Kind.ARM_REFUSED)


def disarmed(target: Message, autopilot: Autopilot) -> Script:
    """Disarm it on the ground, without force: in the air it refuses. A command to hold precedes it: it may take off."""
    hold = command(target, mavlink.MAV_CMD_DO_SET_MODE, *_mode_parameters(autopilot, autopilot.hold))
    number, kind = mavlink.MAV_CMD_COMPONENT_ARM_DISARM, Kind.COMMAND_REFUSED
    return obeyed(target, number, (0.0,), _beats(armed=False), kind, sightings=2, with_it=[hold])


def _mode_parameters(autopilot: Autopilot, wanted: int) -> tuple[float, ...]:
    return (mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, *autopilot.mode_parameters(wanted))


def _beats(mode: int | None = None, armed: bool | None = None) -> Callable[[Message], bool]:
    """Whether a message is a heartbeat in a mode, of a drone that is armed or is not."""

    def shows(message: Message) -> bool:
        if message.get_type() != "HEARTBEAT":
            return False
        is_armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
        return mode in (None, message.custom_mode) and armed in (None, is_armed)

    return shows


def started(target: Message, autopilot: Autopilot, first: int) -> Script:
    """Let it fly the mission that was uploaded, from its first item."""
    to = target.get_srcSystem(), target.get_srcComponent()

    def at_first(message: Message) -> Message | None:
        return message if message.get_type() == "MISSION_CURRENT" and message.seq == first else None

    yield Request([mavlink.MAVLink_mission_set_current_message(*to, first)], at_first, "MISSION_SET_CURRENT")
    flies = _beats(mode=autopilot.mission)

    def under_way(message: Message) -> bool:  # a short mission may be over before the next heartbeat
        over = message.get_type() == "MISSION_CURRENT" and message.mission_state == mavlink.MISSION_STATE_COMPLETE
        return over or message.get_type() == "MISSION_ITEM_REACHED" or flies(message)

    yield from obeyed(target, mavlink.MAV_CMD_MISSION_START, (), under_way, Kind.START_REFUSED)


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

    said = yield Request([mavlink.MAVLink_mission_count_message(*to, count)], answer, "MISSION_COUNT")
    seq = 0
    while said.get_type() != "MISSION_ACK":
        seq = said.seq
        last_sent = last_sent or seq == count - 1
        said = yield Request([_message(to, seq, route.items[seq])], answer, f"MISSION_ITEM_INT {seq}")
    if said.type != mavlink.MAV_MISSION_ACCEPTED:
        raise FaultError(Kind.ITEM_REJECTED, f"item {seq}: {name_of('MAV_MISSION_RESULT', said.type)}")


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
        refused = message.get_type() == "COMMAND_ACK" and message.command == mavlink.MAV_CMD_NAV_TAKEOFF
        return message if refused and message.result not in _NO_REFUSAL else None

    climbing = command(target, mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, math.nan, 0, 0, above_home_m)
    said = yield Request([climbing], answer, "MAV_CMD_NAV_TAKEOFF", within_s=30.0, tries=2)
    if said.get_type() == "COMMAND_ACK":
        raise FaultError(Kind.COMMAND_REFUSED, f"MAV_CMD_NAV_TAKEOFF: {_result(said)}")
