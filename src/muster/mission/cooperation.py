"""What ties tasks to each other in time, and robots to each other at a task: lags and teams."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from muster.mission.records import Checked, Record, record, spec
from muster.mission.value_types import INVALID, Choice, Fault, JsonSchema, Many, Number, Path, Text, Whole, shown

if TYPE_CHECKING:
    from muster.mission.robots import Robot


@record
class Lag(Checked):
    """How long after the end of a prerequisite work begins."""

    after_s: float = spec(Number(minimum=0), "at least so long after its end", default=0.0)
    within_s: float | None = spec(Number(minimum=0), "at most so long after its end", default=None)

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        after, within = values.get("after_s", 0.0), values.get("within_s")
        if within is not None and within < after:
            yield Fault(("within_s",), shown(within), f"a number of at least after_s ({after:g})")


@record
class _Named(Checked):
    """What comes first of a prerequisite with a lag."""

    task: str = spec(Text(), "id of the prerequisite")


@record
class Prerequisite(Lag, _Named):
    """A prerequisite with its lag, as files have it."""


@dataclass(frozen=True)
class PrerequisiteOrId:
    """The id of a prerequisite, or a mapping that adds its lag."""

    filler: ClassVar[str] = "?"
    expected: ClassVar[str] = "the id of a task, or {task, after_s, within_s}"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if not isinstance(value, Mapping | Prerequisite):
            return Text().read(value, at, faults)
        before = len(faults)
        read = Record(Prerequisite, "a prerequisite").read(value, at, faults)
        return read if len(faults) == before else INVALID

    def schema(self) -> JsonSchema:
        return {"anyOf": [Text().schema(), Record(Prerequisite, "").schema()]}


@record
class TeamPart(Checked):
    """Some robots of a team, alike in what they must be."""

    count: int = spec(Whole(minimum=1), "how many robots", default=1)
    type: str | None = spec(Text(), "their type; without it any", default=None)
    kind: str | None = spec(Choice(("ground", "air")), "where they move; without it either", default=None)
    requires: tuple[str, ...] = spec(Many(Text()), "skills that each must have", default=())

    def fits(self, robot: Robot, *, skills: bool = True) -> bool:
        """Whether a robot may be one of them; without `skills` whatever its skills."""
        is_of = self.type in (None, robot.type) and self.kind in (None, robot.kind)
        return is_of and (not skills or set(self.requires) <= set(robot.skills))
