"""What CONTRIBUTING.md says of the rooms is what the import contract says."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]


def _layers() -> list[set[str]]:
    return [set(re.split(r" [|:] ", layer)) for layer in CONTRACTS[0]["layers"]]


def _drawn(text: str) -> list[set[str]]:
    (picture,) = re.findall(r"```text\n(muster_studies.*?)```", text, flags=re.DOTALL)
    return [set(re.split(r" \| ", re.split(r" {2,}", line)[0])) for line in picture.splitlines()]


def test_the_picture_of_the_house_is_the_import_contract():
    first, *rooms = _drawn(TEXT)
    assert first == {"muster_studies"}
    assert rooms == _layers()


def test_every_room_is_drawn():
    folders = {path.name for path in (ROOT / "src" / "muster").iterdir() if (path / "__init__.py").is_file()}
    assert set().union(*_drawn(TEXT)) - {"muster_studies"} | {"core"} == folders


def test_every_target_of_make_that_it_names_is_there():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    assert set(re.findall(r"\bmake ([a-z-]+)", TEXT)) - {"that"} <= targets
