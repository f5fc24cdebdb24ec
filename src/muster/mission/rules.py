"""The rules of a mission: objective, usage, travel, suitability and other settings."""

from __future__ import annotations

from muster.mission.records import record, spec
from muster.mission.rule_keys import RuleKeys
from muster.mission.value_types import Choice, Flag, Number, Whole

OBJECTIVES = ("total+max", "total", "max", "average", "makespan", "lateness")


@record
class Rules(RuleKeys, bearer="rules"):
    """What counts, and how."""

    objective: str = spec(Choice(OBJECTIVES), "what is minimised after most tasks completed", default="total+max")
    usage: str = spec(Choice(("distance", "time")), "the unit of usage: metres or seconds", default="distance")
    min_suitability: float = spec(Number(minimum=0, maximum=1), "least suitability to be assigned", default=0.65)
    return_to_start: bool = spec(Flag(), "every robot goes back to its start", default=False)
    travel: str | None = spec(
        Choice(("euclidean", "map", "lanes", "matrix")),
        "how travel is measured: lanes where there are any, else euclidean without a map, else map",
        default=None,
    )
    capacity_reserve: float = spec(Number(minimum=0, below=1), "share of the work capacity kept free", default=0.0)
    stability: int | None = spec(Whole(), "tasks that may change robot per event", default=None)
    timing: str = spec(
        Choice(("profile", "constant")), "travel times: of the motion profile, or by the speed alone", default="profile"
    )
    makespan_includes_return: bool = spec(Flag(), "the makespan counts the ways of robots to their ends", default=False)

    @property
    def usable_share(self) -> float:
        """The share of a work capacity that routes may use."""
        return 1.0 - self.capacity_reserve
