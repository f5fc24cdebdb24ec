"""Stations, where robots charge, swap batteries or unload; and the batteries of robots."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from typing import Any

from muster.mission.records import Checked, record, spec
from muster.mission.site import IN_DEGREES, Point
from muster.mission.value_types import Choice, Fault, Flag, Many, Number, Position, Text, Whole, shown

SERVICES = ("charge", "swap", "unload")


def station_sign(name: str) -> str:
    """The id of a station as it is shown among ids of tasks: `[dock]`."""
    return f"[{name}]"


@record
class Battery(Checked):
    """The energy of a robot, in the unit of usage."""

    capacity: float = spec(Number(above=0), "the most that it holds", unit="unit of usage")
    at_start: float = spec(Number(minimum=0, maximum=1), "share of the capacity that it holds at first", default=1.0)
    reserve: float = spec(Number(minimum=0, below=1), "share of the capacity that stays in it", default=0.0)

    @property
    def level_at_start(self) -> float:
        """What it holds at first, in the unit of usage."""
        return self.at_start * self.capacity

    @property
    def least(self) -> float:
        """Below this it never comes, in the unit of usage."""
        return self.reserve * self.capacity

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        at_start, reserve = values.get("at_start", 1.0), values.get("reserve", 0.0)
        if at_start < reserve:
            yield Fault(("at_start",), shown(at_start), f"a number of at least reserve ({reserve:g})")


@record
class Station(Checked):
    """A place where robots charge, swap their batteries or unload."""

    id: str = spec(Text(), "unique among stations and tasks")
    position: Point = spec(Position(), "where it is", instead=IN_DEGREES)
    services: tuple[str, ...] = spec(Many(Choice(SERVICES), minimum=1), "what robots do there")
    slots: int = spec(Whole(minimum=1), "so many robots are served at once", default=1)
    charge_per_s: float | None = spec(
        Number(above=0), "what a second of charging adds", unit="unit of usage per second", default=None
    )
    swap_s: float = spec(Number(minimum=0), "how long a swap takes", default=0.0)
    partial: bool = spec(Flag(), "whether a charge may end before the battery is full", default=True)
    only_robots: tuple[str, ...] | None = spec(
        Many(Text(), minimum=1),
        "ids of the only robots that may call there",
        default=None,
        rule="lock",
    )

    def for_robots(self, robots: Collection[str]) -> Station | None:
        """Return the station as it is where there are no other robots; None: it is for none of them."""
        if self.only_robots is None:
            return self
        own = tuple(name for name in self.only_robots if name in robots)
        return replace(self, only_robots=own) if own else None

    @property
    def charges(self) -> bool:
        """Whether robots charge there."""
        return "charge" in self.services

    @property
    def swaps(self) -> bool:
        """Whether robots swap their batteries there."""
        return "swap" in self.services

    @property
    def unloads(self) -> bool:
        """Whether robots put down there what no task delivers."""
        return "unload" in self.services

    @property
    def gives_energy(self) -> bool:
        """Whether a battery is fuller after a visit."""
        return self.charges or self.swaps

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        services = values["services"]
        if len(set(services)) < len(services):
            yield Fault(("services",), shown(list(services)), "each service once")
        if {"charge", "swap"} <= set(services):
            yield Fault(("services",), shown(list(services)), "charge or swap; two stations may be at one place")
        if "charge" in services and values.get("charge_per_s") is None:
            yield Fault(("charge_per_s",), "missing", "what a second of charging adds, beside the service charge")
        if "charge" not in services and values.get("charge_per_s") is not None:
            yield Fault(("charge_per_s",), shown(values["charge_per_s"]), "the service charge beside it")
