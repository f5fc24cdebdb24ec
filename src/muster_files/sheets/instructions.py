"""What a robot does at a stop, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from muster.mission.action_keys import ACTION_KEYS
from muster.mission.goods import by_commodity, shown_amounts
from muster.mission.model import Action, Station, Task
from muster.verification import Stop

_UNITS = {"_mps": " m/s", "_deg": "°", "_m": " m", "_s": " s"}


def at_task(task: Task, stop: Stop) -> str:
    """What is done at a task: its action, its type, what is taken on board or put down, what it needs."""
    parts = [] if task.action is None or task.action.name == "go-to-goal" else [_action(task.action)]
    if task.type is not None:
        parts.append(f"type {task.type}")
    parts += _goods(task)
    if task.entry is not None or task.exit is not None:
        parts.append(f"work from {metres(task.entry or task.position)} to {metres(task.exit or task.position)}")
    if not parts:
        parts.append("work" if stop.ends_s > stop.starts_s else "visit")
    if task.requires:
        parts.append(f"with {', '.join(task.requires)}")
    return "; ".join(parts)


def at_station(station: Station, stop: Stop, unit: str, *, unloads: bool) -> str:
    """What is done at a station; `unloads` says whether anything is put down there."""
    parts = []
    if station.charges:
        parts.append("charge" if stop.charged is None else f"charge {plain(stop.charged)} {unit}")
    if station.swaps:
        parts.append("swap the battery")
    if unloads:
        parts.append("unload")
    return "; ".join(parts) or " or ".join(station.services)


def metres(point: Sequence[float]) -> str:
    """A place in the map frame, to a centimetre: `(12.5, 3)`."""
    return f"({', '.join(plain(c) for c in point)})"


def plain(value: float, decimals: int = 2) -> str:
    """A number with so many decimals at most."""
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text


def _goods(task: Task) -> Iterator[str]:
    amounts = by_commodity(task.load)
    on_board = {name: amount for name, amount in amounts.items() if amount > 0}
    down = {name: -amount for name, amount in amounts.items() if amount < 0}
    if on_board:
        yield f"take on board {shown_amounts(on_board)}"
    if down:
        yield f"put down {shown_amounts(down)}"
    if task.delivers is not None:
        yield f"put down what {task.delivers} took on board"


def _action(action: Action) -> str:
    keys = [key for key in ACTION_KEYS[action.name].names if action.part is None or key not in ("split", "part")]
    part = [] if action.part is None else [f"part {action.part} of {action.split}"]
    told = [words for key in keys if (words := _value(key, action.value(key)))]
    return ", ".join([action.name.replace("-", " "), *part, *told])


def _value(key: str, value: Any) -> str:
    """The value of a key in words, with its unit: `side 6 m`; empty where there is none. Polygons are counted."""
    if value is None or value is False or value == ():
        return ""
    name, unit = next(((key.removesuffix(end), unit) for end, unit in _UNITS.items() if key.endswith(end)), (key, ""))
    words = name.replace("_", " ")
    if value is True:
        return words
    if key == "area":
        return f"{words} with {len(value)} corners"
    if key == "holes":
        return f"{len(value)} {words if len(value) > 1 else 'hole'}"
    if isinstance(value, tuple) and all(isinstance(c, int | float) for c in value):
        shown = metres(value)
    else:
        shown = plain(value, 4) if isinstance(value, float) else str(value)
    return f"{words} {shown}{unit}"
