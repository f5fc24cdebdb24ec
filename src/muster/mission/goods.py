"""Goods: what tasks take on board and put down, by commodity, and what robots can carry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real
from typing import Any, ClassVar

from muster.mission.value_types import Fault, JsonSchema, Number, Path, Table, refuse

Amount = float | Mapping[str, float]
"""Of the only commodity, which has no name, or by commodity."""

ONLY = ""
"""The commodity of a mission that names none."""


@dataclass(frozen=True)
class Amounts:
    """A number, or a mapping from commodities to numbers."""

    filler: ClassVar[float] = 0.0
    minimum: float | None = None

    @property
    def expected(self) -> str:
        return f"{Number(minimum=self.minimum).expected}, or a mapping from commodities to such"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        number = Number(minimum=self.minimum)
        if isinstance(value, Mapping):
            return Table(number, self.expected).read(value, at, faults)
        if not isinstance(value, int | float | Real):
            return refuse(self, value, at, faults)
        return number.read(value, at, faults)

    def schema(self) -> JsonSchema:
        number = Number(minimum=self.minimum)
        return {"anyOf": [number.schema(), Table(number, "").schema()]}


def by_commodity(amount: Amount | None) -> Mapping[str, float]:
    """An amount as a mapping from commodities, without those of which there is nothing."""
    if amount is None:
        return {}
    named = amount if isinstance(amount, Mapping) else {ONLY: amount}
    return {name: value for name, value in named.items() if value}


def shown_amounts(amounts: Mapping[str, float]) -> str:
    """Amounts in one line: `3`, or `2 parcels, 1.5 water_l`."""
    return ", ".join(f"{value:.10g} {name}".rstrip() for name, value in amounts.items()) or "0"


def as_amount(amounts: Mapping[str, float]) -> Amount | None:
    """Amounts by commodity as a mission has them; None: nothing."""
    if not amounts:
        return None
    return amounts[ONLY] if set(amounts) == {ONLY} else dict(amounts)


def negative(amounts: Mapping[str, float]) -> Amount | None:
    """The same amounts, put down."""
    return as_amount({name: -amount for name, amount in amounts.items()})
