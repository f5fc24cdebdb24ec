"""docs/commands.md has the table of exit codes that the command goes by."""

from pathlib import Path

from muster.cli.exit_codes import table_of_endings

DOCUMENT = Path(__file__).parents[2] / "docs" / "commands.md"


def test_the_document_has_the_table_of_the_command():
    assert table_of_endings() in DOCUMENT.read_text(encoding="utf-8")
