"""Standings and pairs as the cells of tables for people."""

from __future__ import annotations

from muster_studies.comparison.statistics import Pair, Standing

STANDING_COLUMNS = (
    "allocator",
    "runs",
    "failed",
    "n/a",
    "as much done",
    "mean gap [%] (95 %)",
    "median",
    "win tie loss",
    "time [s]",
)
PAIR_COLUMNS = ("allocator", "other", "win tie loss", "difference [%]", "p", "p (Holm)", "better")
SIGNIFICANT = 0.05


def standing_cells(one: Standing) -> tuple[str, ...]:
    """A row of the table of allocators."""
    has_interval = one.gap_low is not None and one.gap_high is not None
    interval = f" ({one.gap_low:.2f} to {one.gap_high:.2f})" if has_interval else ""
    return (
        one.allocator,
        str(one.runs),
        str(one.failed),
        str(one.not_applicable),
        "-" if one.as_much is None else f"{100 * one.as_much:.0f} %",
        _figure(one.gap_mean) + interval,
        _figure(one.gap_median),
        _record(one),
        "-" if one.time_s is None else f"{one.time_s:.3f}",
    )


def pair_cells(one: Pair) -> tuple[str, ...]:
    """A row of the table of pairs."""
    return (
        one.allocator,
        one.other,
        _record(one),
        "-" if one.difference is None else f"{one.difference:+.2f}",
        p_text(one.p_value),
        p_text(one.p_holm),
        better(one),
    )


def _record(one: Standing | Pair) -> str:
    return f"{one.wins} {one.ties} {one.losses}"


def better(one: Pair) -> str:
    """The allocator that is better by the test; a dash where it does not say."""
    if one.p_holm is None or one.p_holm >= SIGNIFICANT or one.wins == one.losses:
        return "-"
    return one.allocator if one.wins > one.losses else one.other


def p_text(value: float | None) -> str:
    """A p-value; a dash where nothing was tested."""
    if value is None:
        return "-"
    return f"{value:.1e}" if value < 0.001 else f"{value:.3f}"


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"
