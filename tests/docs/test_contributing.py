"""What CONTRIBUTING.md says of the rooms is what the import contract says."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
DESIGN = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]


def _layers() -> list[set[str]]:
    return [set(re.split(r" [|:] ", layer)) for layer in CONTRACTS[0]["layers"]]


def _drawn(text: str) -> list[set[str]]:
    (picture,) = re.findall(r"```text\n(muster_studies.*?)```", text, flags=re.DOTALL)
    return [set(re.split(r" \| ", re.split(r" {2,}", line)[0])) for line in picture.splitlines()]


def _rooms() -> set[str]:
    return {path.name for path in (ROOT / "src" / "muster").iterdir() if (path / "__init__.py").is_file()}


@pytest.mark.parametrize("text", [TEXT, DESIGN], ids=["contributing", "design"])
def test_the_picture_of_the_house_is_the_import_contract(text):
    first, *rooms = _drawn(text)
    assert first == {"muster_studies"}
    assert rooms == _layers()
    assert set().union(*rooms) | {"core"} == _rooms()


def test_the_design_says_what_every_room_holds():
    rooms = DESIGN.split("## Rooms", 1)[1].split("\n## ", 1)[0]
    assert set(re.findall(r"^\| `([a-z]+)` \|", rooms, re.MULTILINE)) == _rooms()


def test_the_design_has_its_titles():
    titles = ["Words", "Rooms", "Numbers, units, frames", "Meaning", "Files", "The command", "Code"]
    assert re.findall(r"^## (.+)$", DESIGN, re.MULTILINE) == titles


def test_every_target_of_make_that_it_names_is_there():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    assert set(re.findall(r"\bmake ([a-z-]+)", TEXT)) - {"that"} <= targets
