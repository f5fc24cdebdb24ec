"""What docs/coverage.md names is there: paths, commands and their options, tables of studies."""

import re
import shlex
from collections import Counter
from pathlib import Path

import click
import pytest

from muster.cli import main
from muster_studies.registry import STUDIES

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "coverage.md").read_text(encoding="utf-8")
COLUMNS = 5


def _rows():
    for line in TEXT.splitlines():
        if line.startswith("| ") and not line.startswith("| section"):
            yield [cell.strip() for cell in line.strip().strip("|").split("|")]


ROWS = list(_rows())
COMMANDS = sorted(set(re.findall(r"`muster ([^`]+)`", TEXT)))


def test_every_row_has_its_cells_and_a_state():
    for row in ROWS:
        assert len(row) == COLUMNS, row
        assert re.fullmatch(r"done(: .+)?|(differs|not): .+", row[4]), row


def test_what_is_there_says_where_and_what_shows_it():
    built = [row for row in ROWS if row[4].startswith(("done", "differs"))]
    missing = [row for row in built if not (row[2] and (row[3] or "docs/" in row[2]))]
    assert not missing


def test_the_paths_are_there():
    paths = {path for row in ROWS for cell in row[2:4] for path in re.findall(r"`([\w./-]+/[\w./-]*)`", cell)}
    absent = {path for path in paths if not any((ROOT / base / path).exists() for base in ("", "src", "src/muster"))}
    assert paths
    assert not absent


@pytest.mark.parametrize("command", COMMANDS)
def test_the_commands_are_those_of_the_command(command):
    verb, *words = shlex.split(command)
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
    states = Counter(row[4].partition(":")[0] for row in ROWS)
    (line,) = re.findall(r"Of (\d+) rows (\d+) are done, (\d+) differ, (\d+) are not there", TEXT)
    assert [int(number) for number in line] == [len(ROWS), states["done"], states["differs"], states["not"]]
