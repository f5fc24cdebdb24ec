"""How long the work on tasks takes, once for each class of robots that are alike in it (docs/design.md, Meaning)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from muster.mission.model import Robot
from muster.mission.values.arrays import Floats
from muster.model.lengths import Measured
from muster.model.task_geometry import TaskGeometry
from muster.motion.leg_times import LegTimes


def work_times(
    robots: Sequence[Robot],
    durations: Floats,
    profiles: Sequence[LegTimes],
    geometry: TaskGeometry,
    measured: Measured,
) -> tuple[Floats, npt.NDArray[np.int32]]:
    """The seconds that tasks take.

    Parameters
    ----------
    durations
        (n,) seconds for a robot of efficiency 1; NaN where none is given.
    profiles
        for each robot.

    Returns
    -------
    seconds
        (time classes, n): the duration by the robot's efficiency where one is given; else the time along lanes, or of
        the profile along the way points of the task's action; else the cost by the robot's speed.
    classes
        (m,) each robot's class.
    """
    classes = zip(measured.work_classes.tolist(), geometry.classes.tolist(), strict=True)
    keys = [(*own, profile, robot.efficiency) for own, profile, robot in zip(classes, profiles, robots, strict=True)]
    number = {key: k for k, key in enumerate(dict.fromkeys(keys))}
    rows = np.empty((len(number), len(durations)))
    for (work, place, profile, efficiency), row in zip(number, rows, strict=True):
        row[:] = measured.costs[work] / profile.speed_mps
        if not profile.is_constant:
            for j, metres in measured.legs[work].items():
                row[j] = profile.work_seconds(geometry.moving[place, j].points, metres)
        for j, seconds in measured.driven_s[work].items() if measured.driven_s else ():
            row[j] = seconds
        row[:] = np.where(np.isnan(durations), row, durations / efficiency)
    return rows, np.array([number[key] for key in keys], dtype=np.int32)
