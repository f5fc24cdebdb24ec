"""Team orienteering instances of Chao, Golden and Wasil as missions that no team can do whole [chao1996].

A point is a task, its score the priority: what counts is the score of the tasks done. The limit on each path is the
robots' work capacity. A file of `orienteering_instances` has the points of one of the seven sets, a line `x y score`
each: the start first, the end last. The instances of a set have these points in common, and differ in robots and limit.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from types import MappingProxyType

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Rules, Task

_FOLDER = "orienteering_instances"

LIMITS: Mapping[str, float] = MappingProxyType(
    {
        "p1.3.p": 25.0,
        "p2.3.g": 10.7,
        "p3.2.o": 42.5,
        "p3.4.p": 22.5,
        "p4.2.k": 75.0,
        "p4.2.n": 90.0,
        "p4.3.k": 50.0,
        "p4.3.r": 73.3,
        "p4.4.l": 40.0,
        "p4.4.t": 60.0,
        "p5.2.h": 20.0,
        "p5.3.x": 40.0,
        "p6.2.n": 40.0,
        "p7.2.m": 130.0,
        "p7.3.o": 100.0,
        "p7.4.t": 100.0,
    }
)
"""By instance, pSET.ROBOTS.LETTER, the limit on each path."""

BEST_SCORES: Mapping[str, int] = MappingProxyType(
    {
        "p1.3.p": 220,
        "p2.3.g": 145,
        "p3.2.o": 690,
        "p3.4.p": 560,
        "p4.2.k": 1022,
        "p4.2.n": 1174,
        "p4.3.k": 919,
        "p4.3.r": 1273,
        "p4.4.l": 880,
        "p4.4.t": 1285,
        "p5.2.h": 410,
        "p5.3.x": 1555,
        "p6.2.n": 1260,
        "p7.2.m": 827,
        "p7.3.o": 874,
        "p7.4.t": 1077,
    }
)
"""By instance the greatest score known, by [archetti2007] and others."""


def orienteering_instance(name: str) -> Mission:
    """A shipped instance, one of `LIMITS`, such as p4.2.k: set 4 for 2 robots.

    Raises
    ------
    ParameterError
        for any other name.
    """
    if name not in LIMITS:
        raise ParameterError(f"instance: {name}; expected {' or '.join(LIMITS)}")
    points, robots, _ = name.split(".")
    text = (files("muster_studies.instances") / _FOLDER / f"{points}.txt").read_text(encoding="utf-8")
    return orienteering_mission(text, int(robots), LIMITS[name], f"orienteering-{name}")


def orienteering_mission(text: str, robots: int, limit: float, name: str) -> Mission:
    """The points of a file as a mission of so many robots, each with this limit on its path.

    Raises
    ------
    ParameterError
        if a line has not three numbers, or there is no task between start and end.
    """
    points = [_point(line) for line in text.splitlines() if line.strip()]
    if len(points) <= 2:
        raise ParameterError(f"instance: {len(points)} points; expected the start, one task at least, and the end")
    (x, y, _), *tasks, (end_x, end_y, _) = points
    return Mission(
        name=name,
        rules=Rules(objective="total"),
        robots=tuple(
            Robot(id=f"r_{k}", position=(x, y), end_position=(end_x, end_y), work_capacity=limit) for k in range(robots)
        ),
        tasks=tuple(
            Task(id=str(j), position=(task_x, task_y), priority=score)
            for j, (task_x, task_y, score) in enumerate(tasks, start=1)
        ),
    )


def _point(line: str) -> tuple[float, float, float]:
    try:
        x, y, score = map(float, line.split())
    except ValueError:
        raise ParameterError(f"point: {line.strip()!r}; expected x, y, score") from None
    return x, y, score
