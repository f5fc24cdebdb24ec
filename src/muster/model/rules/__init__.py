"""The rules of a mission, one a file, in the order in which reasons are sought.

A rule says what it refuses, what it proves impossible, why a task is left out of a plan, what change would lift it, and
says that change in words. A rule is added to `RULES`; problems, proofs of impossibility, reasons, remedies and their
phrases are loops over these. What a search has to know of a rule in its hot loop is in the core.
"""

from __future__ import annotations

from muster.model.rules.aboard import Aboard
from muster.model.rules.action import Action
from muster.model.rules.battery import Battery
from muster.model.rules.capacity import Capacity
from muster.model.rules.deadline import Deadline
from muster.model.rules.either_or import EitherOr
from muster.model.rules.load import Load
from muster.model.rules.lock import Lock
from muster.model.rules.min_tasks import MinTasks
from muster.model.rules.prerequisite import Prerequisite
from muster.model.rules.relation import Relation
from muster.model.rules.rule import Change, InPlan, Outlook, Question, Rule
from muster.model.rules.shift import Shift
from muster.model.rules.skill import Skill
from muster.model.rules.suitability import Suitability
from muster.model.rules.team import Team
from muster.model.rules.unreachable import Unreachable
from muster.model.rules.window import Window

__all__ = ["RULES", "Change", "InPlan", "Outlook", "Question", "Rule"]

RULES: tuple[Rule, ...] = (
    Skill(),
    Action(),
    Suitability(),
    Lock(),
    EitherOr(),
    Load(),
    Aboard(),
    Prerequisite(),
    Unreachable(),
    Window(),
    Deadline(),
    Shift(),
    Team(),
    Relation(),
    Capacity(),
    Battery(),
    MinTasks(),
)
