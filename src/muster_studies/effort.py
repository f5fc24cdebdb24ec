"""The effort of a study: which tables, how many seeds and iterations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.values.ranges import require_counts
from muster_studies.tables import span

SEEDS, QUICK_SEEDS = 10, 2


@dataclass(frozen=True, kw_only=True)
class Effort:
    """The effort of a study.

    Parameters
    ----------
    seeds
        random algorithms run with seeds 0 to seeds - 1; by default 10, and 2 if `quick`.
    iterations
        of random algorithms, instead of the study's own counts.
    quick
        few and short runs, to see that everything works.
    tables
        the numbers of the tables to make; all by default.
    figures
        the numbers of the figures to draw, or `all`; by default those of the tables.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    seeds: int | None = None
    iterations: int | None = None
    quick: bool = False
    tables: tuple[str, ...] = ()
    figures: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        require_counts(1, seeds=self.seeds)
        require_counts(0, iterations=self.iterations)

    @property
    def seed_count(self) -> int:
        return self.seeds or (QUICK_SEEDS if self.quick else SEEDS)

    def wanted(self, tables: Sequence[str]) -> tuple[str, ...]:
        """Those of a study's tables that are to be made.

        Raises
        ------
        ParameterError
            if there is no table of that number.
        """
        for number in self.tables:
            if number not in tables:
                hint = did_you_mean(number, tables)
                raise ParameterError(f"table: {number}; expected {span(tables)}{hint}")
        return self.tables or tuple(tables)
