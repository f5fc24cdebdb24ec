"""Batteries that a file states by time or length, before the mission is read: `endurance_s` and `range_m` of robots.

A battery falls with usage. With `rules.usage: time` travel and work both take their seconds: `endurance_s` is the
capacity, and `range_m` is that at the robot's speed, `range_m / speed_mps`. With `rules.usage: distance` it is
`range_m`, and `endurance_s * speed_mps`; but only where no second passes that metres do not count: no motion profile,
no slower lanes, no work with a `duration_s`. Else `usage: time` is asked for. Where both are stated both hold.

Waiting draws nothing from a battery, and a drone that waits flies. So where a mission can make robots wait, the route
of a drone, the waiting in it, must also end within its endurance: `available_until_s`. Where it could charge on the
way that would be too early, and without it too late: the battery must be stated by its capacity then.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from muster.mission.value_types import INVALID, Fault, Number, Path, shown
from muster.mission.values.raw_records import listed, robots_in, tasks_in

ENDURANCE = ("endurance_s", Number(above=0), "how long the robot can be under way, in place of battery, seconds")
RANGE = ("range_m", Number(above=0), "how far the robot can go, in place of battery, metres")
_KEYS = {key: kind for key, kind, _ in (ENDURANCE, RANGE)}
_PROFILE = ("acceleration_mps2", "yaw_rate_radps", "climb_mps")
_MAKE_WAIT = ("window_s", "prerequisites", "robots_needed", "team", "needs", "starts_with")
_REFILLS = frozenset(("charge", "swap"))


def energy_to_batteries(data: object, faults: list[Fault]) -> None:
    """Replace, within `data`, times and lengths by batteries in the unit of usage; by faults those that are none."""
    for at, robot in robots_in(data):
        given = {key: robot.pop(key) for key in _KEYS if key in robot}
        if not given:
            continue
        if robot.get("battery") is not None:
            expected = f"battery or {' and '.join(given)}, not both"
            faults.append(Fault((*at, "battery"), shown(robot["battery"]), expected))
            continue
        before = len(faults)
        read = {key: _KEYS[key].read(value, (*at, key), faults) for key, value in given.items() if value is not None}
        speed = Number(above=0).read(robot.get("speed_mps", 1.0), (*at, "speed_mps"), [])
        if len(faults) > before or speed is INVALID or not read:
            continue
        seconds = min(read.get("endurance_s", float("inf")), read.get("range_m", float("inf")) / speed)
        metres = min(read.get("range_m", float("inf")), read.get("endurance_s", float("inf")) * speed)
        is_time = _rules(data).get("usage", "distance") == "time"
        robot["battery"] = {"capacity": seconds if is_time else metres}
        faults += [] if is_time else _uncounted(data, at, robot, read)
        faults += _waiting(data, at, robot, read, seconds)


def _rules(data: object) -> dict[str, Any]:
    rules = data.get("rules") if isinstance(data, dict) else None
    return rules if isinstance(rules, dict) else {}


def _uncounted(data: object, at: Path, robot: dict[str, Any], read: dict[str, float]) -> Iterator[Fault]:
    """Yield the fault of a battery in metres where the robot is under way for seconds that metres do not count."""
    key = next(iter(read))
    drives = robot.get("kind", "ground") == "ground"
    if key == "range_m" and drives:
        return  # metres bound metres, and who stands flies on nothing
    reason = _slower(data, robot) if key == "endurance_s" else ""
    if not reason and any(_lasts(task) for _, task in tasks_in(data)):
        reason = "work with a duration_s draws nothing from a battery in metres"
    if reason:
        yield Fault((*at, key), shown(read[key]), f"rules: {{usage: time}} beside it: {reason}")


def _slower(data: object, robot: dict[str, Any]) -> str:
    """Return why travel takes longer than length by speed; empty where it does not."""
    stated = [key for key in _PROFILE if robot.get(key) is not None]
    if stated and _rules(data).get("timing", "profile") != "constant":
        return f"with {stated[0]} travel takes longer than its length by the speed"
    lanes = data.get("lanes") if isinstance(data, dict) else None
    if robot.get("kind", "ground") == "ground" and any("speed_mps" in edge for _, edge in listed(lanes, "edges")):
        return "lanes with a speed_mps take longer than their length by the robot's speed"
    return ""


def _lasts(task: dict[str, Any]) -> bool:
    action = task.get("action")
    return bool(task.get("duration_s") or (isinstance(action, dict) and action.get("duration_s")))


def _waiting(data: object, at: Path, robot: dict[str, Any], read: dict[str, float], seconds: float) -> Iterator[Fault]:
    """Let the route of a drone that may have to wait end within its endurance; a fault where that cannot be said."""
    waits = any(task.get(key) not in (None, [], 1) for _, task in tasks_in(data) for key in _MAKE_WAIT)
    if robot.get("kind", "ground") != "air" or not waits:
        return
    if any(_REFILLS.intersection(map(str, station.get("services") or ())) for _, station in listed(data, "stations")):
        key = next(iter(read))
        expected = "battery: {capacity: ...}, with room for waiting, which draws nothing: tasks make robots wait here"
        yield Fault((*at, key), shown(read[key]), expected)
        return
    begins, ends = robot.get("available_from_s") or 0.0, robot.get("available_until_s")
    if isinstance(begins, int | float) and (ends is None or isinstance(ends, int | float)):
        robot["available_until_s"] = begins + seconds if ends is None else min(begins + seconds, ends)
