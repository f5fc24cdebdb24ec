"""The manual page: that of the repository is that of the command, and roff reads it."""

import shutil
import subprocess
from pathlib import Path

import pytest

from muster.cli.main import verbs
from muster.cli.verbs.man import page

VERBS = tuple(verbs())

PAGE = Path(__file__).parents[2] / "man/muster.1"


def without_version(text):
    return [line for line in text.splitlines() if not line.startswith(".TH")]


def test_the_page_that_is_installed_is_up_to_date(muster):
    code, out, err = muster("man")
    assert (code, err) == (0, "")
    assert without_version(out) == without_version(PAGE.read_text(encoding="utf-8")), "run `make man`"


def test_every_verb_with_its_options():
    text = page()
    for verb in VERBS:
        assert f".SS muster {verb} " in text
    assert r"\fB\-\-time\-limit" in text


def test_nothing_but_macros_begins_with_a_dot():
    macros = {".TH", ".SH", ".SS", ".PP", ".TP", ".B", ".nf", ".fi"}
    assert {line.split()[0] for line in page().splitlines() if line.startswith((".", "'"))} <= macros


@pytest.mark.skipif(shutil.which("groff") is None, reason="no groff")
def test_roff_has_nothing_to_warn_of():
    read = subprocess.run(
        ["groff", "-man", "-ww", "-Tutf8", "-z"], input=page(), capture_output=True, encoding="utf-8", check=True
    )
    assert read.stderr == ""
