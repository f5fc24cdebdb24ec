"""Tasks on a lattice, for which missions end early only with a good schedule."""

from __future__ import annotations

from muster.mission.model import Mission, Robot, Rules, Task


def lattice_mission(rows: int, columns: int, robots: int) -> Mission:
    """Tasks without work 10 m apart on a lattice, and robots that all begin at its corner."""
    team = tuple(Robot(id=f"r{k}", position=(0.0, 0.0, 0.0)) for k in range(robots))
    work = tuple(
        Task(id=f"t{row}-{column}", position=(10.0 * column, 10.0 * row, 0.0))
        for row in range(rows)
        for column in range(columns)
    )
    return Mission(name=f"lattice-{rows}-{columns}", rules=Rules(objective="makespan"), robots=team, tasks=work)
