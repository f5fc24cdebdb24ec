"""Rules on the schedule of all routes at once, whose breaches `schedule` finds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator

from muster.mission.model import Mission, Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class LimitRule(ABC):
    """A rule that sets limits to times."""

    kind: str
    ignorable = True

    @abstractmethod
    def is_in(self, mission: Mission) -> bool:
        """Whether anything in the mission is subject to the rule."""

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        """Nothing: a limit is broken by all routes together."""
        return iter(())

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Undecided where there are such limits: one more task may delay others past theirs."""
        return None if case.is_subject_to(self.kind, self.is_in) else False
