"""The report of a comparison: a page that holds all in itself."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from importlib.metadata import version
from pathlib import Path

from muster.mission.errors import ParameterError
from muster.mission.texts.packaged_files import packaged_text
from muster_studies.comparison.cells import PAIR_COLUMNS, STANDING_COLUMNS, pair_cells, standing_cells
from muster_studies.comparison.notes import cut_short_note
from muster_studies.comparison.ranking import Best, bests, by_mission, close, typical
from muster_studies.comparison.run import Run
from muster_studies.comparison.statistics import Pair, Standing

_MOST_ROWS = 500


@dataclass(frozen=True, kw_only=True)
class Contents:
    """What the page shows.

    Parameters
    ----------
    facts
        what was compared, in a line.
    is_whole
        whether all runs are made.
    figures
        pictures as SVG, with their captions.
    command
        what made it; empty: not known.
    """

    facts: str
    is_whole: bool
    allocators: Sequence[str]
    standings: Sequence[Standing]
    pairs: Sequence[Pair]
    runs: Sequence[Run]
    figures: Sequence[tuple[str, str]]
    command: str


def require_page(path: str | Path, what: str = "report") -> None:
    """Refuse a file whose name is not that of a page; `what` it is, for the error.

    Raises
    ------
    ParameterError
    """
    if Path(path).suffix.lower() not in (".html", ".htm"):
        raise ParameterError(f"{what}: {path}; expected a file that ends in .html")


def page(contents: Contents) -> str:
    """The page, as HTML."""
    body = "\n".join(filter(None, _sections(contents)))
    head = '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}<title>Comparison of allocators</title>'
        f"<style>{packaged_text(__package__, 'page.css')}</style></head>\n<body>\n{body}\n</body></html>\n"
    )


def _sections(contents: Contents) -> Iterator[str]:
    yield "<h1>Comparison of allocators</h1>"
    yield f'<p class="facts">{escape(contents.facts)}</p>'
    if not contents.is_whole:
        yield '<p class="alarm">Not all runs are made: the comparison was interrupted.</p>'
    if cut := cut_short_note(contents.runs):
        yield f'<p class="alarm">{escape(cut)}</p>'
    yield "<h2>Allocators</h2>" + _table(STANDING_COLUMNS, map(standing_cells, contents.standings))
    if contents.pairs:
        yield "<h2>In pairs</h2>" + _table(PAIR_COLUMNS, map(pair_cells, contents.pairs))
    shown = (f"<figure>{svg}<figcaption>{escape(caption)}</figcaption></figure>" for svg, caption in contents.figures)
    yield f'<h2>Figures</h2><div class="pictures">{"".join(shown)}</div>'
    yield "<h2>Missions</h2>" + _missions(contents.runs, contents.allocators)
    yield _not_done(contents.runs)
    yield "<h2>How to read it</h2>" + packaged_text("muster_studies.comparison", "how_to_read.html")
    yield "<h2>How it was made</h2>" + (f"<pre>{escape(contents.command)}</pre>" if contents.command else "")
    yield f'<p class="facts">Muster {version("muster-robotics")}, {escape(_machine())}</p>'


def _missions(runs: Sequence[Run], allocators: Sequence[str]) -> str:
    """For each mission the best, and the run in the middle of each allocator."""
    best, grouped = bests(runs), by_mission(runs)
    rows = [
        (mission, _best(best[mission], _total(own)), *(_middle(own.get(name), best[mission]) for name in allocators))
        for mission, own in list(grouped.items())[:_MOST_ROWS]
    ]
    more = len(grouped) - len(rows)
    said = (
        "The objective of the best run, and of the run in the middle of each allocator's seeds; in brackets the weight "
        "completed, where that is less than all of it, or than that of the best."
    )
    table = _table(("mission", "best", *allocators), rows)
    return f"<p>{said}</p>{table}" + (f"<p>and {more} more</p>" if more > 0 else "")


def _total(own: dict[str, list[Run]]) -> float:
    """The weight of all tasks of a mission."""
    return max((run.weight_total or 0.0 for some in own.values() for run in some), default=0.0)


def _best(best: Best | None, total: float) -> str:
    if best is None:
        return "-"
    return f"{best.value:.2f}" if close(best.weight, total) else f"{best.value:.2f} ({best.weight:g} of {total:g})"


def _middle(runs: Sequence[Run] | None, best: Best | None) -> str:
    if not runs:
        return "n/a"
    minus, value = typical(runs)
    if minus == float("inf"):
        return "failed"
    return f"{value:.2f}" if best is not None and close(-minus, best.weight) else f"{value:.2f} ({-minus:g})"


def _not_done(runs: Iterable[Run]) -> str:
    """Runs without a plan that counts, by reason."""
    counts: dict[tuple[str, str, str], list[Run]] = {}
    for run in runs:
        if not run.is_done:
            counts.setdefault((run.allocator, run.status, run.reason), []).append(run)
    if not counts:
        return ""
    rows = [(name, status, str(len(some)), some[0].mission, reason) for (name, status, reason), some in counts.items()]
    table = _table(("allocator", "status", "runs", "first on", "reason"), rows[:_MOST_ROWS], words=True)
    return "<h2>Runs that are not done</h2>" + table


def _table(columns: Sequence[str], rows: Iterable[Sequence[str]], *, words: bool = False) -> str:
    head = "".join(f"<th>{escape(name)}</th>" for name in columns)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    kind = ' class="words"' if words else ""
    return f'<div class="wide"><table{kind}><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _machine() -> str:
    return f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors, Python {platform.python_version()}"
