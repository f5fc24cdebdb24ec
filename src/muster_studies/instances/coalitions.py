"""Published sets of instances for coalitions of robots, by the generator of [dai2025], number for number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from muster.generation.coalitions import Coalitions, coalitions_mission
from muster.mission.model import Mission
from muster_studies.instances.references import references


@dataclass(frozen=True, kw_only=True)
class SkillSet:
    """A set of instances in which tasks need skills of several species of robots [dai2025].

    Parameters
    ----------
    parameters
        of the family `coalitions`.
    first_seed
        of the published instances; the others follow.
    """

    name: str
    parameters: Coalitions
    first_seed: int

    @property
    def best_known(self) -> tuple[float, ...]:
        """The least makespan known of each of the first ten instances, in seconds."""
        return tuple(references()["coalitions"][self.name])

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
)
ONE_SKILL = SkillSet(
    name="SA-BT-25-5-50",
    parameters=Coalitions(several_skills=False, most=1),
    first_seed=102_000,
)

SKILL_SETS: Mapping[str, SkillSet] = MappingProxyType({"several": SEVERAL_SKILLS, "one": ONE_SKILL})
