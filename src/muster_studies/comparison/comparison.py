"""A comparison: its runs, and what statistics say of them, as tables, figures and a page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from math import isfinite, isinf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.mission.tables import frame_of_records, html_line, html_table
from muster.mission.texts.counting import counted
from muster_studies.comparison.cells import PAIR_COLUMNS, STANDING_COLUMNS, pair_cells, standing_cells
from muster_studies.comparison.notes import cut_short_note, notes_without_plan
from muster_studies.comparison.run import Run
from muster_studies.comparison.settings import Settings
from muster_studies.comparison.statistics import Pair, Profile, Standing, pairs_of, profiles_of, standings_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """What came of a comparison.

    Parameters
    ----------
    runs
        its runs, by mission and seed.
    allocators
        their names, as they were given.
    settings
        of all runs.
    against
        the allocator with which pairs are tested; None: all with all.
    expected
        how many runs there are when it is whole.
    """

    runs: tuple[Run, ...]
    allocators: tuple[str, ...]
    settings: Settings
    against: str | None = None
    expected: int = 0

    def __repr__(self) -> str:
        return f"<Comparison: {self.counts}>"

    def _repr_html_(self) -> str:
        standings = [standing_cells(one) for one in self.standings]
        pairs = [pair_cells(one) for one in self.pairs]
        return (
            html_line(f"Comparison: {self.counts}; {self.settings.text}")
            + html_table("Allocators", STANDING_COLUMNS, standings)
            + html_table("Pairs", PAIR_COLUMNS, pairs)
        )

    @property
    def counts(self) -> str:
        """How much was compared, in words."""
        missions, seeds = len(self.missions), len({run.seed for run in self.runs})
        made, whole = len(self.runs), self.expected or len(self.runs)
        runs = counted(made, "run") if made == whole else f"{made} of {counted(whole, 'run')}"
        parts = ((len(self.allocators), "allocator"), (missions, "mission"), (seeds, "seed"))
        return ", ".join([*(counted(count, word) for count, word in parts), runs])

    @property
    def is_whole(self) -> bool:
        """Whether all its runs are made."""
        return len(self.runs) >= self.expected

    @property
    def has_a_plan(self) -> bool:
        """Whether any run has a plan that counts."""
        return any(run.is_done for run in self.runs)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the tables do not tell of single runs, in lines: why some have no plan, which time cut short."""
        return tuple(filter(None, [*notes_without_plan(self.runs, self.allocators), cut_short_note(self.runs)]))

    @property
    def missions(self) -> tuple[str, ...]:
        """The names of its missions."""
        return tuple(dict.fromkeys(run.mission for run in self.runs))

    @cached_property
    def standings(self) -> tuple[Standing, ...]:
        """How each allocator stands."""
        return standings_of(self.runs, self.allocators)

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """The allocators in pairs, tested."""
        return pairs_of(self.runs, self.allocators, self.against)

    @cached_property
    def profiles(self) -> tuple[Profile, ...]:
        """The performance profiles of the allocators."""
        return profiles_of(self.runs, self.allocators)

    def to_frame(self) -> DataFrame:
        """The runs as a DataFrame, a row each; needs the extra `frames` (which `compare` has)."""
        return frame_of_records(Run, self.runs)

    def table(self) -> DataFrame:
        """The standings as a DataFrame, a row for each allocator."""
        return frame_of_records(Standing, self.standings).set_index("allocator")

    def pairs_table(self) -> DataFrame:
        """The pairs as a DataFrame, a row each."""
        return frame_of_records(Pair, self.pairs)

    def plot_profile(self, ax: Axes | None = None) -> Axes:
        """Draw the performance profiles; needs the extra `plot`."""
        from muster.report.profiles import draw_profiles

        return draw_profiles([(one.allocator, one.ratios, one.shares) for one in self.profiles], ax)

    def plot_gaps(self, ax: Axes | None = None) -> Axes:
        """Draw for each allocator how far its runs are behind the best on their missions; needs the extra `plot`.

        Infinite gaps, of runs beside a best objective of 0, are left out.
        """
        from muster.report.profiles import draw_gaps
        from muster_studies.comparison.ranking import bests, gap

        best = bests(self.runs)
        gaps = {
            name: [gap(run, best[run.mission]) for run in self.runs if run.allocator == name]
            for name in self.allocators
        }
        finite = {name: [one for one in some if one is not None and isfinite(one)] for name, some in gaps.items()}
        return draw_gaps(finite, ax)

    def as_dict(self) -> dict[str, Any]:
        """All of it as plain data, as `muster compare --format json` prints it; None where a figure is infinite."""
        settings: Mapping[str, Any] = asdict(self.settings)
        return {
            "settings": {**settings, "against": self.against},
            "whole": self.is_whole,
            "allocators": [_finite(one) for one in self.standings],
            "pairs": [_finite(one) for one in self.pairs],
            "runs": [asdict(one) for one in self.runs],
        }

    def save_report(self, path: str | Path, *, command: str = "") -> None:
        """Write a page (.html) that holds all in itself; needs the extra `plot`.

        Parameters
        ----------
        command
            what made the comparison, for the page.

        Raises
        ------
        ParameterError
            if the file does not end in .html.
        OSError
            if it cannot be written.
        """
        from muster.mission.texts.text_files import write_text
        from muster.report.files import svg_text
        from muster_studies.comparison.page import Contents, page, require_page

        require_page(path)
        drawn = (
            (
                self.plot_profile(),
                "Performance profiles: the higher, the better; where a curve begins, it is the best.",
            ),
            (self.plot_gaps(), "Gaps: the middle half as a box, the median as a stroke, 5 to 95 % as a line."),
        )
        contents = Contents(
            facts=f"{self.counts}; {self.settings.text} a run, one thread each.",
            is_whole=self.is_whole,
            allocators=self.allocators,
            standings=self.standings,
            pairs=self.pairs,
            runs=self.runs,
            figures=[(svg_text(axes), caption) for axes, caption in drawn],
            command=command,
        )
        write_text(Path(path), page(contents))


def _finite(one: Standing | Pair) -> dict[str, Any]:
    fields = asdict(one)
    return {key: None if isinstance(value, float) and isinf(value) else value for key, value in fields.items()}
