"""Tasks that need skills of several species of robots at once, by the generator of [dai2025], number for number.

Robots move, and missions are compared, as in the family `teams`.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from muster.generation.generator import MOST_TASKS, Generator
from muster.generation.teams import LONGEST_S, SPEED_MPS, TEAM_RULES, point
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Flag, Whole
from muster.mission.values.arrays import Integers

_TRIES = 1_000
_ANEW = 10_000


@record
class Coalitions(Checked):
    """What missions of the family `coalitions` share."""

    several_skills: bool = spec(
        Flag(), "a species may have several skills; else species k has skill k alone", default=True
    )
    most: int = spec(Whole(minimum=1, maximum=100), "a task needs none to so much of each skill", default=2)
    species: int = spec(Whole(minimum=1, maximum=20), "how many species of robots, and skills", default=5)
    robots_each: int = spec(Whole(minimum=1, maximum=1000), "robots of each species", default=5)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=50)


def coalitions_mission(given: Coalitions, seed: int) -> Mission:
    """The instance that the published generator makes of the seed.

    Raises
    ------
    ParameterError
        where robots that can do all tasks are not drawn in 1,000 tries.
    """
    draw = np.random.default_rng(seed)
    skills, needs = _able(given, draw)
    depots = draw.random((given.species, 2))
    draw.random(given.species)  # what the robots of each species cost, which the benchmark does not use
    places, work_s = draw.random((given.tasks, 2)), LONGEST_S * draw.random((given.tasks, 1))[:, 0]
    return Mission(
        rules=TEAM_RULES,
        robots=tuple(
            Robot(id=f"s{s}_{k}", position=point(depots[s]), speed_mps=SPEED_MPS, abilities=_amounts(skills[s]))
            for s in range(given.species)
            for k in range(given.robots_each)
        ),
        tasks=tuple(
            Task(id=str(j), position=point(places[j]), duration_s=float(work_s[j]), needs=_amounts(needs[j]))
            for j in range(given.tasks)
        ),
    )


def _able(given: Coalitions, draw: np.random.Generator) -> tuple[Integers, Integers]:
    """Skills and needs, drawn until the robots together can do every task."""
    anew = iter(range(_ANEW))
    for _ in range(_TRIES):
        skills, needs = _skills(given, draw), _needs(given, draw, anew)
        if (given.robots_each * skills.sum(axis=0) >= needs).all():
            return skills, needs
    raise ParameterError(f"coalitions: most: {given.most}; expected less, or more robots_each ({given.robots_each})")


def _skills(given: Coalitions, draw: np.random.Generator) -> Integers:
    """(species, skills) which skills a species has: each species at least one, and no two the same."""
    if not given.several_skills:
        return np.eye(given.species, dtype=np.int64)
    while True:
        skills: Integers = draw.integers(0, 2, (given.species, given.species))
        if skills.any(axis=1).all() and len(np.unique(skills, axis=0)) == given.species:
            return skills


def _needs(given: Coalitions, draw: np.random.Generator, anew: Iterator[int]) -> Integers:
    """(tasks, skills) how much of each skill a task needs: each task something.

    All are drawn anew where a task needs nothing, as published; once that was done `_ANEW` times, as of many tasks,
    those that need nothing alone, which has the same distribution.
    """
    for _ in anew:
        needs: Integers = draw.integers(0, given.most + 1, (given.tasks, given.species))
        if needs.any(axis=1).all():
            return needs
    while (empty := ~needs.any(axis=1)).any():
        needs[empty] = draw.integers(0, given.most + 1, (int(empty.sum()), given.species))
    return needs


def _amounts(amounts: Integers) -> dict[str, float]:
    return {f"skill_{k}": float(amount) for k, amount in enumerate(amounts) if amount}


COALITIONS = Generator(
    name="coalitions",
    summary="species of robots with different skills; each task needs amounts of several skills at once",
    source="the published generator of [dai2025], number for number",
    parameters=Coalitions,
    make=coalitions_mission,
)
