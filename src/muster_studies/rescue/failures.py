"""Section 6, which the paper leaves to the future: a robot fails in mid mission, and the rest is planned again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from muster.mission.model import Mission
from muster_studies.effort import Effort
from muster_studies.rescue.flights import Flight, FlightResult, repetitions
from muster_studies.rescue.scenario import undisturbed
from muster_studies.rescue.teams import ARENA, PAIRS, POINTS, RICHER, mission_of, sent
from muster_studies.tables import Cell, Notes, Table

NONE_LOST = "none lost"
TEAMS = (ARENA, PAIRS, POINTS, RICHER)


@dataclass(frozen=True)
class Failures:
    """A row for each robot that fails, over several moments; and one for each team of which none does."""

    number: str = "Section 6"

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for team in TEAMS:
            calm = undisturbed(effort, team)
            yield calm
            for robot in sent(team, calm.iterations):
                yield from failing(effort, team, robot)

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table:
        rows, reasons = [], Notes()
        for team in TEAMS:
            calm = undisturbed(effort, team)
            flights: list[tuple[str, Sequence[Flight]]] = [("none", [calm])]
            flights += [(robot, failing(effort, team, robot)) for robot in sent(team, calm.iterations)]
            for robot, each in flights:
                found = [results[flight] for flight in each]
                rows.append({"team": team, "fails": robot, **_cells(team, robot, found, reasons)})
        notes = (*reasons.lines(), *_NOTES)
        return Table.of_cells(self.number, "A robot fails in mid mission", rows, notes)


def failing(effort: Effort, team: str, robot: str) -> list[Flight]:
    """The robot fails at moments evenly over the time for which the plan has it busy."""
    count = repetitions(effort)
    return [replace(undisturbed(effort, team), fails=robot, share=(k + 1) / (count + 1)) for k in range(count)]


def _cells(team: str, robot: str, found: Sequence[FlightResult], reasons: Notes) -> dict[str, Cell]:
    mission, reports = mission_of(team), [one.report for one in found]
    lost = [task for report in reports for task, _ in report.tasks_lost]
    without = {one.id: one.skills for one in mission.robots if one.id != robot}
    numbers = sorted({reasons.number(why) for one in found for why in _why_lost(mission, without, one)})
    return {
        "runs": len(found),
        "done": f"{sum(len(report.tasks_done) for report in reports)}/{len(found) * len(mission.tasks)}",
        "lost": len(lost),
        "re-plans": sum(report.reallocations for report in reports),
        "moved": sum(one.moved for one in found),
        "planning ms": max(1000 * one.planning_s for one in found),
        "mission s": max(report.mission_time_s for report in reports),
        "mark": " ".join(numbers) or NONE_LOST,
    }


def _why_lost(mission: Mission, without: Mapping[str, Sequence[str]], flown: FlightResult) -> Iterator[str]:
    """Of each task lost by these robots that are left, the reason, in short where no other has the skill."""
    required = {task.id: task.requires for task in mission.tasks}
    for name, reason in flown.report.tasks_lost:
        able = [robot for robot, skills in without.items() if set(required[name]) <= set(skills)]
        if not able:
            yield f"lost: no other robot has {' and '.join(required[name])}."
        else:
            yield f"lost: {reason}."


_NOTES = (
    "Each robot fails at as many moments as there are runs, evenly over the time for which the plan has it busy; no "
    "noise. done, lost, re-plans, moved: sums over the runs. moved: tasks that went to another robot. planning ms: "
    "processor time of all re-planning, of the slowest run. mission s: of the longest run.",
    "two a skill: the arena with a second robot of each kind. A robot that fails on or beside a survivor stays there, "
    "and no other gets to that place; points have no bodies, so that this alone makes the difference.",
    "market-rescue-20: robots are points; some survivors need two skills at once, which one robot alone has.",
)
