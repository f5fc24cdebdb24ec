"""Whether there are styles and colours on standard output: by NO_COLOR, FORCE_COLOR, and whether it is a terminal."""

import io
import re
import sys

import pytest

from muster.cli.main import run
from muster.cli.verbs.docs import laid_out

COLOUR = re.compile(r"\x1b\[(?:\d+;)*(?:[39][0-7]|[34]8|10[0-7])[;m]")
TABLE = ("generate", "--list")
PAGE = "# Heading\n\nText with `code`.\n\n```python\nfor k in (1, 2):\n    print('two')\n```\n"


@pytest.fixture(autouse=True)
def no_variables(monkeypatch):
    for name in ("NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE", "COLORTERM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm-256color")


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def terminal(monkeypatch):
    """Runs the command at a terminal; gives what is seen there."""

    def call(*arguments):
        screen = Terminal()
        monkeypatch.setattr(sys, "stdout", screen)
        assert run(list(arguments)) == 0
        return screen.getvalue()

    return call


def test_files_and_pipes_have_no_styles(muster):
    assert "\x1b" not in muster(*TABLE)[1]


def test_forced_styles_in_files_and_pipes(muster, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert "\x1b[1m" in muster(*TABLE)[1]
    assert muster("missions", "--format", "json")[1].startswith("[")  # programs have none all the same


@pytest.mark.long
def test_forced_styles_of_long_tables(muster, monkeypatch):
    found = ("docs", "--find", "muster")
    assert "\x1b" not in muster(*found)[1]
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert "\x1b[1m" in muster(*found)[1]


def test_a_terminal_has_styles(terminal):
    assert "\x1b[1m" in terminal(*TABLE)


@pytest.mark.parametrize("forced", [False, True])
def test_no_colours_where_they_are_switched_off(forced, terminal, monkeypatch):
    assert COLOUR.search(laid_out(PAGE, 80))
    monkeypatch.setenv("NO_COLOR", "1")
    if forced:
        monkeypatch.setenv("FORCE_COLOR", "1")
    assert not COLOUR.search(laid_out(PAGE, 80))
    assert not COLOUR.search(terminal(*TABLE))


def test_an_empty_variable_switches_nothing_off(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "")
    assert COLOUR.search(laid_out(PAGE, 80))
