"""What a kind of fleet declares of itself, in one object: settings, claims, abilities, needs, and how it is opened."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.records import Record, Settings, key_of, record, specified
from muster.mission.system.plugins import require_words
from muster.mission.value_types import Fault, shown
from muster.mission.values.keywords import require_known

if TYPE_CHECKING:
    from muster.execution.fleet import Fleet
    from muster.mission.model import Mission

Opened = tuple["Fleet", Callable[[], None]]
"""Robots that are ready, and what to call when all is done."""
OpenFleet = Callable[["Mission", Any, threading.Event, bool], Opened]
"""Opens a fleet: the mission, the settings of the run, an event that ends waiting, whether the run goes on."""
Claims = Callable[[Any], Iterable[str]]
"""Returns what a run with some settings claims: words for robots, the same for the same robots."""

ABILITIES: Mapping[str, str] = {
    "ground": "carries robots that drive",
    "air": "carries robots that fly",
    "joins": "robots join that the mission does not name",
    "holds": "robots stop where they are when they are told to",
    "returns": "robots go where their routes end, such as back to their starts",
    "charges": "robots are served at stations: they charge, or swap batteries, while they stay there",
    "battery": "robots report how full their batteries are",
    "resumes": "a run goes on after a crash of Muster, from wherever robots are",
    "leased": "orders age: robots stop by themselves when nobody has renewed their orders for a while",
}
"""What a fleet may be able to do, and what that means."""
GROUND, AIR, JOINS, HOLDS, RETURNS, CHARGES, BATTERY, RESUMES, LEASED = ABILITIES


@record
class NoSettings(Settings):
    """The settings of a fleet that has none."""


@dataclass(frozen=True, kw_only=True)
class FleetType:
    """A kind of fleet, as an entry of `muster.fleets` names it.

    Parameters
    ----------
    name : str
        The name of the entry, by which the fleet is called.
    open : callable
        Opens the fleet, ready to go; see `OpenFleet`.
    abilities : collection of str
        Which of `ABILITIES` the fleet has. What a run needs beside these is refused before the fleet is opened.
    settings : type, default `NoSettings`
        A class made with `muster.mission.records.record` from `Settings`; `open` and `claims` receive an instance.
    claims : callable, optional
        Returns the claims of a run by its settings, such as `[settings.url]`: two runs that claim the same never
        command robots at the same time. It is called before the fleet is opened, in another process. Without it the
        fleet is claimed as a whole: one run at a time.
    require_installed : callable, optional
        Raises `MissingExtraError` if this machine lacks a package that the fleet needs. It is called before the fleet
        is opened, and when mission control starts that serves the fleet.

    Raises
    ------
    ParameterError
        If an ability is unknown, none of robots is declared, or the settings are no class made from `Settings`.
    """

    name: str
    open: OpenFleet
    abilities: Collection[str]
    settings: type[Settings] = NoSettings
    claims: Claims | None = None
    require_installed: Callable[[], None] = lambda: None

    def __post_init__(self) -> None:
        require_words("abilities", self.abilities, tuple(ABILITIES))
        if not {GROUND, AIR}.intersection(self.abilities):
            raise ParameterError(f"abilities: {shown(list(self.abilities))}; expected {GROUND}, {AIR} or both")
        if not (isinstance(self.settings, type) and issubclass(self.settings, Settings)):
            name = getattr(self.settings, "__name__", shown(self.settings))
            raise ParameterError(f"settings: {name}; expected a class made from Settings")

    @property
    def setting_names(self) -> tuple[str, ...]:
        """The names of its settings."""
        return tuple(map(key_of, specified(self.settings)))

    def checked_settings(self, given: object) -> Any:
        """Return settings as an instance of the declared class.

        Raises
        ------
        ParameterError
            If a setting is unknown, missing or wrong.
        """
        if isinstance(given, self.settings):
            return given
        if isinstance(given, Mapping):
            require_known(given, self.setting_names)
        faults: list[Fault] = []
        read = Record(self.settings, "settings").read(given, (), faults)
        if faults:
            raise self.settings.refusal(faults)
        return read

    def lacks(self, ability: str) -> str:
        """Return why something that needs an ability is refused, in words; empty if the fleet has the ability."""
        return "" if ability in self.abilities else f"fleet {self.name} lacks the ability {ability}"

    def require_able(self, mission: Mission, *, resumes: bool = False) -> None:
        """Raise `ParameterError` if a mission needs an ability that the fleet lacks.

        Parameters
        ----------
        mission : Mission
            Its robots, those that join, its stations and the ends of its routes are checked.
        resumes : bool, default False
            Whether the mission is under way already.
        """
        if resumes and (why := self.lacks(RESUMES)):
            raise ParameterError(f"the mission is under way; expected one that begins: {why}")
        for robot in mission.all_robots:
            if robot.kind not in self.abilities:
                kinds = " or ".join(kind for kind in (GROUND, AIR) if kind in self.abilities)
                raise ParameterError(
                    f"robot {shown(robot.id)}: kind {robot.kind}; expected {kinds}: fleet {self.name} has no others"
                )
            if robot.place_at_end(mission.rules) is not None and (why := self.lacks(RETURNS)):
                raise ParameterError(f"robot {shown(robot.id)}: its route has an end; expected none: {why}")
        if mission.newcomers and JOINS not in self.abilities:
            robot = mission.newcomers[0]
            raise ParameterError(f"robot {shown(robot.id)}: joins; expected none: no robot joins fleet {self.name}")
        if any(robot.battery is not None for robot in mission.all_robots) and (why := self.lacks(CHARGES)):
            for station in mission.stations:
                if station.gives_energy:
                    services = ", ".join(station.services)
                    raise ParameterError(f"station {shown(station.id)}: {services}; expected no such station: {why}")
