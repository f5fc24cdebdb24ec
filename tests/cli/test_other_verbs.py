"""Verbs that other packages register as entry points of the group `muster.verbs`."""

import importlib
import re
import sys

import pytest

from muster.mission.system.plugins import declared, is_shipped

MODULE = '''
import click

@click.command()
@click.option("--loud", is_flag=True)
def command(loud):
    """Greet the team. Nothing else happens."""
    click.echo("HELLO" if loud else "hello")

no_command = 3
'''
ENTRY_POINTS = """
[muster.verbs]
greet = acme_verbs:command
broken = acme_absent:command
odd = acme_verbs:no_command
solve = acme_verbs:command
"""


@pytest.fixture(autouse=True)
def acme(tmp_path, monkeypatch):
    """An installed package with verbs of its own."""
    about = tmp_path / "acme-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: acme\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(ENTRY_POINTS)
    (tmp_path / "acme_verbs.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    importlib.invalidate_caches()
    yield
    sys.modules.pop("acme_verbs", None)


def test_a_verb_of_another_package_runs(muster):
    assert muster("greet", "--loud") == (0, "HELLO\n", "")


def test_help_lists_the_verbs_of_other_packages_after_the_own(muster):
    code, out, err = muster("--help")
    assert (code, err) == (0, "")
    names = [line.split()[0] for line in out.splitlines() if re.match("  [a-z]", line)]
    shipped = [verb.name for verb in declared("muster.verbs") if is_shipped(verb)]
    verbs = [name for name in names if name in {*shipped, "greet"}]
    assert verbs == [*shipped, "greet"]
    assert "Greet the team." in out
    assert "No module named" in out  # why `broken` cannot be used


def test_only_the_verb_asked_for_is_imported(muster):
    assert muster("solve", "--help")[1].startswith("Usage: muster solve [OPTIONS] MISSION")
    assert "acme_verbs" not in sys.modules


def test_a_verb_that_cannot_be_imported_is_one_line(muster):
    code, out, err = muster("broken")
    expected = "ModuleNotFoundError: No module named 'acme_absent'; expected a click command"
    assert (code, out, err) == (2, "", f"verb broken: acme_absent:command: {expected}\n")


def test_a_verb_that_is_no_command_is_one_line(muster):
    assert muster("odd") == (2, "", "verb odd: acme_verbs:no_command: 3; expected a click command\n")


def test_a_near_match_is_found_among_all_verbs(muster):
    assert "did you mean 'greet'?" in muster("gret")[2]
