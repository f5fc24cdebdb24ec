"""Published sets of instances for coalitions of robots, by the generator of [dai2025], number for number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from muster.generation.coalitions import Coalitions, coalitions_mission
from muster.mission.model import Mission


@dataclass(frozen=True, kw_only=True)
class SkillSet:
    """A set of instances in which tasks need skills of several species of robots [dai2025].

    Parameters
    ----------
    parameters
        of the family `coalitions`.
    first_seed
        of the published instances; the others follow.
    best_known
        the least makespan known of each of the first ten, in seconds.
    """

    name: str
    parameters: Coalitions
    first_seed: int
    best_known: tuple[float, ...]

    def instance(self, number: int) -> Mission:
        """The published instance of that number, from 0."""
        return self.mission(self.first_seed + number)

    def mission(self, seed: int) -> Mission:
        """The instance that the published generator makes of the seed."""
        return replace(coalitions_mission(self.parameters, seed), name=f"{self.name}-{seed}")


SEVERAL_SKILLS = SkillSet(
    name="MA-AT-25-5-50",
    parameters=Coalitions(several_skills=True, most=2),
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
    parameters=Coalitions(several_skills=False, most=1),
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
