"""A judge of joint paths that shares no code with what makes them."""

from __future__ import annotations

from collections.abc import Sequence

from muster.mission.values.arrays import Bools


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
    found = []
    for robot, (path, (start, goal)) in enumerate(zip(paths, ends, strict=True)):
        if path[0] != start or path[-1] != goal:
            found.append(f"robot {robot} goes from {path[0]} to {path[-1]}, not from {start} to {goal}")
        for step, (row, column) in enumerate(path):
            inside = 0 <= row < blocked.shape[0] and 0 <= column < blocked.shape[1]
            if not inside or blocked[row, column]:
                found.append(f"robot {robot} is in ({row}, {column}) at step {step}, which is blocked")
            if step and abs(row - path[step - 1][0]) + abs(column - path[step - 1][1]) > 1:
                found.append(f"robot {robot} jumps at step {step}")
    for step in range(max(map(len, paths), default=0)):
        here: dict[tuple[int, int], int] = {}
        moves: dict[tuple[tuple[int, int], tuple[int, int]], int] = {}
        for robot, path in enumerate(paths):
            cell, before = path[min(step, len(path) - 1)], path[min(max(step - 1, 0), len(path) - 1)]
            if cell in here:
                found.append(f"robots {here[cell]} and {robot} are both in {cell} at step {step}")
            if cell != before and (cell, before) in moves:
                found.append(f"robots {moves[cell, before]} and {robot} change places at step {step}")
            here[cell] = moves[before, cell] = robot
    return found
