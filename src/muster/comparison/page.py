"""The report of a comparison: a page that holds all in itself."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from importlib.metadata import version
from pathlib import Path

from muster.comparison.cells import PAIR_COLUMNS, STANDING_COLUMNS, pair_cells, standing_cells
from muster.comparison.notes import cut_short_note
from muster.comparison.ranking import Best, bests, by_mission, close, typical
from muster.comparison.run import Run
from muster.comparison.statistics import Pair, Standing
from muster.mission.errors import ParameterError

_MOST_ROWS = 500
_STYLE = """
:root { color-scheme: light; font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; }
body { max-width: 1100px; margin: 0 auto; padding: 1.2rem 1rem 4rem; }
h1 { font-size: 1.6rem; margin: 0 0 .2rem; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .5rem; }
p, li { max-width: 46rem; } .facts { color: #555; margin: 0 0 1rem; overflow-wrap: anywhere; }
.wide { overflow-x: auto; border: 1px solid #e2e2e2; border-radius: 6px; }
table { border-collapse: collapse; width: 100%; font-size: .88rem; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .7rem; text-align: right; white-space: nowrap; border-bottom: 1px solid #eee; }
th { background: #f6f6f6; font-weight: 600; } tr:last-child td { border-bottom: 0; }
th:first-child, td:first-child, .words th, .words td { text-align: left; }
.words td:last-child { white-space: normal; min-width: 16rem; }
.pictures { display: flex; flex-wrap: wrap; gap: 1.5rem; } figure { margin: 0; flex: 1 1 340px; min-width: 0; }
figure svg { width: 100%; height: auto; } figcaption { font-size: .88rem; color: #555; }
pre { background: #f6f6f6; padding: .7rem; border-radius: 6px; white-space: pre-wrap; overflow-wrap: anywhere; }
.alarm { color: #b00020; }
"""
_METHODS = (
    "Plans are compared lexicographically: more weight of tasks completed first, then the lower objective. All "
    "figures are those of Muster's judge, which shares no code with allocators. Values that differ by less than "
    "1e-9 of themselves are equal. A run that failed is behind every plan.",
    "The gap of a run is by how many per cent its objective is above that of the best run on its mission. It is "
    "counted where the run completes as much weight as the best; “as much done” is the share of such runs. It is "
    "infinite (inf) where the best objective is 0 and its own is not; figures leave such runs out. The mean gap is "
    "the mean over missions of their means, with a 95 % interval by the bootstrap over missions (percentiles, 9,999 "
    "samples); of a single mission over its runs, where they differ.",
    "Wins, ties and losses count missions, each by the run in the middle of an allocator's seeds: against the "
    "best of all others, and of the two in a pair. Of an even number of seeds that is the mean of the two in the "
    "middle, which is failed if one of them is. In pairs of a single mission they count seeds. Missions that an "
    "allocator cannot take (n/a) are not counted for it.",
    "Pairs are tested by Wilcoxon's signed ranks, two-sided, over missions; of a single mission over seeds, which are "
    "one observation where they change neither allocator. With less than two observations there is nothing to test "
    "(-). Differences are ordered lexicographically too: a plan beside none, then shares of weight, then ratios of "
    "objectives. The test is exact up to 50 differences, up to 12 where some are equal, else by the normal "
    "approximation. p (Holm) is corrected for all pairs that are tested; an allocator is called better below 0.05.",
    "The performance profile shows for each ratio the share of an allocator's runs whose objective is at most so "
    "many times the best on the mission. Runs that failed, complete less or are n/a never get there: the curve "
    "ends below 1.",
)


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
        f"<style>{_STYLE}</style></head>\n<body>\n{body}\n</body></html>\n"
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
    yield "<h2>How to read it</h2>" + "".join(f"<p>{text}</p>" for text in _METHODS)
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
