"""A change with which a robot could do a task, as data: what each kind needs, and what is known of it."""

from __future__ import annotations

from dataclasses import dataclass, field

from muster.allocation.feasibility import ROUNDING
from muster.mission.plan import Route


@dataclass(frozen=True)
class Score:
    """A suitability score that is too low."""

    robot_type: str
    task_type: str
    score: float
    needed: float


@dataclass(frozen=True)
class Before:
    """A prerequisite that the plan leaves out, and whether it is possible by itself."""

    task: str
    possible: bool


@dataclass(frozen=True, kw_only=True)
class Capacity:
    """Work capacities of the robot, the reserve included, the other changes made.

    `now` is the mission's, None where it is unlimited. With `as_is` the task fits into the robot's route and nothing
    else of the plan changes: exactly that much is needed for it. With less than `at_least` no admissible plan does what
    the plan does and the task by this robot: that is proven. With `enough` such a plan was found, and judged.
    `grows` tells whether more is needed than there is now, as far as is known. Values are None where nothing is.
    """

    now: float | None
    as_is: float | None = None
    at_least: float | None = None
    enough: float | None = None

    @property
    def grows(self) -> bool:
        needed = max(self.enough or 0.0, self.at_least or 0.0)
        return self.now is not None and needed > self.now * (1 + ROUNDING)


@dataclass(frozen=True, kw_only=True)
class Remedy:
    """What a robot would need to do a task beside all that a plan does.

    Skills, score and lock are exactly what stands between the two: each is needed. `before` are the prerequisites that
    the plan leaves out. `enough` tells whether a plan with all this was found and judged; its routes are in `routes`.
    `unable` tells why the robot cannot do the task's action, whatever changes; empty if it can. `unreachable` tells
    that there is no way to the task, `impossible` that no capacity is enough beside the other changes: both are
    proven. Of many robots only those that seem to need least are `searched` for plans in which other
    tasks are moved.
    """

    robot: str
    skills: tuple[str, ...] = ()
    suitability: Score | None = None
    lock: tuple[str, ...] | None = None
    before: tuple[Before, ...] = ()
    unable: str = ""
    unreachable: bool = False
    impossible: bool = False
    searched: bool = True
    capacity: Capacity
    enough: bool = False
    routes: tuple[Route, ...] = field(default=(), repr=False)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of change, by the names of reasons."""
        given = {
            "skill": self.skills,
            "suitability": self.suitability,
            "lock": self.lock,
            "prerequisite": self.before,
            "capacity": self.capacity.grows,
        }
        return tuple(name for name, value in given.items() if value)

    @property
    def size(self) -> tuple[int, float]:
        """What changes are compared by: the number of kinds, then by how much the capacity grows."""
        grown = (self.capacity.enough or 0.0) - (self.capacity.now or 0.0) if self.capacity.grows else 0.0
        return len(self.kinds), grown
