"""Tables 6.4 and 6.5: how far off tags are found, beside the thesis' estimates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from statistics import fmean
from typing import Any

from muster.running.worlds import WORLDS
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table, row
from muster_studies.thesis_6_1.flights import Flight, FlightResult
from muster_studies.thesis_6_1.published import calm, noisy, points, seed_count, tags, truth

ALL = "all"


@dataclass(frozen=True, eq=False)
class TagErrors:
    """A row for each tag, the thesis' greatest error first, and one for their mean.

    Attributes
    ----------
    below_m
        what the mean error must be below, without noise and with it.
    thesis
        columns of the thesis' errors, by key of the published table.
    """

    number: str
    title: str
    below_m: tuple[float, float]
    thesis: Mapping[str, str]

    @property
    def columns(self) -> tuple[str, ...]:
        return (
            "tag",
            "truth",
            *self.thesis.values(),
            "seen",
            *(f"{world}{k}" for world in WORLDS.shipped for k in _KINDS),
        )

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for world in reversed(WORLDS.shipped):  # what needs the extra whole comes first
            yield calm(self.number, world)
            yield from noisy(self.number, effort, world)

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        there, flown = tags(self.number), found[calm(self.number, "physics")]
        ours = self._ours(effort, found)
        rows = [row(self.columns, self._cells(tag, there[tag], flown, ours)) for tag in there]
        means: dict[str, Cell] = {column: fmean(errors.values()) for column, errors in ours.items() if errors}
        theirs: dict[str, Cell] = {name: points()[self.number][f"mean_{key}"] for key, name in self.thesis.items()}
        rows.append(row(self.columns, {"tag": ALL, **theirs, "seen": len(flown.raw), **means}))
        notes = (
            f"Errors of filtered estimates, metres. noise, mean over {seed_count(effort)} of its flights: 1 degree of "
            "roll, pitch and heading and 0.03 m of each coordinate, standard deviations, anew in each picture.",
            "seen: in how many pictures of the physics world without noise. all: mean error, and all sightings.",
            *self._verdicts(effort, found),
        )
        return Table(self.number, self.title, self.columns, tuple(rows), notes, decimals=3)

    def _ours(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> dict[str, dict[str, float]]:
        """By column and tag, the mean error over flights; a tag that was not found in all of them is not there."""
        columns = {}
        for world in WORLDS.shipped:
            kinds = ([calm(self.number, world)], noisy(self.number, effort, world))
            for kind, flights in zip(_KINDS, kinds, strict=True):
                runs = [found[flight].errors(truth(self.number)) for flight in flights]
                by_tag = [{match.name: match.error_m for match in run.matches} for run in runs]
                everywhere = set.intersection(*(set(errors) for errors in by_tag))
                columns[f"{world}{kind}"] = {tag: fmean(run[tag] for run in by_tag) for tag in sorted(everywhere)}
        return columns

    def _cells(
        self, tag: str, published: Mapping[str, Any], flown: FlightResult, ours: Mapping[str, Mapping[str, float]]
    ) -> dict[str, Cell]:
        x, y = published["truth"]
        return {
            "tag": tag,
            "truth": f"({x:.2f}, {y:.2f})",
            **{name: published[key] for key, name in self.thesis.items()},
            "seen": int((flown.raw.tags == int(tag)).sum()),
            **{column: errors.get(tag) for column, errors in ours.items()},
        }

    def _verdicts(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Iterator[str]:
        """The criteria for the physics world, and whether they hold."""
        kinds = ([calm(self.number, "physics")], noisy(self.number, effort, "physics"))
        for name, flights, below in zip(("without noise", "with noise"), kinds, self.below_m, strict=True):
            tables = [found[flight].errors(truth(self.number)) for flight in flights]
            least = min(len(table.matches) for table in tables)
            mean, worst = max(table.mean_error_m for table in tables), max(table.greatest_error_m for table in tables)
            holds = least == len(tags(self.number)) and mean < below and not any(table.extra for table in tables)
            word = "holds" if holds else "does not hold"
            yield (
                f"{word}: physics, {name}: {least} of {len(tags(self.number))} tags found, "
                f"mean error {mean:.4f} m, to be below {below:g} m; greatest {worst:.3f} m"
                f"{' (the worst flight)' if len(tables) > 1 else ''}."
            )


_KINDS = ("", ", noise")
