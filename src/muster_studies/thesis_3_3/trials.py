"""Tables A.15 and A.16, each of the ten runs, and the readings of Algorithm 4 held against Table A.15."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev

from muster_studies.effort import Effort
from muster_studies.runs import Case, Sample
from muster_studies.tables import Cell, Table, row
from muster_studies.thesis_3_3.published import publication

ALLOCATORS = ("genetic", "greedy+genetic", "hill-climbing", "greedy+hill-climbing")
AS_RUN = "-as-run"
_READINGS = ("receiver", "receiver-inner", "all", "all-inner", "others", "others-inner")
_QUICK_SHARE = 50


def trial_case(allocator: str, effort: Effort, bounds: str | None = None) -> Case:
    """A run of Table A.15 with the mean of the published numbers of iterations (Table A.16)."""
    counts = publication("A.16").content["iterations"][allocator.removesuffix(AS_RUN)]
    published = round(fmean(counts))
    count = published // _QUICK_SHARE if effort.quick else published
    if effort.iterations is not None:
        count = effort.iterations
    given = () if bounds is None else (("bounds", bounds),)
    return Case(mission=publication("A.15").content["run_as"], allocator=allocator, iterations=count, parameters=given)


def _p_values(own: Sequence[float], published: Sequence[float]) -> tuple[float, float]:
    """The p values of the two-sided tests of Mann and Whitney, and of Kolmogorov and Smirnov."""
    from scipy.stats import ks_2samp, mannwhitneyu

    return float(mannwhitneyu(own, published).pvalue), float(ks_2samp(own, published).pvalue)


def _values(sample: Sample) -> list[float]:
    return [outcome.value for outcome in sample.outcomes]


@dataclass(frozen=True)
class Trials:
    """Table A.15 or A.16: a row for each run, of each allocator the published value, the own one, and that as run."""

    number: str
    key: str

    def jobs(self, effort: Effort) -> Iterator[Case]:
        for allocator in ALLOCATORS:
            yield trial_case(allocator, effort)
            yield trial_case(allocator + AS_RUN, effort)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        content = publication(self.number).content
        columns = ("run", *(f"{allocator}, {of}" for allocator in ALLOCATORS for of in ("thesis", "own", "as run")))
        rows = []
        for run in range(effort.seed_count):
            cells: dict[str, Cell] = {"run": run + 1}
            for allocator in ALLOCATORS:
                there = content[self.key][allocator]
                cells[f"{allocator}, thesis"] = there[run] if run < len(there) else None
                cells[f"{allocator}, own"] = self._own(samples[trial_case(allocator, effort)], run)
                cells[f"{allocator}, as run"] = self._own(samples[trial_case(allocator + AS_RUN, effort)], run)
            rows.append(row(columns, cells))
        note = "Own run n has seed n - 1 and the mean of the published numbers of iterations. as run: ALLOCATOR-as-run."
        return Table(self.number, content["title"], columns, tuple(rows), (note,))

    def _own(self, sample: Sample, run: int) -> Cell:
        outcome = sample.outcomes[run]
        return outcome.value if self.key == "total+max" else outcome.iterations


@dataclass(frozen=True)
class Readings:
    """Every reading of the bounds of mutation, and whether its runs could be those of Table A.15."""

    number: str = "readings"
    columns: tuple[str, ...] = ("allocator", "bounds", "values", "mean", "deviation", "best", "worst", "p MW", "p KS")

    def jobs(self, effort: Effort) -> Iterator[Case]:
        for allocator in ALLOCATORS:
            for bounds in _READINGS:
                yield trial_case(allocator, effort, bounds)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        rows = []
        for allocator in ALLOCATORS:
            there = publication("A.15").content["total+max"][allocator]
            rows.append(self._row(allocator, None, "thesis", there, None))
            for bounds in _READINGS:
                own = _values(samples[trial_case(allocator, effort, bounds)])
                rows.append(self._row(allocator, bounds, "own", own, _p_values(own, there)))
        return Table(self.number, "Readings of Algorithm 4 against Table A.15", self.columns, tuple(rows), _NOTES)

    def _row(
        self, allocator: str, bounds: str | None, of: str, values: Sequence[float], p: tuple[float, float] | None
    ) -> tuple[Cell, ...]:
        spread = stdev(values) if len(values) > 1 else None
        figures: tuple[Cell, ...] = (fmean(values), spread, min(values), max(values))
        return (allocator, bounds, of, *figures, *(p or (None, None)))


_NOTES = (
    "bounds: of which sequences k1 and k2 of Algorithm 4 are order numbers; -inner: only places strictly between them, "
    "and never the first task of a sequence. The thesis prints neither: both are inferred. ALLOCATOR-as-run has "
    "others-inner.",
    "p: probability of samples at least as different if both came from one distribution (Mann-Whitney, "
    "Kolmogorov-Smirnov).",
)
