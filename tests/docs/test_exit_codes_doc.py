"""docs/commands.md has the table of exit codes that the command goes by."""

from pathlib import Path

from muster.cli.exit_codes import Ending

DOCUMENT = Path(__file__).parents[2] / "docs" / "commands.md"


def table_of_endings():
    """The endings as a table of Markdown."""
    rows = [
        ("ended how", "exit code", "verbs", "words", "mission control"),
        ("---",) * 5,
        *((e.ended, str(e.code), e.verbs, f"`{e.words}`" if e.words else "", e.status) for e in Ending),
    ]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows) + "\n"


def test_the_document_has_the_table_of_the_command():
    assert table_of_endings() in DOCUMENT.read_text(encoding="utf-8")
