"""Draws the map of packages and rooms in docs/house.md from the code: `python -m tools.house`.

A line of the map is the first sentence of the docstring of a package or room; the order of rooms is that of the import
contract, from the top down.
"""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "house.md"
_SRC = ROOT / "src"
_BEGIN, _END = "<!-- made by make house -->\n", "<!-- end -->\n"
_CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
PACKAGES, ROOMS = (contract["layers"] for contract in _CONTRACTS if contract["type"] == "layers")
"""The layers of packages, and those of the rooms of `muster`, from the top down, as the contracts have them."""


def written() -> str:
    """The page with the map as the code is now."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(_BEGIN)
    _, _, after = rest.partition(_END)
    return before + _BEGIN + "\n".join([*_map(), ""]) + _END + after


def _map() -> Iterator[str]:
    yield from _package("muster", [*_names(ROOMS), "core"])
    for name in _names(PACKAGES[-2::-1]):
        yield from _package(name, _rooms(name))


def _names(layers: list[str]) -> list[str]:
    return [name for layer in layers for name in layer.split(" | ")]


def _package(name: str, rooms: list[str]) -> Iterator[str]:
    yield f"\n### {name}\n"
    yield f"{_first_sentence(_SRC / name / '__init__.py')}\n"
    if rooms:
        yield "| room | what it holds |\n|---|---|"
        for place in (
            place for room in rooms for place in (room, *(f"{room}/{wing}" for wing in _rooms(f"{name}/{room}")))
        ):
            yield f"| `{place}` | {_first_sentence(_SRC / name / place / '__init__.py')} |"


def _rooms(place: str) -> list[str]:
    return sorted(path.parent.name for path in (_SRC / place).glob("*/__init__.py"))


def _first_sentence(file: Path) -> str:
    """The first paragraph of a module's docstring in one line.

    Raises
    ------
    SystemExit
        if it has none.
    """
    text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8")))
    if not text:
        raise SystemExit(f"{file.relative_to(ROOT)}: no docstring; expected one that says what the room holds")
    return " ".join(text.split("\n\n")[0].split())


if __name__ == "__main__":
    PAGE.write_text(written(), encoding="utf-8")
