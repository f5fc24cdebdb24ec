"""The rules of a mission, one a file, in the order in which reasons are sought.

A rule says what it refuses, what it proves impossible, why a task is left out of a plan, what change would lift it, and
says that change in words. A rule is added to `RULES`; problems, proofs of impossibility, reasons, remedies and their
phrases are loops over these. What a search has to know of a rule in its hot loop is in the core.
"""

from __future__ import annotations

from muster.allocation.rules.action import Action
from muster.allocation.rules.battery import Battery
from muster.allocation.rules.capacity import Capacity
from muster.allocation.rules.deadline import Deadline
from muster.allocation.rules.load import Load
from muster.allocation.rules.lock import Lock
from muster.allocation.rules.min_tasks import MinTasks
from muster.allocation.rules.prerequisite import Prerequisite
from muster.allocation.rules.relation import Relation
from muster.allocation.rules.rule import Change, InPlan, Outlook, Question, Rule
from muster.allocation.rules.shift import Shift
from muster.allocation.rules.skill import Skill
from muster.allocation.rules.suitability import Suitability
from muster.allocation.rules.team import Team
from muster.allocation.rules.unreachable import Unreachable
from muster.allocation.rules.window import Window

__all__ = ["RULES", "Change", "InPlan", "Outlook", "Question", "Rule"]

RULES: tuple[Rule, ...] = (
    Skill(),
    Action(),
    Suitability(),
    Lock(),
    Load(),
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
