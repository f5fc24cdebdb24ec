"""Routes of a timed problem while an algorithm in Python puts units of work into them."""

from __future__ import annotations

from collections.abc import Sequence

from muster import core
from muster.mission.errors import ParameterError
from muster.model.problem import Problem

Routes = list[list[int]]


class WorkingRoster:
    """A `core.Roster` that only ever holds admissible routes, on top of routes that stay."""

    def __init__(self, problem: Problem, start: Routes | None = None) -> None:
        self._problem = problem
        self._start = [list(problem.beginning(i)) for i in range(len(problem.robots))] if start is None else start
        self.core = core.Roster(problem.core)
        self.clear()

    def clear(self) -> None:
        """Go back to the routes at first.

        Raises
        ------
        ParameterError
            if there is no schedule for them.
        """
        if not self.core.begin(self._start):
            raise ParameterError("start: there is no schedule for its routes; expected one that keeps all times")

    def ready(self) -> list[int]:
        """The units in no route of which all prerequisites are in routes, in order."""
        return sorted(unit for unit in self.core.absent if self.core.ready(unit))

    def best(
        self, unit: int, robots: Sequence[int] | None = None, *, append_only: bool = True, quantised: bool = False
    ) -> core.UnitInsertion | None:
        """The team, of these robots, and the places that cost least, in quanta if asked; None if there are none."""
        chosen = None if robots is None else list(robots)
        return self.core.best_insertion(unit, append_only=append_only, quantised=quantised, robots=chosen)

    def fits(self, insertion: core.UnitInsertion) -> bool:
        """Whether the routes with a unit would be admissible."""
        holds = self.core.insert(insertion) and self.core.admissible()
        self.core.rollback()
        return holds

    def put(self, insertion: core.UnitInsertion) -> bool:
        """Put a unit into routes; False, and nothing is changed, if these would not be admissible."""
        if self.core.insert(insertion) and self.core.admissible():
            self.core.commit()
            return True
        self.core.rollback()
        return False

    def finish(self) -> None:
        """Take out what the plan cannot hold as it is, as nothing more comes to it; where that fails, everything."""
        if self.core.finish() and self.core.admissible():
            self.core.commit()
        else:
            self.core.rollback()
            self.clear()

    def usage(self, insertion: core.UnitInsertion) -> float:
        """The greatest usage among the members of the team, as it is."""
        return max(self.core.usage(robot) for _, robot, _ in insertion.members)

    @property
    def routes(self) -> Routes:
        return self.core.routes

    @property
    def value(self) -> tuple[float, float]:
        """Weight left out and objective: what is less is better."""
        return self.core.absent_weight, self.core.objective
