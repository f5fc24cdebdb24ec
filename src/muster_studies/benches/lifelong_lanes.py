"""Standing fleets on given lanes that form a grid, beside a loop of PIBT on the same graph: part of `muster bench`.

All orders come within the first second; each is done where it is, at once. In the loop a robot that is free takes the
nearest open order, counted in rows and columns, and all move one lane of 1 m a second by PIBT [okumura2022].
"""

from __future__ import annotations

import random
import time
from contextlib import closing
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from muster.execution import Standing
from muster.mission.lanes import Lane, Lanes
from muster.mission.model import Event, Mission, Robot, Rules, Task
from muster.mission.values.arrays import Bools, Floats, Indices
from muster.planning.solve import solve
from muster.running.simulation import LOOK_S, Simulation
from muster_studies.benches.joint_paths import warehouse
from muster_studies.benches.measurement import Measurement

ORDERS_EACH = 10
COME_WITHIN_S = 1.0
SMALL, LARGE = (6, 2, 4), (20, 10, 25)
"""Rows of racks, racks a row, free columns on each side."""


@dataclass(frozen=True)
class Burst:
    """Robots on a grid and the orders that come in the first second.

    Parameters
    ----------
    cells : Indices
        (n, 2) row and column of each free cell; lanes of 1 m lead to and fro between those side by side.
    pairs : Indices
        (m, 2) cells side by side, by number.
    starts, orders : list of int
        Cells, by number.
    """

    cells: Indices
    pairs: Indices
    starts: list[int]
    orders: list[int]

    @classmethod
    def of(cls, blocked: Bools, robots: int, seed: int) -> Burst:
        """Random starts, all apart, and random places of orders."""
        number = np.where(blocked, -1, np.cumsum(~blocked.ravel()).reshape(blocked.shape) - 1)
        across, down = np.stack([number[:, :-1], number[:, 1:]], -1), np.stack([number[:-1], number[1:]], -1)
        pairs = np.concatenate([across.reshape(-1, 2), down.reshape(-1, 2)])
        cells, chance = np.argwhere(~blocked), random.Random(seed)
        starts = chance.sample(range(len(cells)), robots)
        orders = [chance.randrange(len(cells)) for _ in range(ORDERS_EACH * robots)]
        return cls(cells, pairs[(pairs >= 0).all(axis=1)], starts, orders)

    def place(self, cell: int) -> tuple[float, float]:
        """The centre of a cell, metres."""
        row, column = self.cells[cell].tolist()
        return float(column), float(-row)

    @property
    def mission(self) -> Mission:
        """The robots and lanes as a mission without tasks."""
        nodes = {f"n{k}": self.place(k) for k in range(len(self.cells))}
        lanes = tuple(Lane(start=f"n{a}", end=f"n{b}", both_ways=True) for a, b in self.pairs.tolist())
        robots = tuple(
            Robot(id=f"r{k}", position=self.place(cell), radius_m=0.3, speed_mps=1.0)
            for k, cell in enumerate(self.starts)
        )
        rules = Rules(objective="lateness", usage="time")
        return Mission(name="lanes", robots=robots, tasks=(), lanes=Lanes(nodes=nodes, edges=lanes), rules=rules)

    @property
    def events(self) -> list[Event]:
        """The orders as events, evenly within `COME_WITHIN_S`."""
        apart_s = COME_WITHIN_S / len(self.orders)
        return [
            Event(at_s=k * apart_s, new_task=Task(id=f"o{k}", position=self.place(cell)))
            for k, cell in enumerate(self.orders)
        ]


