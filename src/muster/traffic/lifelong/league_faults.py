"""A judge of runs of the League of Robot Runners that shares no code with what makes them."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from muster.mission.values.arrays import Indices
from muster.traffic.lifelong.league_run import LeagueRun

_ROWS, _COLUMNS = np.array([0, 1, 0, -1]), np.array([1, 0, -1, 0])
"""Of a step forward east, south, west and north."""
_TURNS = {ord("F"): 0, ord("W"): 0, ord("R"): 1, ord("C"): 3}


def league_faults(run: LeagueRun) -> list[str]:
    """Return what is wrong with a run; empty if nothing is.

    Each step is replayed from the actions: moves lead to free cells of the map, no two robots are in one cell or swap
    cells, tasks are revealed, assigned and visited by the rules, and what the run claims to have finished it has.
    """
    lengths = {len(actions) for actions in run.actions}
    letters = set("".join(run.actions))
    if lengths != {run.steps} or not letters <= set("FRCW"):
        return [f"actions: lengths {sorted(lengths)}, letters {sorted(letters)}; expected {run.steps} of F R C W each"]
    cells, found = _replay(run)
    return found + _collisions(cells) + _Tasks(run, cells).faults()


def _replay(run: LeagueRun) -> tuple[Indices, list[str]]:
    """Return the cell of each robot, (steps + 1, robots), and moves that leave the free cells of the map."""
    actions = np.array([np.frombuffer(text.encode(), dtype=np.uint8) for text in run.actions])
    turns = np.zeros(128, dtype=np.int64)
    turns[list(_TURNS)] = list(_TURNS.values())
    headings = np.cumsum(turns[actions], axis=1) % 4
    forward = actions == ord("F")
    height, width = run.instance.blocked.shape
    rows, columns = (
        np.concatenate([start[:, None], np.where(forward, by[headings], 0)], axis=1).cumsum(axis=1).T
        for start, by in zip(np.divmod(np.array(run.instance.starts), width), (_ROWS, _COLUMNS), strict=True)
    )
    outside = (rows < 0) | (rows >= height) | (columns < 0) | (columns >= width)
    inside_rows, inside_columns = np.where(outside, 0, rows), np.where(outside, 0, columns)
    wrong = np.argwhere(outside | run.instance.blocked[inside_rows, inside_columns])
    found = [f"robot {robot} is not in a free cell at step {step}" for step, robot in wrong.tolist()]
    return inside_rows * width + inside_columns, found


def _collisions(cells: Indices) -> list[str]:
    found = []
    for step in range(len(cells)):
        here = cells[step]
        order = np.argsort(here, kind="stable")
        shared = np.flatnonzero(np.diff(here[order]) == 0)
        found += [f"robots {order[k]} and {order[k + 1]} are in one cell at step {step}" for k in shared.tolist()]
        if step == 0:
            continue
        before = cells[step - 1]
        at = {int(cell): robot for robot, cell in enumerate(before)}
        for robot in np.flatnonzero(here != before).tolist():
            other = at.get(int(here[robot]))
            if other is not None and other > robot and here[other] == before[robot]:
                found.append(f"robots {robot} and {other} swap cells at step {step}")
    return found


class _Tasks:
    """The tasks of a run, replayed from its assignments and the cells of its robots."""

    def __init__(self, run: LeagueRun, cells: Indices) -> None:
        self._run, self._cells = run, cells
        self._task = np.full(len(run.actions), -1)
        self._goal = np.full(len(run.actions), -1)
        self._visited: dict[int, int] = {}  # by revealed task that is not finished: cells visited
        self._robot: dict[int, int] = {}  # by task: the robot that has it
        self._found: list[str] = []
        self._reveals: dict[int, list[int]] = defaultdict(list)
        self._assigned: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for task, step in enumerate(run.revealed):
            self._reveals[step].append(task)
        for step, robot, task in run.assignments:
            self._assigned[step].append((robot, task))

    def faults(self) -> list[str]:
        """Return what is wrong with tasks, from the first step to the last."""
        events, finished = [], 0
        self._reveal(0)
        for step in range(self._run.steps):
            self._assign(step)
            for robot in np.flatnonzero(self._cells[step + 1] == self._goal).tolist():
                task = int(self._task[robot])
                self._visited[task] += 1
                events.append((step + 1, robot, task, self._visited[task]))
                finished += self._is_finished(robot, task)
            self._reveal(step + 1)
        if events != list(self._run.events):
            self._found.append(f"events: {len(self._run.events)} that are not the {len(events)} of the moves")
        if finished != self._run.finished:
            self._found.append(f"finished: {self._run.finished} tasks; the moves finish {finished}")
        return self._found

    def _reveal(self, step: int) -> None:
        self._visited |= dict.fromkeys(self._reveals[step], 0)
        if len(self._visited) != self._run.instance.revealed:
            expected = self._run.instance.revealed
            self._found.append(f"step {step}: {len(self._visited)} tasks are revealed; expected {expected}")

    def _assign(self, step: int) -> None:
        """Take tasks from robots first, so that two may exchange theirs."""
        for robot, _ in self._assigned[step]:
            before = int(self._task[robot])
            if before >= 0 and self._visited[before] > 0:
                self._found.append(f"step {step}: robot {robot} leaves task {before}, which it has begun")
            self._robot.pop(before, None)
            self._task[robot] = self._goal[robot] = -1
        for robot, task in self._assigned[step]:
            if task < 0:
                continue
            if task not in self._visited:
                self._found.append(f"step {step}: robot {robot} gets task {task}, which is not revealed or is finished")
            elif task in self._robot:
                self._found.append(f"step {step}: robots {self._robot[task]} and {robot} have task {task}")
            else:
                self._robot[task] = robot
                self._task[robot] = task
                self._set_goal(robot, task)

    def _is_finished(self, robot: int, task: int) -> bool:
        if self._visited[task] < len(self._cells_of(task)):
            self._set_goal(robot, task)
            return False
        del self._visited[task], self._robot[task]
        self._task[robot] = self._goal[robot] = -1
        return True

    def _set_goal(self, robot: int, task: int) -> None:
        self._goal[robot] = self._cells_of(task)[self._visited[task]]

    def _cells_of(self, task: int) -> list[int]:
        tasks = self._run.instance.tasks
        return tasks[task % len(tasks)]
