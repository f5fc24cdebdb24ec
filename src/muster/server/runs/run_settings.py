"""Checks of worlds, settings, speeds and actions of runs, before anything is started."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import ignored_rules
from muster.mission.near_matches import did_you_mean
from muster.mission.order_files import OF_TASKS
from muster.mission.value_types import shown
from muster.motion.avoidance_names import AVOIDANCE
from muster.motion.laws import LAWS
from muster.planning.options import options_from
from muster.running.wall_time import STARTS
from muster.running.worlds import WORLDS
from muster.traffic.names import TRAFFIC

if TYPE_CHECKING:
    from muster.execution import Standing

_PLANNING = {"seed": int, "ignore": list, "planning": dict, "stay": bool, "until_s": float, "traffic": str}
_PLAN = {"accept_partial": bool}
_REAL = {**_PLANNING, **_PLAN, "starts": str}
_ROS = {"namespace": str, "arrival_m": float, "wait_s": float, "known_only": bool}
_WORLD = {"dt_s": float, "avoidance": str, "law": str, "noise": dict, "pose": str, "localise": dict}
SETTINGS: Mapping[str, Mapping[str, type]] = {
    "kinematic": {**_PLANNING, **_WORLD, **_PLAN},
    "physics": {**_PLANNING, **_WORLD, **_PLAN},
    "ros1": {
        **_REAL,
        "master": str,
        "drive": str,
        "frame": str,
        "rate_hz": float,
        "avoidance": str,
        "odometry": str,
        "poses": str,
        **_ROS,
    },
    "ros2": {**_REAL, "domain": int, "give": str, "by": str, **_ROS},
    "mavlink": {
        **_REAL,
        "endpoints": dict,
        "arm": bool,
        "offboard": bool,
        "local_frame": str,
        "height_m": float,
        "low_battery": float,
        "wait_s": float,
        "at_end": str,
    },
}
"""What each world may be told, and of which kind it is."""
CHOICES: Mapping[str, tuple[str, ...]] = {
    "avoidance": AVOIDANCE,
    "starts": STARTS,
    "traffic": TRAFFIC,
    "pose": ("true", "estimate"),
    "law": LAWS,
    "odometry": ("map", "start"),
    "drive": ("cmd_vel", "goals"),
    "give": ("goals", "nav2"),
    "by": ("dds", "rclpy"),
    "local_frame": ("north", "forward"),
    "at_end": ("hold", "return", "land"),
}
"""What settings that are words may be; those who understand them take long to import."""
NOISE = (
    "velocity",
    "slip",
    "odometry",
    "motors",
    "position_m",
    "heading_rad",
    "attitude_rad",
    "gyro_radps",
    "gyro_bias_radps",
    "accelerometer_mps2",
    "camera_delay_s",
)
"""The kinds of a simulation's noise."""
_KINDS = {
    str: "a text",
    list: "a list",
    bool: "true or false",
    dict: "a mapping",
    int: "a whole number",
    float: "a number",
}
VERBS = ("pause", "resume", "speed", "cancel", "event", "orders")
MOST_ORDERS = 1000
"""Of one action."""
_FASTEST = 1e6


def require_world(world: str, bridges: tuple[str, ...], settings: Mapping[str, Any]) -> None:
    """Raise ParameterError unless runs may be started in a world with these settings."""
    _require_choice("world", world, (*WORLDS, *bridges))
    for name, value in settings.items():
        _require_setting(world, name, value)
    ignored_rules(settings.get("ignore", ()))
    options_from(settings.get("planning", {}))
    _require_number(settings, "seed", 0, 2**63 - 1, whole=True)
    _require_number(settings, "until_s", 0.0, math.inf)
    if "until_s" in settings and not settings.get("stay"):
        raise ParameterError(f"until_s: {settings['until_s']!r}; expected it together with stay")
    if world in WORLDS:
        _require_number(settings, "dt_s", 0.001, 1.0)
        noise = settings.get("noise", {})
        for kind in noise:
            _require_choice("noise", kind, NOISE)
            _require_number(noise, kind, 0.0, 1.0 if kind == "slip" else math.inf)
        if settings.get("localise"):
            from muster.running.localisation import sensors_of

            sensors_of(settings["localise"])
    for robot, endpoint in settings.get("endpoints", {}).items():
        _require_kind(f"endpoints.{robot}", endpoint, str)


