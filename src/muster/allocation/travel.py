"""Travel between places by the mission's rule, as the core wants it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from muster.mission.model import Mission, Robot, Task


def travel_table(
    mission: Mission, robots: Sequence[Robot], tasks: Sequence[Task]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    """Travel tables and each robot's class.

    Returns
    -------
    table
        (classes, n + 2m, n + 2m) metres between tasks, starts and ends of robots, inf where there is no way; empty
        where travel is straight, which the core works out itself.
    classes
        (m,) index of each robot's table; empty where travel is straight.
    """
    if mission.travel_rule == "euclidean":
        return np.empty(0), np.empty(0, dtype=np.int32)
    types = sorted({robot.type or "" for robot in robots})
    starts = [robot.id for robot in robots]
    names = [*(task.id for task in tasks), *starts, *starts]  # a robot ends, if anywhere, where it started
    tables = []
    for kind in types:
        given = mission.travel_tables[kind]
        index = {place: k for k, place in enumerate(given.places)}
        rows = [index[name] for name in names]
        tables.append(np.array(given.metres, dtype=np.float64)[np.ix_(rows, rows)])
    return np.array(tables), np.array([types.index(robot.type or "") for robot in robots], dtype=np.int32)
