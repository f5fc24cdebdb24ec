"""Random missions for teams, by the generators of two published benchmarks, number for number.

All robots move at 0.2 m/s on a square of 1 m and return to where they start; the objective is the makespan, with the
way back. The same seed gives the instance that the published generator makes of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from muster.mission.model import Mission, Robot, Rules, Task

_SPEED_MPS = 0.2
_LONGEST_S = 5.0
_RULES = Rules(objective="makespan", return_to_start=True, makespan_includes_return=True)
_MOST_OF_A_TEAM = 5

Integers = npt.NDArray[np.int64]


def counted_teams(seed: int, robots: int = 20, tasks: int = 50) -> Mission:
    """Equal robots at one depot; each task needs 1 to 5 of them [dai2024]. Seeds 0 to 49 are its published test set."""
    draw = np.random.default_rng(seed)
    depot = draw.random((1, 2))[0]
    draw.random((robots, 1))  # what each robot costs, which the benchmark does not use
    places, work_s = draw.random((tasks, 2)), _LONGEST_S * draw.random((tasks, 1))[:, 0]
    needed = draw.integers(1, _MOST_OF_A_TEAM + 1, tasks)
    return Mission(
        name=f"counted-teams-{robots}-{tasks}-{seed}",
        rules=_RULES,
        robots=tuple(Robot(id=f"r_{k}", position=_point(depot), speed_mps=_SPEED_MPS) for k in range(robots)),
        tasks=tuple(
            Task(id=str(j), position=_point(places[j]), duration_s=float(work_s[j]), robots_needed=int(needed[j]))
            for j in range(tasks)
        ),
    )


@dataclass(frozen=True, kw_only=True)
class SkillSet:
    """A set of instances in which tasks need skills of several species of robots [dai2025].

    Parameters
    ----------
    several_skills
        whether a species may have several skills; else species k has skill k.
    most
        how much of one skill a task needs, at most.
    first_seed
        of the published instances; the others follow.
    best_known
        the least makespan known of each of the first ten, in seconds.
    """

    name: str
    several_skills: bool
    most: int
    first_seed: int
    best_known: tuple[float, ...]
    species: int = 5
    robots_each: int = 5
    tasks: int = 50

    def instance(self, number: int) -> Mission:
        """The published instance of that number, from 0."""
        return self.mission(self.first_seed + number)

    def mission(self, seed: int) -> Mission:
        """The instance that the published generator makes of the seed."""
        draw = np.random.default_rng(seed)
        skills, needs = self._skills(draw), self._needs(draw)
        while (self.robots_each * skills.sum(axis=0) < needs).any():
            skills, needs = self._skills(draw), self._needs(draw)
        depots = draw.random((self.species, 2))
        draw.random(self.species)  # what the robots of each species cost, which the benchmark does not use
        places, work_s = draw.random((self.tasks, 2)), _LONGEST_S * draw.random((self.tasks, 1))[:, 0]
        return Mission(
            name=f"{self.name}-{seed}",
            rules=_RULES,
            robots=tuple(
                Robot(id=f"s{s}_{k}", position=_point(depots[s]), speed_mps=_SPEED_MPS, abilities=_amounts(skills[s]))
                for s in range(self.species)
                for k in range(self.robots_each)
            ),
            tasks=tuple(
                Task(id=str(j), position=_point(places[j]), duration_s=float(work_s[j]), needs=_amounts(needs[j]))
                for j in range(self.tasks)
            ),
        )

    def _skills(self, draw: np.random.Generator) -> Integers:
        """(species, skills) which skills a species has: each species at least one, and no two the same."""
        if not self.several_skills:
            return np.eye(self.species, dtype=np.int64)
        while True:
            skills: Integers = draw.integers(0, 2, (self.species, self.species))
            if skills.any(axis=1).all() and len(np.unique(skills, axis=0)) == self.species:
                return skills

    def _needs(self, draw: np.random.Generator) -> Integers:
        """(tasks, skills) how much of each skill a task needs: each task something."""
        while True:
            needs: Integers = draw.integers(0, self.most + 1, (self.tasks, self.species))
            if needs.any(axis=1).all():
                return needs


def _point(place: npt.NDArray[np.float64]) -> tuple[float, float]:
    return float(place[0]), float(place[1])


def _amounts(amounts: Integers) -> dict[str, float]:
    return {f"skill_{k}": float(amount) for k, amount in enumerate(amounts) if amount}


SEVERAL_SKILLS = SkillSet(
    name="MA-AT-25-5-50",
    several_skills=True,
    most=2,
    first_seed=111_000,
    best_known=(
        19.365229,
        42.237823,
        38.199177,
        21.186891,
        24.677104,
        22.916552,
        21.460759,
        40.663522,
        29.014572,
        22.963225,
    ),
)
ONE_SKILL = SkillSet(
    name="SA-BT-25-5-50",
    several_skills=False,
    most=1,
    first_seed=102_000,
    best_known=(
        25.986841,
        26.026747,
        28.041995,
        27.831426,
        27.942589,
        27.453184,
        30.386033,
        29.021944,
        24.663727,
        26.460264,
    ),
)

SKILL_SETS: Mapping[str, SkillSet] = MappingProxyType({"several": SEVERAL_SKILLS, "one": ONE_SKILL})