def _require_setting(world: str, name: str, value: object) -> None:
    """Worlds of other packages are set as those that ship; a fleet of another package checks its settings itself."""
    if world not in SETTINGS and world not in WORLDS:
        return
    kinds = SETTINGS.get(world, SETTINGS["kinematic"])
    if name not in kinds:
        raise ParameterError(f"{name}: no setting of world {world}; expected {', '.join(kinds)}")
    _require_kind(name, value, kinds[name])
    if name in CHOICES:
        _require_choice(name, str(value), CHOICES[name])


def _require_kind(name: str, value: object, kind: type) -> None:
    """Raise ParameterError unless a setting has a kind; whole numbers are numbers, true and false are not."""
    kinds = (int, float) if kind is float else (kind,)
    if not isinstance(value, kinds) or (isinstance(value, bool) and kind is not bool):
        raise ParameterError(f"{name}: {shown(value)}; expected {_KINDS[kind]}")


def _require_choice(name: str, value: str, allowed: Sequence[str]) -> None:
    if value not in allowed:
        raise ParameterError(f"{name}: {value}; expected {', '.join(allowed)}{did_you_mean(value, allowed)}")


def _require_number(values: Mapping[str, Any], name: str, least: float, most: float, *, whole: bool = False) -> None:
    value = values.get(name, least)
    right = isinstance(value, int) or (isinstance(value, float) and not whole)
    if isinstance(value, bool) or not right or not least <= value <= most:
        raise ParameterError(f"{name}: {value!r}; expected {'a whole' if whole else 'a'} number, {least:g} to {most:g}")


def standing_of(settings: Mapping[str, Any]) -> Standing | None:
    """The fleet that stays on duty by `stay` and `until_s`; None: it ends when its tasks are done."""
    if not settings.get("stay"):
        return None
    from muster.execution import Standing

    return Standing(until_s=settings.get("until_s", math.inf))


def require_speed(speed: object) -> float | None:
    """A speed: a number above 0, or None, as fast as it goes."""
    if speed is None:
        return None
    if isinstance(speed, bool) or not isinstance(speed, int | float) or not 0 < speed <= _FASTEST:
        raise ParameterError(f"speed: {speed!r}; expected a number above 0, at most {_FASTEST:g}, or null")
    return float(speed)


def _require_text(data: Mapping[str, Any]) -> None:
    """Refuse what cannot be strict JSON in UTF-8: it would end the runner."""
    try:
        json.dumps(data, ensure_ascii=False, allow_nan=False).encode()
    except UnicodeEncodeError:
        raise ParameterError("data: half a character; expected text in UTF-8") from None
    except ValueError:
        raise ParameterError("data: a number that is not finite; expected finite numbers") from None


def require_action(verb: str, data: Mapping[str, Any]) -> dict[str, Any]:
    """The data of an action, as sent to a runner.

    Raises
    ------
    ParameterError
        if the verb or its data are wrong. The runner checks whether an event fits the mission.
    """
    _require_choice("verb", verb, VERBS)
    _require_text(data)
    if verb == "speed":
        if set(data) != {"speed"}:
            raise ParameterError(f"data: {', '.join(data) or 'nothing'}; expected speed")
        return {"speed": require_speed(data["speed"])}
    if verb == "event":
        if len(data) != 1 or "at_s" in data:
            raise ParameterError(f"data: {', '.join(data) or 'nothing'}; expected one event, without at_s")
        return dict(data)
    if verb == "orders":
        return {"orders": _orders(data)}
    if data:
        raise ParameterError(f"data: {', '.join(data)}; expected none with {verb}")
    return {}


def _orders(data: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The orders of one action: events that concern tasks, in order."""
    orders = data.get("orders")
    if set(data) != {"orders"} or not isinstance(orders, list) or not 1 <= len(orders) <= MOST_ORDERS:
        raise ParameterError(f"data: {', '.join(data) or 'nothing'}; expected orders, a list of 1 to {MOST_ORDERS}")
    for k, order in enumerate(orders):
        if not isinstance(order, dict) or len(order) != 1 or next(iter(order)) not in OF_TASKS:
            raise ParameterError(f"orders[{k}]: {shown(order)}; expected one of {', '.join(OF_TASKS)}, without at_s")
    return [dict(order) for order in orders]
