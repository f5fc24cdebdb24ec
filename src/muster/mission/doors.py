"""Doors: the zones and lanes of a mission that have an id, which events close and open."""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.mission_data import MissionData


def doors_of(mission: MissionData) -> dict[str, bool]:
    """Every door of a mission by its id, and whether it is open before any event: lanes are."""
    zones = () if mission.map is None else mission.map.zones
    lanes = () if mission.lanes is None else mission.lanes.edges
    return {zone.id: zone.open for zone in zones if zone.id} | {lane.id: True for lane in lanes if lane.id}


@dataclass
class Doors:
    """Which doors of a mission are open now.

    Attributes
    ----------
    known
        the ids of all.
    closed
        the ids of those that are closed.
    """

    known: frozenset[str]
    closed: frozenset[str]

    @classmethod
    def of(cls, mission: MissionData) -> Doors:
        """As they are before any event."""
        doors = doors_of(mission)
        return cls(frozenset(doors), frozenset(name for name, is_open in doors.items() if not is_open))

    def close(self, door: str) -> None:
        """A door is closed from now on."""
        self.closed |= {door}

    def open(self, door: str) -> None:
        """A door is open from now on."""
        self.closed -= {door}
