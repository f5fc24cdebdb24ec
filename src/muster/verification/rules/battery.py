"""A robot's battery never holds less than its reserve."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.model import Task
from muster.motion.leg_times import LegTimes
from muster.verification.case import Case
from muster.verification.energy import Energy, slack_of
from muster.verification.measure import MeasuredRoute, Step, work_seconds
from muster.verification.rules.usage_limit import keeps_within
from muster.verification.verdict import Violation


class Battery:
    """The level falls with usage, and is never below `reserve * capacity`; charges fit into the battery."""

    kind = "battery"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        low = False  # said once from one charge to the next
        for stop in route.stops:
            if stop.energy is None:
                return
            task = stop.task.id if isinstance(stop, Step) else None
            levels = [(stop.energy.arrives, f"arrives at {stop.place_id}")]
            levels += [(stop.energy.leaves, f"has worked at {stop.place_id}")] if isinstance(stop, Step) else []
            for level, when in levels:
                if not low and _is_low(case, route, stop.energy, level):
                    low = True
                    yield Violation(self.kind, route.robot.id, task, _text(case, route, level, when))
            if not isinstance(stop, Step):
                if stop.charge.fault is not None:
                    yield Violation(self.kind, route.robot.id, None, stop.charge.fault)
                low = low and stop.charge.amount <= 0
        end = route.energy_at_end
        if route.last_leg is not None and end is not None and not low and _is_low(case, route, end, end.leaves):
            yield Violation(self.kind, route.robot.id, None, _text(case, route, end.leaves, "arrives at its end"))

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether the work alone takes more than a full battery has, or the route with it more than the battery has.

        Undecided otherwise where there is a battery: what is left for the ways depends on the stations.
        """
        battery = route.robot.battery
        if battery is None:
            return None if case.has_energy and case.needs_others(task) else False
        if _work(case, route, task) > (battery.capacity - battery.least) * (1 + case.tolerance):
            return True
        if any(station.gives_energy for station in case.mission.stations):
            return None
        within = keeps_within(case, route, task, battery.level_at_start - battery.least)
        return None if within is None else not within


def _is_low(case: Case, route: MeasuredRoute, energy: Energy, level: float) -> bool:
    battery = route.robot.battery
    assert battery is not None
    return level < battery.least - slack_of(energy, battery, case.travel.tolerance)


def _text(case: Case, route: MeasuredRoute, level: float, when: str) -> str:
    assert route.robot.battery is not None
    least = f"{route.robot.battery.least:.10g} {case.unit}"
    return f"its battery holds {level:.10g} {case.unit} when it {when}, at least {least} must stay"


def _work(case: Case, route: MeasuredRoute, task: Task) -> float:
    """The usage of the work on a task; of a team's, which takes as long as for the slowest, at least."""
    if case.unit == "s":
        return work_seconds(LegTimes.in_mission(route.robot, case.mission), case.travel, route.robot, task)
    return case.travel.work_metres(route.robot, task) or 0.0
