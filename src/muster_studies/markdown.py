"""Reports as Markdown, for the docs."""

from __future__ import annotations

from collections.abc import Iterator

from muster_studies.tables import Cell, Report, Table


def as_markdown(report: Report, command: str) -> str:
    """A report, with the command that made it."""
    return "\n".join(_lines(report, command)) + "\n"


def _lines(report: Report, command: str) -> Iterator[str]:
    yield f"# {report.study}: {report.document}"
    yield ""
    yield f"Made by `{command}`; {report.runs} runs, {report.cpu_s:.0f} s of processor time."
    yield ""
    for line in report.legend:
        yield line
        yield ""
    for table in report.tables:
        yield from _table(table)


def _table(table: Table) -> Iterator[str]:
    yield f"## {table.number}"
    yield ""
    yield f"{table.title}."
    yield ""
    if table.mark_rule:
        yield table.mark_rule
        yield ""
    yield _row(table.columns)
    yield _row(["---"] + ["--:"] * (len(table.columns) - 1))
    for row in table.rows:
        yield _row([_text(cell, table.decimals) for cell in row])
    yield ""
    for note in table.notes:
        yield note
        yield ""


def _row(cells: tuple[str, ...] | list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _text(cell: Cell, decimals: int) -> str:
    if isinstance(cell, float):
        return f"{cell:.{decimals}f}"
    if isinstance(cell, tuple):
        return ", ".join(_text(part, decimals) for part in cell)
    return "" if cell is None else " ".join(str(cell).split()).replace("|", "\\|")
