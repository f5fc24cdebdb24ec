"""The study: which tables there are, how they are made, and the pictures beside them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Protocol

from muster.studies.effort import Effort
from muster.studies.rescue.failures import Failures
from muster.studies.rescue.flights import Flight, Planning, repetitions
from muster.studies.rescue.metrics import Figure7, Figure8
from muster.studies.rescue.pictures import draw
from muster.studies.rescue.scenario import Figure5, Figure6
from muster.studies.tables import Report, Table


class _Reproduction(Protocol):
    @property
    def number(self) -> str: ...

    def jobs(self, effort: Effort) -> Iterator[Flight | Planning]: ...

    def table(self, effort: Effort, results: Mapping[Any, Any]) -> Table: ...


_TABLES: tuple[_Reproduction, ...] = (Figure5(), Figure6(), Figure7(), Figure8(), Failures())

_LEGEND = (
    "The mission is market-rescue-arena: the paper's robots and survivors; places, obstacles, turning and acceleration "
    "are chosen here. Plans are the market's, with seed 0 where no more is said.",
)


class Rescue:
    """The market paper's scenario, carried out."""

    name = "rescue"
    summary = "search and rescue carried out, market paper, sections 4.2 to 6"
    tables = tuple(table.number for table in _TABLES)

    def run(self, effort: Effort, workers: int = 1, on_done: Callable[[int, int], None] | None = None) -> Report:
        """Plan, and carry out without noise, with noise, and with robots that fail; `workers` makes no difference.

        Raises
        ------
        ParameterError
            if there is no such table.
        """
        numbers = effort.wanted(self.tables)
        wanted = [table for table in _TABLES if table.number in numbers]
        jobs = list(dict.fromkeys(job for table in wanted for job in table.jobs(effort)))
        begin = time.process_time()
        results: dict[Flight | Planning, Any] = {}
        for job in jobs:
            results[job] = job.perform()
            if on_done is not None:
                on_done(len(results), len(jobs))
        return Report(
            study=self.name,
            document="market paper, sections 4.2 to 6",
            seeds=repetitions(effort),
            runs=len(jobs),
            cpu_s=time.process_time() - begin,
            legend=_LEGEND,
            tables=tuple(table.table(effort, results) for table in wanted),
        )

    def draw(self, effort: Effort, folder: Path) -> list[Path]:
        """Draw Figures 7 and 8, as far as they are wanted, into a folder; the files made."""
        return draw(folder, effort, effort.wanted(self.tables))
