"""What docs/coverage.md names is there: paths, commands and their options, tables of studies. Its commands are run, and
their figures compared, by `tools.docs_check`."""

import re
import shlex
from collections import Counter
from pathlib import Path

import click
import pytest
from tools.docs_check.pages import read_page
from tools.docs_check.rows import read_rows

from muster.cli import main
from muster_studies.registry import STUDIES

PAGE = Path(__file__).parents[2] / "docs" / "coverage.md"
TEXT = PAGE.read_text(encoding="utf-8")
ROWS = [row for item in read_page(PAGE) if item.kind == "rows" for row in read_rows(item.text, item.line)]
COMMANDS = sorted({part for found in re.findall(r"`(muster [^`]+)`", TEXT) for part in found.split(" && ")})


def test_all_tables_of_documents_are_checked():
    assert [row.text for row in ROWS] == [row.text for row in read_rows(TEXT) if len(row.cells) == 5]
    assert len(ROWS) > 200


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.cells[0]} {row.cells[1][:40]}")
def test_a_row_is_whole(row):
    assert not list(row.problems())


@pytest.mark.parametrize("command", COMMANDS)
def test_the_commands_are_those_of_the_command(command):
    _, verb, *words = shlex.split(command)
    group = main.muster
    found = group.get_command(click.Context(group), verb)
    assert found is not None
    options = [word for word in words if word.startswith("--")]
    known = {name for parameter in found.params for name in (*parameter.opts, *parameter.secondary_opts)}
    assert set(options) <= known
    if verb == "study":
        tables = words[words.index("--tables") + 1].split(",") if "--tables" in words else []
        assert set(tables) <= set(STUDIES[words[0]].tables)


def test_the_counts_are_those_of_the_rows():
    states = Counter(row.state for row in ROWS)
    (line,) = re.findall(r"Of (\d+) rows (\d+) are done, (\d+) differ, (\d+) are not there", TEXT)
    assert [int(number) for number in line] == [len(ROWS), states["done"], states["differs"], states["not"]]
