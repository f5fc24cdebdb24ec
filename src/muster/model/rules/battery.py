"""A battery never holds less than its reserve; stations charge and swap it on the way."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

from muster.mission.model import Robot
from muster.mission.stations import Battery as BatteryNow
from muster.model.energy import Energy
from muster.model.parts import Parts
from muster.model.rules.rule import Bools, Change, Found, Limits, Outlook, Question, Rule, Tried


@dataclass(frozen=True)
class LargerBattery(Change):
    """What the robot's battery would have to hold, and the one that it has now; inf: without an end."""

    capacity: float
    unit: str
    now: BatteryNow

    @property
    def plain(self) -> float:
        return self.capacity

    @property
    def short(self) -> str:
        return f"a battery of {self.capacity:.2f} {self.unit}"

    def robot(self, robot: Robot) -> Robot:
        larger = None if math.isinf(self.capacity) else replace(self.now, capacity=self.capacity)
        return replace(robot, battery=larger)

    def narrowed(self, found: Found) -> LargerBattery | None:
        """What is enough for the route without calls."""
        needed = found.usage / (self.now.at_start - self.now.reserve)
        return replace(self, capacity=needed) if needed > self.now.capacity else None


class Battery(Rule):
    """`battery` falls with usage, is filled at stations, and is never below `reserve * capacity`."""

    word: ClassVar[str] = "battery"
    asked: ClassVar[Mapping[str, str]] = {"energy": "battery"}
    lifted_late = True
    of_a_route = True
    of_the_team = True
    kept_by_calls = True
    key = "battery"
    resource = ("battery", "battery")

    def compile(self, problem: Question, parts: Parts) -> None:
        for i, robot in enumerate(problem.robots):
            if (energy := Energy.of(robot)) is not None:
                level = problem.levels[i] if problem.levels else energy.at_start
                parts.has_energy(i, energy.capacity - energy.least, max(0.0, level - energy.least))

    def possible(self, limits: Limits) -> Bools | None:
        if not any(robot.battery for robot in limits.problem.robots):
            return None
        return limits.problem.energy_reaches

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        battery = problem.robots[i].battery
        if battery is None or problem.energy_reaches[i, j] or math.isinf(outlook.least):
            return None
        least, unit = outlook.least, problem.usage_unit
        holds = f"its battery holds {problem.model.energy_at_start[i]:.2f} {unit} above its reserve"
        if not problem.mission.stations:
            return f"takes at least {least:.2f} {unit}, {holds}"
        return f"takes at least {least:.2f} {unit}, {holds}, and no station is near enough"

    def broken_at(self, tried: Tried) -> str:
        problem, unit = tried.problem, tried.problem.usage_unit
        holds = f"its battery holds {problem.model.energy_at_start[tried.i]:.2f} {unit} above its reserve"
        stations = ", and no calls at stations make up for that" if problem.mission.stations else ""
        return f"at least {tried.usage:.2f} {unit} with it, {holds}{stations}"

    def lifted(self, problem: Question, i: int, j: int, done: Collection[int]) -> LargerBattery | None:
        battery = problem.robots[i].battery
        if battery is None or battery.at_start <= battery.reserve:
            return None
        return LargerBattery(math.inf, problem.usage_unit, battery)
