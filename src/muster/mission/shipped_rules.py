"""The rules that ship, as `declared_rules` knows them."""

from __future__ import annotations

from muster.mission.declared_rules import DeclaredRule


def _rule(order: float, of: str, *, planned: bool = True, ignorable: bool = True) -> DeclaredRule:
    """A rule whose planner and judge are classes of one name, in files of one name."""
    module = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in of)[1:]
    return DeclaredRule(
        order=order,
        planning=f"muster.model.rules.{module}:{of}" if planned else "",
        judge=f"muster.verification.rules.{module}:{of}",
        ignorable=ignorable,
    )


SKILL = _rule(10, "Skill")
ACTION = _rule(20, "Action", ignorable=False)
SUITABILITY = _rule(30, "Suitability")
LOCK = _rule(40, "Lock")
LOAD = _rule(50, "Load")
PREREQUISITE = _rule(60, "Prerequisite")
CLOSED_AREA = _rule(70, "ClosedArea", planned=False, ignorable=False)
UNREACHABLE = _rule(80, "Unreachable", ignorable=False)
WINDOW = _rule(90, "Window")
DEADLINE = _rule(100, "Deadline")
SHIFT = _rule(110, "Shift")
TEAM = _rule(120, "Team")
RELATION = _rule(130, "Relation")
CAPACITY = _rule(140, "Capacity")
BATTERY = _rule(150, "Battery")
MIN_TASKS = _rule(160, "MinTasks")
DUTY = _rule(170, "Duty", planned=False)
ABOARD = _rule(55, "Aboard")
EITHER_OR = _rule(45, "EitherOr")
