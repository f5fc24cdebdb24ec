"""Solomon's vehicle routing instances with time windows as missions, with loads or without [solomon1987]."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import as_file, files

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster_files.instances.solomon import read_solomon
from muster_studies.instances.references import numbered

_FOLDER = "solomon_instances"

REFERENCES = numbered("solomon")
"""By instance and number of robots: the total distance of the best plan known, which keeps the loads too."""


def solomon_instance(name: str, robots: int, *, loads: bool = False) -> Mission:
    """A shipped instance, C101, C201, R101, R201 or RC101, with so many robots, and with its demands as `loads`.

    Raises
    ------
    ParameterError
        for any other name.
    """
    file = files("muster_studies.instances") / _FOLDER / f"{name}.txt"
    if not file.is_file():
        names = sorted({instance for instance, _ in REFERENCES})
        raise ParameterError(f"instance: {name}; expected {' or '.join(names)}")
    with as_file(file) as path:
        mission = read_solomon(path, robots)
    return mission if loads else without_loads(mission)


def without_loads(mission: Mission) -> Mission:
    """The mission of vehicles that carry any amount."""
    return replace(
        mission,
        robots=tuple(replace(robot, load_capacity=None) for robot in mission.robots),
        tasks=tuple(replace(task, load=None) for task in mission.tasks),
    )
