"""Missions that end early only with a good schedule: tasks that wait for each other, time windows, a lattice."""

from __future__ import annotations

from random import Random

from muster.mission.model import Mission, Robot, Rules, Task

_SIDE_M = 100.0
_ORDERED = 0.1
"""The share of pairs of tasks of which the first is a prerequisite of the second."""


def windows_mission(seed: int) -> Mission:
    """3 to 10 robots, 9 to 60 tasks with work of 20 to 40 s and one time window each, a tenth of the pairs ordered."""
    draw = Random(seed)
    robots = tuple(Robot(id=f"r{k}", position=_place(draw)) for k in range(draw.randint(3, 10)))
    tasks = []
    for k in range(draw.randint(9, 60)):
        opens = draw.uniform(0, 400)
        before = tuple(f"t{j}" for j in range(k) if draw.random() < _ORDERED)
        window = ((opens, opens + draw.uniform(30, 1600)),)
        place, work_s = _place(draw), draw.uniform(20, 40)
        tasks.append(Task(id=f"t{k}", position=place, duration_s=work_s, window_s=window, prerequisites=before))
    return Mission(name=f"windows-{seed}", rules=Rules(objective="makespan"), robots=robots, tasks=tuple(tasks))


def ordered_mission(tasks: int, robots: int, seed: int) -> Mission:
    """Tasks that each wait for up to two of the hundred before them."""
    draw = Random(seed)
    team = tuple(Robot(id=f"r{k}", position=_place(draw)) for k in range(robots))
    work = tuple(
        Task(
            id=f"t{k}",
            position=_place(draw),
            actuation_cost=draw.choice((0.0, 2.0, 8.0, 20.0)),
            prerequisites=tuple(f"t{j}" for j in draw.sample(range(max(0, k - 100), k), min(k, draw.randint(0, 2)))),
        )
        for k in range(tasks)
    )
    return Mission(name=f"ordered-{tasks}", rules=Rules(objective="makespan"), robots=team, tasks=work)


def lattice_mission(rows: int, columns: int, robots: int) -> Mission:
    """Tasks without work 10 m apart on a lattice, and robots that all begin at its corner."""
    team = tuple(Robot(id=f"r{k}", position=(0.0, 0.0, 0.0)) for k in range(robots))
    work = tuple(
        Task(id=f"t{row}-{column}", position=(10.0 * column, 10.0 * row, 0.0))
        for row in range(rows)
        for column in range(columns)
    )
    return Mission(name=f"lattice-{rows}-{columns}", rules=Rules(objective="makespan"), robots=team, tasks=work)


def _place(draw: Random) -> tuple[float, float, float]:
    return draw.uniform(0, _SIDE_M), draw.uniform(0, _SIDE_M), 0.0
