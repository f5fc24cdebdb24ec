"""Checkpoints: all that is known of a mission under way as plain data, from which it is known again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, get_type_hints

import msgspec

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.yaml_writer import plain
from muster.state.explored_map import ExploredMap
from muster.state.goods_ledger import GoodsLedger
from muster.state.mission_state import MissionState
from muster.state.orders import Orders
from muster.state.robots import KnownRobot
from muster.state.task_ledger import Ledger
from muster.state.traffic_account import TrafficAccount

FORMAT = 2
_KEPT: Mapping[str, Any] = {
    "now_s": float,
    "begun_s": float | None,
    "ended_s": float | None,
    "zero_s": float | None,
    "goods": GoodsLedger,
    "orders": Orders,
    "traffic": TrafficAccount,
    "failed_stations": set[str],
    "cut_off_stations": set[str],
    "misfits": set[tuple[str, str]],
    "routes": dict[str, tuple[str, ...]],
    "left_out": dict[str, str],
    "replanned": int,
    "done_twice": dict[str, tuple[str, ...]],
    "explored": ExploredMap | None,
}
"""What a checkpoint has of a state, and the types, but for robots, doors and the ledger of tasks."""
_ADDED = ("explored",)
"""What earlier checkpoints of this format lack."""
_DERIVED = ("mission", "ignored", "tasks", "touched", "_model")
"""What it has of the ledger otherwise, or not at all."""
_LEDGER = {name: of for name, of in get_type_hints(Ledger, localns={"UnderWay": Any}).items() if name not in _DERIVED}
_ROBOT = {name: of for name, of in get_type_hints(KnownRobot).items() if name != "robot"}


def checkpoint_of(state: MissionState) -> dict[str, Any]:
    """Return what is known as plain data: texts, numbers, lists and mappings."""
    return {
        "format": FORMAT,
        "ignored": list(state.ledger.ignored),
        "tasks": {name: plain(task) for name, task in state.tasks.items()},
        "ledger": {name: _builtins(getattr(state.ledger, name)) for name in _LEDGER},
        "robots": [_robot(known) for known in state.robots.values()],
        "closed_doors": sorted(state.doors.closed),
        **{name: _builtins(getattr(state, name)) for name in _KEPT},
    }


def restored(mission: Mission, checkpoint: Mapping[str, Any]) -> MissionState:
    """Return the state of which a checkpoint was made.

    Parameters
    ----------
    mission : Mission
        The mission at the beginning.
    checkpoint : mapping
        What `checkpoint_of` returned, perhaps written as JSON and read again.

    Raises
    ------
    ParameterError
        if it is no checkpoint of this format.
    """
    if checkpoint.get("format") != FORMAT:
        raise ParameterError(f"checkpoint: format {checkpoint.get('format')}; expected {FORMAT}")
    state = MissionState(mission, tuple(checkpoint["ignored"]), own=())
    try:
        for name, of in _KEPT.items():
            value = checkpoint.get(name) if name in _ADDED else checkpoint[name]
            setattr(state, name, msgspec.convert(value, of, str_keys=True))
        for name, of in _LEDGER.items():
            setattr(state.ledger, name, msgspec.convert(checkpoint["ledger"][name], of, str_keys=True))
        for told in checkpoint["robots"]:
            values = {name: msgspec.convert(told[name], of, str_keys=True) for name, of in _ROBOT.items()}
            robot = state.robot_of(told["robot"])
            state.robots[robot.id] = KnownRobot(robot, **values)
    except (KeyError, msgspec.ValidationError) as error:
        raise ParameterError(f"checkpoint: {error}; expected one of format {FORMAT}") from None
    state.ledger.tasks = {name: state.task_of(task) for name, task in checkpoint["tasks"].items()}
    state.doors.closed = frozenset(checkpoint["closed_doors"])
    return state


def _robot(known: KnownRobot) -> dict[str, Any]:
    return {"robot": plain(known.robot), **{f.name: _builtins(getattr(known, f.name)) for f in fields(known)[1:]}}


def _builtins(value: Any) -> Any:
    return msgspec.to_builtins(value, str_keys=True)
