"""A judge of joint paths that shares no code with what makes them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Sequence
from typing import TypeVar

from muster.mission.values.arrays import Bools

Place = TypeVar("Place", bound=Hashable)


def faults(
    blocked: Bools, paths: Sequence[Sequence[tuple[int, int]]], ends: Sequence[tuple[object, object]]
) -> list[str]:
    """What is wrong with paths on a grid whose cells are joined to those beside, above and below; empty if nothing is.

    Parameters
    ----------
    blocked
        (rows, columns).
    paths
        for each robot its cells (row, column), step by step.
    ends
        for each robot its start and its goal.
    """

    def is_place(cell: tuple[int, int]) -> bool:
        row, column = cell
        return 0 <= row < blocked.shape[0] and 0 <= column < blocked.shape[1] and not blocked[row, column]

    def is_move(before: tuple[int, int], cell: tuple[int, int]) -> bool:
        return abs(cell[0] - before[0]) + abs(cell[1] - before[1]) <= 1

    return _faults(paths, ends, is_place, is_move)


def graph_faults(
    size: int,
    edges: Collection[tuple[int, int]],
    paths: Sequence[Sequence[int]],
    ends: Sequence[tuple[object, object]],
) -> list[str]:
    """Return what is wrong with paths on a directed graph; empty if nothing is.

    Parameters
    ----------
    size : int
        The number of vertices.
    edges : Collection[tuple[int, int]]
        The vertices that each edge joins, from and to.
    paths : Sequence[Sequence[int]]
        For each robot its vertices, step by step.
    ends : Sequence[tuple[object, object]]
        For each robot its start and its goal.
    """
    joined = set(edges)

    def is_move(before: int, vertex: int) -> bool:
        return before == vertex or (before, vertex) in joined

    return _faults(paths, ends, lambda vertex: 0 <= vertex < size, is_move)


def _faults(
    paths: Sequence[Sequence[Place]],
    ends: Sequence[tuple[object, object]],
    is_place: Callable[[Place], bool],
    is_move: Callable[[Place, Place], bool],
) -> list[str]:
    found = []
    for robot, (path, (start, goal)) in enumerate(zip(paths, ends, strict=True)):
        if path[0] != start or path[-1] != goal:
            found.append(f"robot {robot} goes from {path[0]} to {path[-1]}, not from {start} to {goal}")
        for step, place in enumerate(path):
            if not is_place(place):
                found.append(f"robot {robot} is in {place} at step {step}, which is blocked")
            if step and not is_move(path[step - 1], place):
                found.append(f"robot {robot} jumps at step {step}")
    for step in range(max(map(len, paths), default=0)):
        here: dict[Place, int] = {}
        moves: dict[tuple[Place, Place], int] = {}
        for robot, path in enumerate(paths):
            place, before = path[min(step, len(path) - 1)], path[min(max(step - 1, 0), len(path) - 1)]
            if place in here:
                found.append(f"robots {here[place]} and {robot} are both in {place} at step {step}")
            if place != before and (place, before) in moves:
                found.append(f"robots {moves[place, before]} and {robot} change places at step {step}")
            here[place] = moves[before, place] = robot
    return found
