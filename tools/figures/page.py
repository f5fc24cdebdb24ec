"""The page docs/figures.md: for each study a contact sheet, and a row for each of its figures."""

from __future__ import annotations

from collections.abc import Iterator

from muster_studies.registry import STUDIES, Study
from tools.figures.printed_figures import NOT_DRAWN

_HEAD = """# Figures

Every figure of the three documents that has data is drawn by a study: `muster study NAME --figures NUMBER --plot DIR`
draws one (`figure-NUMBER.png`), `--figures all` all of a study; `make figures` draws all of all studies, with `--quick`
(few seeds), and makes this page. The documents are those of [references.md](references.md); the pictures are of
Muster's own runs. A test compares the numbers with those that the documents print
(`tests/muster_studies/test_figures.py`).
"""


def command_of(study: str) -> str:
    """The command that makes the contact sheet of a study."""
    return f"PYTHONPATH=$ROOT python -m tools.figures {study}"


def sheet_of(study: str) -> str:
    """The contact sheet of a study, seen from the page."""
    return f"images/figures-{study}.png"


def illustrated() -> tuple[Study, ...]:
    """The studies that have figures."""
    return tuple(study for study in STUDIES.values() if study.figures)


def page() -> str:
    """The whole page."""
    return "\n".join([_HEAD, *(line for study in illustrated() for line in _section(study)), *_not_drawn()]) + "\n"


def _section(study: Study) -> Iterator[str]:
    yield f"## {study.name}"
    yield ""
    summary = study.summary[0].upper() + study.summary[1:]
    yield f"{summary}. All of them: `muster study {study.name} --figures all --plot figures`."
    yield ""
    yield "<!-- docs-check: long -->"
    yield f"<!-- docs-check: made by {command_of(study.name)} -->"
    yield f"![contact sheet of study {study.name}]({sheet_of(study.name)})"
    yield ""
    yield "| figure | the print shows | what differs | command |"
    yield "|---|---|---|---|"
    for figure in study.figures:
        key = f"{figure.number} [{figure.source}]" if figure.source else f"{figure.number} (no print)"
        command = f"`muster study {study.name} --figures {figure.number} --plot figures`"
        yield f"| {key} | {figure.shows} | {figure.differs} | {command} |"
    yield ""


def _not_drawn() -> Iterator[str]:
    yield "## Not drawn"
    yield ""
    yield "| figures | they show | not, because it is |"
    yield "|---|---|---|"
    for entry in NOT_DRAWN:
        yield f"| {_span(entry.numbers)} [{entry.source}] | {entry.shows} | {entry.reason} |"


def _span(numbers: tuple[str, ...]) -> str:
    """`4.1 to 4.10`, or all of them where some between are drawn."""
    chapters = {number.rpartition(".")[0] for number in numbers}
    counts = [int(number.rpartition(".")[2]) for number in numbers]
    in_a_row = len(chapters) == 1 and counts == list(range(counts[0], counts[0] + len(counts)))
    return f"{numbers[0]} to {numbers[-1]}" if in_a_row and len(numbers) > 2 else ", ".join(numbers)
