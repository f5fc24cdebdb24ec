"""The rules of the judge, one a file. A new rule is registered here.

A rule finds what is wrong with a route, and says whether it keeps a robot from one more task. The judge asks the latter
of the reasons that a plan gives for tasks left out. Which limits of times are broken, and that routes and prerequisites
wait for each other in a cycle, is found by `schedule`, which all routes enter at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.rules.action import Action
from muster.verification.rules.battery import Battery
from muster.verification.rules.capacity import Capacity
from muster.verification.rules.closed_area import ClosedArea
from muster.verification.rules.deadline import Deadline
from muster.verification.rules.load import Load
from muster.verification.rules.lock import Lock
from muster.verification.rules.min_tasks import MinTasks
from muster.verification.rules.prerequisite import Prerequisite
from muster.verification.rules.relation import Relation
from muster.verification.rules.shift import Shift
from muster.verification.rules.skill import Skill
from muster.verification.rules.suitability import Suitability
from muster.verification.rules.team import Team
from muster.verification.rules.unreachable import Unreachable
from muster.verification.rules.window import Window
from muster.verification.verdict import Violation


class Rule(Protocol):
    """One rule of a mission."""

    @property
    def kind(self) -> str:
        """The word for it: of violations, of reasons, and of what is ignored."""
        ...

    @property
    def ignorable(self) -> bool:
        """Whether a caller can have it ignored."""
        ...

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        """Everything in a route that breaks the rule."""
        ...

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether the rule keeps a task that is left out from being added to a route; None: too close to say."""
        ...


RULES: tuple[Rule, ...] = (
    Skill(),
    Action(),
    Suitability(),
    Lock(),
    Team(),
    Relation(),
    Prerequisite(),
    ClosedArea(),
    Unreachable(),
    Capacity(),
    Load(),
    Battery(),
    Window(),
    Deadline(),
    Shift(),
    MinTasks(),
)


def rules_that_hold(case: Case) -> list[Rule]:
    """All rules but those that are ignored."""
    return [rule for rule in RULES if not rule.ignorable or case.holds(rule.kind)]
