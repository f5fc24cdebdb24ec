"""The published tables of the section, as the library holds them, with what holds for a whole table in every row."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from muster.library import published

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


def as_run_notes(missions: Iterable[str]) -> tuple[str, ...]:
    """A note on the missions that are not run as printed."""
    names = sorted({mission for mission in missions if mission.endswith("-as-run")})
    return (f"Run as {', '.join(names)}: {_AS_RUN}",) if names else ()
