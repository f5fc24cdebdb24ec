"""What the command says of itself."""

import re

import pytest

from muster.cli.main import verbs

VERBS = tuple(verbs())

pytestmark = pytest.mark.usefixtures("folder")


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("flag", ["--help", "-h"])
def test_help_of_a_verb(verb, flag, muster):
    code, out, err = muster(verb, flag)
    assert (code, err) == (0, "")
    assert out.startswith(f"Usage: muster {verb} [OPTIONS]")
    assert all(len(line) <= 80 for line in out.splitlines())


@pytest.mark.parametrize("verb", VERBS)
def test_no_marks_of_layout_in_help(verb, muster):
    assert "\\b" not in muster(verb, "--help")[1]


def test_help(muster):
    code, out, err = muster("--help")
    assert (code, err) == (0, "")
    assert re.findall("^  ([a-z][a-z0-9]*) ", out.split("Verbs:")[1], flags=re.MULTILINE) == list(VERBS)


def test_no_verb_shows_help(muster):
    code, out, err = muster()
    assert (code, out) == (2, "")
    assert err.startswith("Usage: muster [OPTIONS] COMMAND")


def test_version_and_how_the_core_was_built(muster):
    code, out, err = muster("--version")
    assert (code, err) == (0, "")
    assert re.fullmatch(r"muster \d\S* \(core: .*; Python \d\S*\)\n", out)


def test_unknown_verb(muster):
    code, out, err = muster("sovle", "yard.yaml")
    assert (code, out) == (2, "")
    assert err.splitlines()[-1] == "Error: no verb 'sovle'; did you mean 'solve'?"


@pytest.mark.parametrize("verb", VERBS)
def test_unknown_option(verb, muster):
    code, out, err = muster(verb, "--colour")
    assert (code, out) == (2, "")
    assert "No such option" in err.splitlines()[-1]
