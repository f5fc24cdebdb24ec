"""CONTRIBUTING.md names what is there, and docs/design.md has its titles."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
DESIGN = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]


def test_the_design_has_its_titles():
    titles = ["Words", "Rooms", "Numbers, units, frames", "Meaning", "Files", "The command", "Code"]
    assert re.findall(r"^## (.+)$", DESIGN, re.MULTILINE) == titles


def test_every_target_of_make_that_it_names_is_there():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    assert set(re.findall(r"\bmake ([a-z-]+)", TEXT)) - {"that"} <= targets
