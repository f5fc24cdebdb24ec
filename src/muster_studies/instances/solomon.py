"""Solomon's vehicle routing instances with time windows as missions, without loads [solomon1987]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files
from types import MappingProxyType

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Rules, Task

_FOLDER = "solomon_instances"
_COLUMNS = 7
_COLUMN_NAMES = "customer, x, y, demand, ready time, due date, service time"

REFERENCES: Mapping[tuple[str, int], float] = MappingProxyType(
    {
        ("C101", 10): 828.94,
        ("R101", 19): 1650.80,
        ("R101", 20): 1642.88,
        ("RC101", 14): 1696.95,
        ("RC101", 16): 1643.41,
        ("C201", 3): 591.56,
        ("R201", 4): 1252.37,
    }
)
"""By instance and number of robots: the total distance of the best plan known, which keeps the loads too."""


def solomon_instance(name: str, robots: int) -> Mission:
    """A shipped instance: C101, C201, R101, R201 or RC101.

    Raises
    ------
    ParameterError
        for any other name.
    """
    file = files("muster_studies.instances") / _FOLDER / f"{name}.txt"
    if not file.is_file():
        names = sorted({instance for instance, _ in REFERENCES})
        raise ParameterError(f"instance: {name}; expected {' or '.join(names)}")
    return solomon_mission(file.read_text(encoding="utf-8"), robots, f"{name}-{robots}")


def solomon_mission(text: str, robots: int, name: str) -> Mission:
    """The text of an instance file as a mission of so many robots.

    A customer is a task: its service time is the work, which begins between ready time and due date. A vehicle is a
    robot that starts and ends at the depot, by the depot's due date. Demands are left out. Robots move at 1 m/s, as
    distance and time are the same number.

    Raises
    ------
    ParameterError
        if a customer has not all seven numbers, or there is none.
    """
    depot, *customers = _customers(text)
    _, x, y, _, opens, closes, _ = depot
    team = (
        Robot(id=f"r_{k}", position=(x, y), available_from_s=opens, available_until_s=closes) for k in range(robots)
    )
    return Mission(
        name=name,
        rules=Rules(objective="total", return_to_start=True),
        robots=tuple(team),
        tasks=tuple(map(_task, customers)),
    )


def _task(customer: Sequence[float]) -> Task:
    number, x, y, _, ready, due, service = customer
    return Task(id=str(int(number)), position=(x, y), duration_s=service, window_s=((ready, due),))


def _customers(text: str) -> list[list[float]]:
    """The rows of the table of customers, the depot first."""
    rows = []
    _, _, table = text.partition("CUSTOMER")
    for line in table.splitlines():
        words = line.split()
        if not words or not words[0].isdecimal():
            continue
        if len(words) != _COLUMNS:
            raise ParameterError(f"customer {words[0]}: {' '.join(words)!r}; expected {_COLUMN_NAMES}")
        rows.append([float(word) for word in words])
    if len(rows) <= 1:
        raise ParameterError(f"instance: no customers; expected lines of {_COLUMN_NAMES} after CUSTOMER")
    return rows
