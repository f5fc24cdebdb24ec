"""Travel between places by the mission's rule, as input of the core."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from muster.mission.errors import Finding, NotSupportedError
from muster.mission.model import Mission, Robot, Task
from muster.mission.values.arrays import Floats
from muster.motion.map_world import World, body_of
from muster.motion.straight_ways import StraightWays

_MOST_PLACES = 6_000  # tasks, starts and ends: 288 MB a table


def travel_table(
    mission: Mission, robots: Sequence[Robot], tasks: Sequence[Task]
) -> tuple[Floats, npt.NDArray[np.int32]]:
    """The mission's own travel tables and each robot's class.

    Returns
    -------
    table
        (classes, n + 2m, n + 2m) metres between tasks, starts and ends of robots, inf where there is no way,
        and to tasks and stations in areas that are closed to a robot.
    classes
        (m,) index of each robot's table.
    """
    chart = mission.map
    has_areas = chart is not None and bool(chart.boundary or chart.zones)
    keys = [(robot.type or "", body_of(robot) if has_areas else None) for robot in robots]
    kinds = sorted(set(keys), key=lambda key: (key[0], (key[1].kind, key[1].radius_m) if key[1] else ()))
    starts = [robot.id for robot in robots]
    stations = [station.id for station in mission.stations]
    names = [*(task.id for task in tasks), *starts, *starts, *stations]  # a robot ends, if anywhere, where it started
    work = {task.id: task.position for task in tasks} | {one.id: one.position for one in mission.stations}
    world = World.of_travel(mission) if has_areas else None
    tables = []
    for kind, body in kinds:
        given = mission.travel_tables[kind]
        index = {place: k for k, place in enumerate(given.places)}
        rows = [index[name] for name in names]
        table = np.array(given.metres, dtype=np.float64)[np.ix_(rows, rows)]
        if world is not None and body is not None:
            ways = StraightWays(world, body)
            closed = [k for k, name in enumerate(names) if name in work and not ways.clear(np.array([work[name]]))]
            table[:, closed] = math.inf
        tables.append(table)
    return np.array(tables), np.array([kinds.index(key) for key in keys], dtype=np.int32)


def straight_table(mission: Mission, exits: Floats, entries: Floats) -> Floats:
    """(classes, p, p) metres, straight, from exits to entries (classes, p, 3); empty where all robots have the same.

    The core works those out itself.

    Raises
    ------
    NotSupportedError
        for more places than a table can hold.
    """
    if len(exits) == 1:
        return np.empty(0)
    require_room(mission, exits.shape[1], "actions whose places depend on the robot")
    return np.array([np.linalg.norm(a[:, None] - b[None], axis=2) for a, b in zip(exits, entries, strict=True)])


def require_room(mission: Mission, count: int, purpose: str) -> None:
    """Refuse more places than a table can hold (NotSupportedError)."""
    if count > _MOST_PLACES:
        places = f"{count} starts, ends and tasks"
        expected = f"at most {_MOST_PLACES} for {purpose}"
        raise NotSupportedError([Finding(mission.source.file, None, "map", places, expected)])
