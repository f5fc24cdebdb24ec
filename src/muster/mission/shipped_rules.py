"""The rules that ship, as `declared_rules` knows them."""

from __future__ import annotations

from muster.mission.declared_rules import DeclaredRule


def _rule(order: float, of: str, keys: str = "", *, planned: bool = True, ignorable: bool = True) -> DeclaredRule:
    """A rule whose planner and judge are classes of one name, in files of one name."""
    module = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in of)[1:]
    return DeclaredRule(
        order=order,
        planning=f"muster.model.rules.{module}:{of}" if planned else "",
        judge=f"muster.verification.rules.{module}:{of}",
        ignorable=ignorable,
        shipped_keys=tuple(keys.split()),
    )


SKILL = _rule(10, "Skill", "requires skills")
ACTION = _rule(20, "Action", ignorable=False)
SUITABILITY = _rule(30, "Suitability", "min_suitability suitability")
LOCK = _rule(40, "Lock", "only_robots")
LOAD = _rule(50, "Load", "load load_at_start delivers load_capacity")
PREREQUISITE = _rule(60, "Prerequisite", "prerequisites lags")
CLOSED_AREA = _rule(70, "ClosedArea", planned=False, ignorable=False)
UNREACHABLE = _rule(80, "Unreachable", ignorable=False)
WINDOW = _rule(90, "Window", "window_s")
DEADLINE = _rule(100, "Deadline", "deadline_s")
SHIFT = _rule(110, "Shift", "shifts_s available_until_s")
TEAM = _rule(120, "Team", "robots_needed team needs abilities")
RELATION = _rule(130, "Relation", "same_robot_as other_robot_than starts_with")
CAPACITY = _rule(140, "Capacity", "work_capacity capacity_reserve")
BATTERY = _rule(150, "Battery", "battery")
MIN_TASKS = _rule(160, "MinTasks", "min_tasks")
DUTY = _rule(115, "Duty", "longest_duty_s")
ABOARD = _rule(55, "Aboard", "longest_aboard_s")
EITHER_OR = _rule(45, "EitherOr", "either_or")
