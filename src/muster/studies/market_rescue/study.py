"""The study: which tables there are, and how they are made."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Protocol

from muster.studies.effort import Effort
from muster.studies.market_rescue.comparison import Comparison
from muster.studies.market_rescue.scenario import Allocation, TimeChart
from muster.studies.processes import run_cases
from muster.studies.runs import Case, Sample
from muster.studies.tables import Report, Table


class Reproduction(Protocol):
    """One table repeated: the cases that it needs, and the table made of their runs."""

    @property
    def number(self) -> str: ...

    def cases(self, effort: Effort) -> Iterator[Case]: ...

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table: ...


_TABLES: tuple[Reproduction, ...] = (Allocation(), TimeChart(), Comparison())

_LEGEND = (
    "A is travelled distance by velocity, B the sum of execution times by aging factor; a robot takes A + B, and the "
    "greatest A + B is what is minimised.",
    "All own numbers are recomputed by muster.verify. best, mean and worst are over all seeds; s is the processor time "
    "of a run (the mean over all seeds). ✓: equal.",
)


class MarketRescue:
    """Market with relinquishing and annealing, in search and rescue."""

    name = "market-rescue"
    summary = "market with relinquishing, market paper, sections 4 and 5"
    tables = tuple(table.number for table in _TABLES)

    def run(self, effort: Effort, workers: int = 1, on_done: Callable[[int, int], None] | None = None) -> Report:
        """Repeat the paper's allocation, and compare on a richer mission.

        Raises
        ------
        ParameterError
            if there is no such table.
        """
        numbers = effort.wanted(self.tables)
        wanted = [table for table in _TABLES if table.number in numbers]
        cases = [case for table in wanted for case in table.cases(effort)]
        samples = run_cases(cases, effort.seed_count, workers, on_done)
        outcomes = [outcome for sample in samples.values() for outcome in sample.outcomes]
        return Report(
            study=self.name,
            document="market paper, sections 4 and 5",
            seeds=effort.seed_count,
            runs=len(outcomes),
            cpu_s=sum(outcome.cpu_s for outcome in outcomes),
            legend=_LEGEND,
            tables=tuple(table.table(effort, samples) for table in wanted),
        )
