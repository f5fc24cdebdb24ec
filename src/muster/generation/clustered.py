"""Depots all over a square, and tasks in clusters; robots go back to their depots."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.mission.model import OBJECTIVES, Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Choice, Number, Whole

Places = Sequence[tuple[float, float]]


@record
class Clustered(Checked):
    """What missions of the family `clustered` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots, each at a depot of its own", default=4)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=40)
    clusters: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many clusters of tasks", default=7)
    spread_m: float = spec(Number(minimum=0), "standard deviation of a cluster, along x and along y", default=45.0)
    side_m: float = spec(Number(above=0), "side of the square", default=1000.0)
    objective: str = spec(Choice(OBJECTIVES), "what is minimised", default="total")


def clustered_mission(given: Clustered, seed: int) -> Mission:
    """The mission of a seed: `cc64` of `muster bench peers-routes` is of this kind."""
    draw = np.random.default_rng(seed)
    centres = draw.uniform(0, given.side_m, (given.clusters, 2))
    places = centres[draw.integers(0, given.clusters, given.tasks)] + draw.normal(0, given.spread_m, (given.tasks, 2))
    depots = draw.uniform(0, given.side_m, (given.robots, 2))
    name = f"clustered-{given.robots}-{given.tasks}-{seed}"
    return closed_routes(pairs(depots), pairs(places), given.objective, name)


def closed_routes(depots: Places, tasks: Places, objective: str, name: str) -> Mission:
    """A robot r_0, r_1, ... at each depot, to which it returns; tasks 1, 2, ..."""
    return Mission(
        name=name,
        rules=Rules(objective=objective, return_to_start=True),
        robots=tuple(Robot(id=f"r_{k}", position=depot) for k, depot in enumerate(depots)),
        tasks=tuple(Task(id=str(j), position=place) for j, place in enumerate(tasks, start=1)),
    )


def pairs(places: np.typing.NDArray[np.float64]) -> list[tuple[float, float]]:
    """Places (n, 2) to the millimetre."""
    return [(float(x), float(y)) for x, y in places.round(3)]


CLUSTERED = Generator(
    name="clustered",
    summary="depots all over a square, tasks in clusters; robots go back to their depots",
    source="the table `depots` of `muster bench peers-routes`",
    parameters=Clustered,
    make=clustered_mission,
)
