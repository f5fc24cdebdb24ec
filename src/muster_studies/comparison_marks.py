"""Marks of own values beside published ones.

Only a published value and an own value of the same measure are compared. An own criterion, such as "no contact", has
words of its own, and never a check mark.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from muster_studies.runs import Sample
from muster_studies.tables import CHECK_MARK, Cell

TOLERANCE = 0.011
"""Of a published figure: the document rounds or cuts off after two decimals."""

EQUAL, OTHER_MEASURE = CHECK_MARK, "other measure"
REACHED, NOT_REACHED, INFORMATION, ERRATUM = "reached", "not reached", "for information", "erratum"


def equal_rule(what: str) -> str:
    """The rule of a table in which these own figures are compared with those published."""
    return f"{EQUAL}: {what} as published, within {TOLERANCE}."


def equal(published: float, own: float) -> bool:
    """Whether a figure equals the published one within the tolerance."""
    return abs(own - published) <= TOLERANCE


def differences(published: Mapping[str, Any], own: Mapping[str, Cell], columns: Iterable[str]) -> str:
    """A check mark if all published figures are equal, else the columns that differ, with their differences."""
    found = []
    for column in columns:
        there, here = published.get(column), own.get(column)
        if isinstance(there, int | float) and isinstance(here, int | float) and not equal(there, here):
            found.append(f"{column} {here - there:+.2f}")
    return ", ".join(found) or EQUAL


def reached(sample: Sample, value: float, tasks: int | None) -> str:
    """In how many runs a random algorithm reaches the published one: more tasks, or as many at no more cost."""
    needed = sample.best.verdict.tasks_total if tasks is None else tasks
    runs = sum(
        (-outcome.verdict.tasks_completed, outcome.value) <= (-needed, value + TOLERANCE) for outcome in sample.outcomes
    )
    return f"{REACHED} {runs}/{len(sample.outcomes)}" if runs else NOT_REACHED
