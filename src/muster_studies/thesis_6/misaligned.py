"""Table `markers`: usage of a team in which the motion capture markers of one robot are misaligned (Figure 6.15)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from statistics import fmean

from muster.motion.laws import PROFILE, THESIS
from muster_studies.comparison_marks import EQUAL
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table
from muster_studies.thesis_6.flights import Flight, FlightResult, Marker
from muster_studies.thesis_6.physics import lacking_physics
from muster_studies.thesis_6.published import PublishedPlan, excess, plans

TURNS = {
    PROFILE: (0.0, 10.0, 20.0, 30.0, 33.0, 35.0, 37.0, 40.0),
    THESIS: (0.0, 5.0, 10.0, 13.0, 14.0, 15.0, 16.0, 17.0, 20.0),
}
"""Degrees to the left, by law of motion."""
LEFT_M = 0.03
"""Metres to the left: ours, as the thesis prints neither the offset nor the angle."""
WITHIN = 5.0
"""Percentage points of the published excess."""
MOST_SEEDS = 3


@dataclass(frozen=True)
class Setting:
    """A law of motion, and the offset of the markers."""

    law: str
    left_m: float
    turn_deg: float


SETTINGS = (
    *(Setting(law, LEFT_M, turn) for law, turns in TURNS.items() for turn in turns),
    *(Setting(law, left, turn) for law, turn in ((PROFILE, 35.0), (THESIS, 15.0)) for left in (0.0, 0.02, 0.04)),
)


@dataclass(frozen=True)
class MisalignedMarkers:
    """The two plans that were driven in truth, with one robot that errs about its pose by a constant offset."""

    number: str = "markers"

    @property
    def plans(self) -> tuple[PublishedPlan, ...]:
        return (*plans("6.8"), *plans("6.9"))

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for world, plan in self._cases():
            for law in TURNS:
                yield _undisturbed(plan, world, law)
            for setting in SETTINGS:
                yield from _misaligned(plan, world, setting, effort)

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        rows = []
        for world, plan in self._cases():
            for setting in SETTINGS:
                base = sum(found[_undisturbed(plan, world, setting.law)].usages)
                runs = [found[flight] for flight in _misaligned(plan, world, setting, effort)]
                cells = _cells(plan, setting, base, runs)
                rows.append({"world": world, "mission": plan.with_actions, **cells})
        lacking = lacking_physics()
        notes = (
            "with, without: usage of both robots by odometry, metres, with misaligned markers (mean over seeds) and "
            "without. The robot is the one whose usage grew most from Gazebo to the real run. thesis %: all real usage "
            "more than in Gazebo.",
            "All robots steer by motion capture, off by 0.5 mm and 2 mrad (standard deviations). The rigid body of one "
            "is offset from its frame by left m, and turned by turn deg: it drives ahead where it believes to drive "
            "aside, and corrects that all the time, so that its way is bent.",
            "The thesis prints neither the offset nor the angle; one of each is for both missions. By the law profile "
            "a robot turns on the spot where it is off its way; by the law thesis, (4.21) to (4.25), which the real "
            "robots had, it drives on, and a smaller angle costs as much.",
            *(() if lacking is None else (lacking,)),
        )
        title = "Usage of a team in which the markers of one robot are misaligned"
        rule = f"{EQUAL}: % is within {WITHIN:g} percentage points of the thesis'."
        return Table.of_cells(self.number, title, rows, notes, mark_rule=rule)

    def _cases(self) -> Iterator[tuple[str, PublishedPlan]]:
        for world in ("kinematic",) if lacking_physics() else ("kinematic", "physics"):
            for plan in self.plans:
                yield world, plan


def _undisturbed(plan: PublishedPlan, world: str, law: str) -> Flight:
    return plan.flight(plan.with_actions, world=world, law=law)


def _misaligned(plan: PublishedPlan, world: str, setting: Setting, effort: Effort) -> list[Flight]:
    marker = Marker(misaligned_robot(plan), setting.left_m, setting.turn_deg)
    seeds = range(min(MOST_SEEDS, effort.seed_count))
    return [plan.flight(plan.with_actions, world=world, law=setting.law, marker=marker, seed=seed) for seed in seeds]


def misaligned_robot(plan: PublishedPlan) -> str:
    """The robot whose real usage is most above that in Gazebo."""
    more = dict(zip(plan.routes, zip(plan.usages("real"), plan.usages("gazebo"), strict=True), strict=True))
    return max(more, key=lambda robot: more[robot][0] / more[robot][1])


def _cells(plan: PublishedPlan, setting: Setting, base: float, runs: list[FlightResult]) -> dict[str, Cell]:
    used = fmean(sum(flown.usages) for flown in runs)
    more, there = excess(used, base), excess(sum(plan.usages("real")), sum(plan.usages("gazebo")))
    off = more - there
    return {
        "robot": misaligned_robot(plan),
        "law": setting.law,
        "left m": setting.left_m,
        "turn deg": setting.turn_deg,
        "without": base,
        "with": used,
        "%": more,
        "thesis %": there,
        "lost": sum(flown.lost for flown in runs),
        "mark": EQUAL if abs(off) <= WITHIN else "",
    }
