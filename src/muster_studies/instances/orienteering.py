"""Team orienteering instances of Chao, Golden and Wasil as missions that no team can do whole [chao1996].

A point is a task, its score the priority: what counts is the score of the tasks done. The limit on each path is the
robots' work capacity. A file of `orienteering_instances` has the points of one of the seven sets, a line `x y score`
each: the start first, the end last. The instances of a set have these points in common, and differ in robots and limit.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Rules, Task
from muster_studies.instances.references import references

_FOLDER = "orienteering_instances"

LIMITS: Mapping[str, float] = {name: row["limit"] for name, row in references()["orienteering"].items()}
"""By instance, pSET.ROBOTS.LETTER, the limit on each path."""

BEST_SCORES: Mapping[str, int] = {name: row["score"] for name, row in references()["orienteering"].items()}
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
