"""Writes missions as the CSV files of task lists, robots and suitability, to be read back."""

import csv

from muster.mission.errors import Finding, MissionError
from muster.mission.model import Mission, Robot, Task
from muster.mission.reading.thesis_csv import ROBOT_COLUMNS, TASK_COLUMNS, TIME_COLUMNS
from muster.mission.reading.thesis_csv import _prerequisites as prerequisites


def write_csv(mission, tasks, robots, suitability=None):
    """Write a mission as the three files that `read_csv` reads.

    Raises
    ------
    MissionError
        if the mission has something that these files cannot say; nothing is written then.
    """
    lost = [*_lost(mission, suitability is not None)]
    if lost:
        raise MissionError(lost)
    z = ("z",) if mission.dimensions == 3 else ()
    times = [name for name in TIME_COLUMNS if any(getattr(task, name) not in (None, ()) for task in mission.tasks)]
    task_lines = [[*TASK_COLUMNS[:3], *z, *TASK_COLUMNS[3:], *times]]
    task_lines += [[*_task_cells(task), *(_time_cell(getattr(task, name)) for name in times)] for task in mission.tasks]
    robot_lines = [[*ROBOT_COLUMNS[:4], *z, *ROBOT_COLUMNS[4:]]] + [_robot_cells(robot) for robot in mission.robots]
    _write(tasks, task_lines)
    _write(robots, robot_lines)
    if suitability is not None and mission.suitability is not None:
        _write(suitability, _suitability_lines(mission.suitability))


def _lost(mission, with_suitability):
    plain_tasks = [
        Task(**{name: getattr(t, name) for name in ("id", "position", *TASK_COLUMNS[3:], *TIME_COLUMNS)})
        for t in mission.tasks
    ]
    plain_robots = [
        Robot(id=r.id, position=r.position, type=r.type, work_capacity=r.work_capacity) for r in mission.robots
    ]
    plain = Mission(
        name=mission.name,
        robots=tuple(plain_robots),
        tasks=tuple(plain_tasks),
        suitability=mission.suitability if with_suitability else None,
    )
    names = ("origin_wgs84", "starts_at", "rules", "map", "travel", "suitability", "robots", "tasks", "events")
    lost = [name for name in names if getattr(plain, name) != getattr(mission, name)]
    lost += [name for name in ("robots", "tasks", "suitability") if name not in lost and not _cells_last(mission, name)]
    return [
        Finding(mission.source.file, None, name, "more than CSV can say", "what read_csv reads; or write YAML")
        for name in lost
    ]


def _cells_last(mission, group):
    """Whether ids and types come back from their cells as they are."""
    if group == "suitability":
        rows = mission.suitability or {}
        return all(name == name.strip() for name in (*rows, *(kind for row in rows.values() for kind in row)))
    words = [word for item in getattr(mission, group) for word in (item.id, item.type or "")]
    return all(word == word.strip() for word in words) and (
        group == "robots"
        or all(prerequisites(f"[{','.join(task.prerequisites)}]") == list(task.prerequisites) for task in mission.tasks)
    )


def _task_cells(task):
    x, y, *z = (repr(c) for c in task.position)
    prerequisites = f"[{','.join(task.prerequisites)}]"
    return [task.id, x, y, *z, task.type or "", repr(task.actuation_cost), prerequisites]


def _time_cell(value):
    if isinstance(value, tuple):
        return "; ".join(f"{begins!r} {'inf' if ends is None else repr(ends)}" for begins, ends in value)
    return "" if value is None else repr(value)


def _robot_cells(robot):
    x, y, *z = (repr(c) for c in robot.position)
    capacity = "inf" if robot.work_capacity is None else repr(robot.work_capacity)
    return [robot.id, robot.type or "", x, y, *z, capacity]


def _suitability_lines(suitability):
    columns = list(dict.fromkeys(kind for row in suitability.values() for kind in row))
    lines = [[name, *(repr(row.get(kind, 0.0)) for kind in columns)] for name, row in suitability.items()]
    return [["robot_type", *columns], *lines]


def _write(path, lines):
    with path.open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream, lineterminator="\n").writerows(lines)
