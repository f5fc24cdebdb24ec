"""The function `generate` of the package."""

from __future__ import annotations

from typing import Any

from muster.generation.generator import require_seed
from muster.generation.registry import GENERATORS
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.value_types import shown

MOST_MISSIONS = 100_000


def generate(family: str, count: int = 1, seed: int = 0, **parameters: Any) -> list[Mission]:
    """Random missions of a family: those of `seed`, `seed + 1`, ...

    The same family, parameters and seed give the same mission on every machine.

    Parameters
    ----------
    family
        one of `muster generate --list`.
    count
        how many missions.
    seed
        that of the first; each mission is that of its own seed, however many are made.
    parameters
        of the family, by name (docs/generators.md).

    Raises
    ------
    ParameterError
        for a family or parameter that there is not, or a value out of range.
    """
    generator = GENERATORS.named(family)
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MOST_MISSIONS:
        raise ParameterError(f"count: {shown(count)}; expected a whole number from 1 to {MOST_MISSIONS}")
    require_seed(seed)
    return [generator.mission(seed + k, **parameters) for k in range(count)]
