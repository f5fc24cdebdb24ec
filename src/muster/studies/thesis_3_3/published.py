"""The published tables of the section, as the library holds them, with what holds for a whole table in every row."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from muster.library import as_corrected, as_printed, published

_SECTIONS = (
    "tcf-salesmen",
    "tcf-unconstrained",
    "tcf-prerequisites",
    "tcf-suitability",
    "tcf-work-capacity",
    "tcf-objectives",
)
_AS_RUN = (
    "as the published runs were, with the types E and F of tasks 9 to 15 swapped against Table A.3. "
    "The missions as printed are not run here."
)

TOLERANCE = 0.011
"""Of a published figure: the document rounds or cuts off after two decimals."""


@dataclass(frozen=True)
class Publication:
    """One published table. `rows` hold what the table or its section states for all of them, too.

    `title` says which rules do not hold, where that is the same for all rows; `content` is the table as it is stored.
    """

    number: str
    title: str
    ignored: tuple[str, ...]
    iterations: int | None
    content: Mapping[str, Any]
    rows: tuple[Mapping[str, Any], ...]


@cache
def publication(number: str) -> Publication:
    """The published table of that number."""
    section = next(data for data in map(published, _SECTIONS) if number in data["tables"])
    content = section["tables"][number]
    rows = tuple(_complete(row, content, section) for row in content.get("rows", ()))
    return Publication(
        number,
        f"{content['title']}{_rules(section, rows)}",
        tuple(section.get("ignored", ())),
        section.get("iterations"),
        content,
        rows,
    )


def _rules(section: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> str:
    """What to add to a title."""
    if "ignored" not in section or len({tuple(row["ignored"]) for row in rows}) > 1:
        return ""
    ignored = section["ignored"]
    return f"; without {', '.join(ignored)}" if ignored else "; all rules"


def _complete(row: Mapping[str, Any], content: Mapping[str, Any], section: Mapping[str, Any]) -> dict[str, Any]:
    shared = {key: content[key] for key in ("mission", "run_as", "allocator") if key in content}
    full = {"ignored": section.get("ignored", ()), "objective": "total+max", **shared, **row}
    if is_random(full["allocator"]):
        full.setdefault("iterations", full.get("mean_iterations", section.get("iterations")))
        full.setdefault("elapsed_s", content.get("time_limit_s"))
    return full


def is_random(allocator: str) -> bool:
    """Whether an allocator is iterated; the greedy one is not, and of the benchmark only results are known."""
    return allocator not in ("greedy", "benchmark")


def errata(record: Mapping[str, Any]) -> Iterator[str]:
    """What is misprinted in a row: what is printed, what is right, and why."""
    for key, value in record.items():
        if isinstance(value, dict) and "erratum" in value:
            there, right = _shown(value["printed"]), _shown(value["corrected"])
            yield f"{key.replace('_', ' ')} printed {there}, right {right}: {value['erratum']}"


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.2f}"
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def printed(record: Mapping[str, Any]) -> dict[str, Any]:
    """A row as the document prints it."""
    return dict(as_printed(dict(record)))


def corrected(record: Mapping[str, Any]) -> dict[str, Any]:
    """A row as it should have been printed."""
    return dict(as_corrected(dict(record)))


def as_run_notes(missions: Iterable[str]) -> tuple[str, ...]:
    """A note on the missions that are not run as printed."""
    names = sorted({mission for mission in missions if mission.endswith("-as-run")})
    return (f"Run as {', '.join(names)}: {_AS_RUN}",) if names else ()
