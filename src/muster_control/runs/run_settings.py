"""The requests of runs on a server, and checks of speeds and actions, before anything is started."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.plan import Plan
from muster.mission.reading.order_files import OF_TASKS
from muster.mission.value_types import shown
from muster.mission.values.keywords import require_one_of
from muster.running.fleet_registry import FLEETS
from muster.running.run_request import RunRequest
from muster.running.worlds import WORLDS

VERBS = ("pause", "resume", "speed", "cancel", "event", "orders")
MOST_ORDERS = 1000
"""Of one action."""
_FASTEST = 1e6


def new_request(
    world: str, bridges: Sequence[str], settings: Mapping[str, Any], speed: float | None = None
) -> RunRequest:
    """Return the request of a run that a user asks for.

    Raises
    ------
    MusterError
        if a server does not start such runs, or a setting is wrong.
    """
    if world in FLEETS and world not in bridges:
        lacks = f"muster serve has no --bridge {world}"
        raise ParameterError(f"world: {world}; expected {', '.join((*WORLDS, *bridges))}: {lacks}")
    request = RunRequest.from_settings(world, settings, speed if world in WORLDS else None)
    if request.is_real and speed not in (None, 1.0):
        raise ParameterError(f"speed: {speed}; expected 1: real robots have their own speed")
    given = len(settings.get("orders", ()))
    most = 0 if request.is_real else MOST_ORDERS
    if given > most:
        raise ParameterError(f"orders: {given}; expected at most {most} as settings; others by POST /runs/RUN/orders")
    return request


def request_of(world: str, settings: Mapping[str, Any], plan: Plan) -> RunRequest:
    """Return the request of a run by its settings, as the runner carries it out.

    Raises
    ------
    MusterError
        if a setting is wrong, or a server does not allow the options of planning again.
    """
    from muster_control.work.tasks.check_request import checked_options

    request = RunRequest.from_settings(world, settings)
    return replace(request, ignore=plan.ignored, planning=checked_options(settings.get("planning", {})))


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
    require_one_of("verb", verb, VERBS)
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
