"""The study: which tables there are, how they are made, and the pictures beside them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Protocol

from muster.studies.effort import Effort
from muster.studies.rvo.pictures import draw
from muster.studies.rvo.results import LEGEND, Circle, Found, Published
from muster.studies.rvo.runs import Job
from muster.studies.tables import Report, Table


class _Reproduction(Protocol):
    @property
    def number(self) -> str: ...

    def jobs(self, effort: Effort) -> Iterator[Job]: ...

    def table(self, effort: Effort, results: Mapping[Job, Found]) -> Table: ...


_TABLES: tuple[_Reproduction, ...] = (Published("A.17"), Published("A.22"), Circle())


class CollisionAvoidance:
    """Reciprocal velocity obstacles, and what came after them."""

    name = "rvo"
    summary = "collision avoidance, TCF thesis, appendices A3 and A6.2"
    tables = tuple(table.number for table in _TABLES)

    def run(self, effort: Effort, workers: int = 1, on_done: Callable[[int, int], None] | None = None) -> Report:
        """Run all scenarios with all methods, one after the other: `workers` makes no difference.

        Raises
        ------
        ParameterError
            if there is no such table.
        """
        numbers = effort.wanted(self.tables)
        wanted = [table for table in _TABLES if table.number in numbers]
        jobs = [job for table in wanted for job in table.jobs(effort)]
        begin, results = time.process_time(), {}
        for job in jobs:
            results[job] = Found.of(job.perform())
            if on_done is not None:
                on_done(len(results), len(jobs))
        return Report(
            study=self.name,
            document="TCF thesis, appendices A3 and A6.2",
            seeds=effort.seed_count,
            runs=len(jobs),
            cpu_s=time.process_time() - begin,
            legend=LEGEND,
            tables=tuple(table.table(effort, results) for table in wanted),
        )

    def draw(self, effort: Effort, folder: Path) -> list[Path]:
        """Draw Figures A.4 to A.9 and A.15 to A.17 into a folder, all methods side by side; the files made."""
        return draw(folder, effort.wanted(self.tables))