@dataclass
class PibtLoop:
    """Robots that move by PIBT, a step a second, from one nearest open order to the next."""

    burst: Burst
    seed: int = 0
    steps: int = 0
    _distances: dict[int, Floats] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = len(self.burst.cells)
        there = np.concatenate([self.burst.pairs, self.burst.pairs[:, ::-1]])
        self._graph = coo_array((np.ones(len(there)), there.T), shape=(n, n)).tocsr()
        self._beside = [self._graph.indices[a:b].tolist() for a, b in pairwise(self._graph.indptr)]
        self._random = random.Random(self.seed)
        self._at = list(self.burst.starts)
        self._goal: list[int | None] = [None] * len(self._at)
        self._own = [self._random.random() for _ in self._at]
        self._priority = list(self._own)

    def run(self, most_steps: int = 100_000) -> int:
        """Go on until all orders are done, or so many steps are; return the number of orders that are done."""
        waiting, done = list(self.burst.orders), 0
        while (waiting or any(goal is not None for goal in self._goal)) and self.steps < most_steps:
            self._assign(waiting)
            self._move()
            self.steps += 1
            done += self._arrive()
        return done

    def _assign(self, waiting: list[int]) -> None:
        for robot, goal in enumerate(self._goal):
            if goal is None and waiting:
                apart = np.abs(self.burst.cells[waiting] - self.burst.cells[self._at[robot]]).sum(axis=1)
                self._goal[robot] = waiting.pop(int(apart.argmin()))

    def _move(self) -> None:
        """One step of PIBT: robots in the order of their priorities take cells, and push those who stand there."""
        standing = {cell: robot for robot, cell in enumerate(self._at)}
        taken: dict[int, int] = {}
        following: list[int | None] = [None] * len(self._at)

        def push(robot: int, pusher: int | None) -> bool:
            here = self._at[robot]
            wanted = [*self._beside[here], here]
            self._random.shuffle(wanted)
            for cell in sorted(wanted, key=lambda cell: (self._left(robot, cell), cell in standing)):
                if cell in taken or (pusher is not None and cell == self._at[pusher]):
                    continue
                taken[cell], following[robot] = robot, cell
                other = standing.get(cell)
                if other is None or other == robot or following[other] is not None or push(other, robot):
                    return True
            taken[here], following[robot] = robot, here
            return False

        for robot in sorted(range(len(self._at)), key=lambda robot: -self._priority[robot]):
            if following[robot] is None:
                push(robot, None)
        self._at = [cell for cell in following if cell is not None]

    def _left(self, robot: int, cell: int) -> float:
        """The steps from a cell to a robot's goal; a robot without one stays where it is."""
        goal = self._goal[robot]
        if goal is None:
            return float(cell != self._at[robot])
        if goal not in self._distances:
            self._distances[goal] = dijkstra(self._graph, indices=goal, unweighted=True)
        return float(self._distances[goal][cell])

    def _arrive(self) -> int:
        done = 0
        for robot, goal in enumerate(self._goal):
            if goal is None:
                self._priority[robot] = self._own[robot] - 1
            elif self._at[robot] == goal:
                self._goal[robot], self._priority[robot], done = None, self._own[robot], done + 1
            else:
                self._priority[robot] = max(self._priority[robot], 0.0) + 1
        return done


def small(runs: int) -> list[Measurement]:
    """Ten and twenty robots in a small warehouse; once, however many runs are asked for."""
    return [row for robots in (10, 20) for row in compared(SMALL, robots)]


def large(runs: int) -> list[Measurement]:
    """A hundred and more robots on 5,699 nodes; once."""
    return [row for robots in (100, 200, 500) for row in compared(LARGE, robots)]


def compared(size: tuple[int, int, int], robots: int, seed: int = 0) -> list[Measurement]:
    """Muster and the loop on the same orders, one after the other."""
    burst = Burst.of(warehouse(*size), robots, seed)
    begin_s = time.process_time()
    loop = PibtLoop(burst, seed)
    done = loop.run()
    loop_s = time.process_time() - begin_s
    steps_s: list[float] = []
    begin_s = time.process_time()
    mission, orders = burst.mission, burst.events
    standing = Standing(orders=orders, until_s=COME_WITHIN_S + LOOK_S)
    with closing(Simulation(mission, solve(mission, "greedy"), seed=seed, standing=standing)) as simulation:
        built_s = time.process_time() - begin_s
        while not simulation.done:
            step_begin_s = time.thread_time()
            simulation.advance(simulation.time_s + LOOK_S)
            steps_s.append(time.thread_time() - step_begin_s)
        report = simulation.result()
    own_s, last_s = time.process_time() - begin_s - built_s, report.mission_time_s
    assert report.contacts is not None  # a simulation counts them
    what, rate = f"{robots} robots on {len(burst.cells):,} nodes", len(orders) / loop.steps
    lost, step_s = len(orders) - len(report.tasks_done), float(np.quantile(steps_s, 0.99))
    return [
        Measurement.once(
            f"{what}: orders lost", "of all", lost, "0", f"{len(orders)} came; loop: {len(orders) - done}"
        ),
        Measurement.once(f"{what}: contacts", "", report.contacts, "0"),
        Measurement.once(f"{what}: orders done a second", "", len(orders) / last_s, f">= {rate:.2f}", "the loop's"),
        Measurement.once(f"{what}: built in", "s", built_s, "< 2"),
        Measurement.once(
            f"{what}: CPU a simulated s", "ms", 1000 * own_s / last_s, "", f"loop: {1000 * loop_s / loop.steps:.1f}"
        ),
        Measurement.once(f"{what}: a step, 99 %", "ms", 1000 * step_s, "< 50", "control thread"),
    ]
