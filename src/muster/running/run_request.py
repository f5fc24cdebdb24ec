"""The one request of a run: how a plan is carried out, in a simulated world or by a fleet of real robots.

Python, the command, mission control and the run on a server make this request, so that all take the same values, have
the same defaults and refuse with the same texts. The options of the command, their units, defaults and help follow from
the fields. No heavy module is imported.
"""

from __future__ import annotations

import math
from collections import ChainMap
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Self

from muster.mission.errors import ParameterError
from muster.mission.records import Record, Settings, record, spec, specified
from muster.mission.value_types import Choice, Fault, Flag, Number, Path, Whole, shown
from muster.mission.values.keywords import require_known
from muster.mission.yaml_writer import plain
from muster.motion.avoidance_names import AUTO, AVOIDANCE
from muster.motion.laws import LAWS, PROFILE, TRAJECTORY
from muster.motion.noise import CALM, NO_NOISE, Noise, Wind
from muster.planning.options import LARGEST_SEED, PlanningOptions
from muster.running.fleet_registry import FLEETS
from muster.running.fleet_type import HOLDS
from muster.running.request_kinds import ByRobot, FleetSettings, Orders, Replanning, Rules, Sensors
from muster.running.wall_time import STARTS
from muster.running.worlds import WORLDS
from muster.traffic.names import DEFAULT, RESERVE, TRAFFIC

if TYPE_CHECKING:
    from muster.execution import Standing
    from muster.mission.model import Event

TRUE, ESTIMATE = POSES = ("true", "estimate")
"""What robots steer by: where they are, or where they take themselves to be."""
SIMULATED, REAL = "simulated", "real"
"""Marks of fields that count in simulated worlds alone, or for real robots alone."""
OPEN_FLEET = "(an open fleet)"
"""Stands for the name of a fleet where a fleet that is open carries the plan out."""
BESIDE_SETTINGS = ("world", "speed", "settings")
"""Fields that the API and the database hold beside the settings of a run."""


class _World(Choice):
    """The kind of names of worlds and fleets."""

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`."""
        return value if value == OPEN_FLEET else super().read(value, at, faults)


@record
class RunRequest(Settings):
    """How a plan is carried out.

    Raises
    ------
    ParameterError
        if a value is wrong, or does not count in the world.
    PluginError
        if a fleet of another package cannot be loaded.
    """

    world: str = spec(
        _World(ChainMap(FLEETS, WORLDS)),  # type: ignore[arg-type]
        "the world: kinematic, physics, or one of an installed package",
        default="kinematic",
        metavar="WORLD",
        counts=SIMULATED,
    )
    avoidance: str = spec(
        Choice(AVOIDANCE),
        "how robots pass each other; auto: simulated in the plane by hrvo, else by orca",
        default=AUTO,
        counts=SIMULATED,
    )
    traffic: str = spec(
        Choice(TRAFFIC),
        "who passes first: reserve, by one plan for all that drive; free, as they meet. auto: reserve where the "
        "mission gives lanes or its map has passages for one, where robots at their ends can close others out, or "
        "where a simulated run of given tasks is forecast to be faster so, and no avoidance and no other law than "
        "profile is asked for",
        default=DEFAULT,
    )
    law: str = spec(Choice(LAWS), "how robots move", default=PROFILE, counts=SIMULATED)
    dt_s: float = spec(Number(minimum=0.001, maximum=1.0), "step of the world", default=0.1, counts=SIMULATED)
    speed: float | None = spec(
        Number(minimum=0.001, maximum=1e6),
        "times real time; the run is as fast as possible without it",
        default=None,
        metavar="X",
        counts=SIMULATED,
    )
    noise: Noise = spec(
        Record(Noise, "a mapping"),
        "noise of motion and telemetry; see docs/simulation.md",
        default=NO_NOISE,
        option="--noise",
        metavar="KIND=AMOUNT",
        counts=SIMULATED,
    )
    stay: bool = spec(Flag(), "stay on duty when all tasks are done, until the duty ends or Ctrl-C", default=False)
    until_s: float | None = spec(
        Number(minimum=0.0),
        "end of the duty of a fleet that stays: later orders are not taken, and what is open is ended",
        default=None,
    )
    orders: Iterable[Event] = spec(
        Orders(),
        "tasks that come meanwhile, by time: events as JSON lines, or .csv with at_s,id,x,y",
        default=(),
        metavar="FILE",
    )
    wind: Wind = spec(Record(Wind, "a mapping"), "wind in which drones fly", default=CALM, counts=SIMULATED)
    rotor_level: bool = spec(
        Flag(),
        "simulate drones rotor by rotor, in the physics world",
        default=False,
        option="--rotors",
        counts=SIMULATED,
    )
    batteries: Mapping[str, float] | None = spec(
        ByRobot(Number(minimum=0.0, maximum=1.0), "shares of full batteries by robot, or for `all`"),
        "shares, 0 to 1, of full batteries with which robots begin, by robot or for `all`",
        default=None,
        option="--battery",
        metavar="ROBOT=SHARE",
        counts=SIMULATED,
    )
    drain: Mapping[str, float] | None = spec(
        ByRobot(Number(above=0.0), "factors by robot, or for `all`", all_alone=True),
        "how many times as fast as by usage batteries drain, by robot or for `all`",
        default=None,
        metavar="[ROBOT=]FACTOR",
        counts=SIMULATED,
    )
    pose: str | None = spec(
        Choice(POSES),
        "what robots steer by; without it estimate where sensors are named or poses or odometry have noise, else true",
        default=None,
        counts=SIMULATED,
    )
    localise: Mapping[str, Mapping[str, float | str]] | None = spec(
        Sensors(),
        "sensors by which robots estimate their poses: odometry, inertial, tags, lasers, scans, motion-capture, gps, "
        "rtk; see docs/estimation.md",
        default=None,
        metavar="SENSOR[:KEY=VALUE,...]",
        counts=SIMULATED,
    )
    unknown: bool = spec(
        Flag(),
        "robots have no map: they build it with their lidars, and plan by it; robots on ROS by the maps that they "
        "tell; see docs/unknown-ground.md",
        default=False,
    )
    explore: bool = spec(
        Flag(),
        "frontiers of the map that is built become tasks; with unknown, where something is to be found in a simulated "
        "world they do anyway",
        default=False,
    )
    starts: str = spec(
        Choice(STARTS),
        "when the mission starts: given, at its starts_at; now, when robots are ready, with all its times shifted",
        default="given",
        counts=REAL,
    )
    recover: bool = spec(
        Flag(),
        "bring all robots home, or as their fleet ends flights, and do no task: after a run that was interrupted",
        default=False,
        counts=REAL,
    )
    accept_partial: bool = spec(
        Flag(),
        "accept a plan that the time limit cut short; else it is not carried out",
        default=False,
    )
    seed: int = spec(Whole(maximum=LARGEST_SEED), "seed of the world and of planning again", default=0, option="")
    ignore: tuple[str, ...] = spec(
        Rules(), "rules that do not hold, whatever the plan says of itself", default=(), option=""
    )
    planning: PlanningOptions | None = spec(
        Replanning(), "options with which the rest is planned again", default=None, option=""
    )
    settings: Any = spec(
        FleetSettings(), "settings of the fleet, as it declares them", default=None, option="", counts=REAL
    )

    @classmethod
    def from_settings(cls, world: str, settings: Mapping[str, Any], speed: float | None = None) -> Self:
        """Return the request of settings as the API and the database hold them: a fleet's own beside all others.

        Raises
        ------
        ParameterError, PluginError
            for an unknown setting, or as the class does.
        """
        own: Mapping[str, Any] | None = None
        if world in FLEETS:
            declared = FLEETS[world].setting_names
            require_known(settings, (*declared, *SETTING_NAMES))
            own = {name: value for name, value in settings.items() if name in declared}
        rest = {name: value for name, value in settings.items() if name not in (own or ())}
        for name in BESIDE_SETTINGS:
            if name in rest:
                raise ParameterError(f"settings: {name}; expected it beside settings, if at all")
        return cls(world=world, speed=speed, settings=own, **rest)

    def as_settings(self) -> dict[str, Any]:
        """Return the settings as plain data, as `from_settings` takes them; defaults are left out.

        Raises
        ------
        ParameterError
            if one of them is an object of this process that has no such form.
        """
        data: dict[str, Any] = plain(self)
        return {name: value for name, value in data.items() if name not in BESIDE_SETTINGS} | (
            data.get("settings") or {}
        )

    @property
    def is_real(self) -> bool:
        """Whether real robots carry the plan out."""
        return self.world not in WORLDS

    @property
    def duty(self) -> Standing | None:
        """The fleet that stays on duty; None: it ends when its tasks are done.

        With orders and without `stay` it stays until the last of them is done.
        """
        if not self.stay and self.orders == ():
            return None
        from muster.execution import Standing

        on_duty_s = math.inf if self.until_s is None else self.until_s
        return Standing(until_s=on_duty_s if self.stay else None, orders=self.orders)

    @classmethod
    def settled(cls, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """Read the settings of a fleet as it declares them."""
        if values["world"] not in FLEETS:
            return {}
        return {"settings": FLEETS[values["world"]].checked_settings(values["settings"] or {})}

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        """Refuse what does not count in the world, and an end of the duty without one."""
        if values["until_s"] is not None and not values["stay"]:
            yield Fault(("until_s",), shown(values["until_s"]), "it together with stay")
        if values["explore"] and not values["unknown"]:
            yield Fault(("explore",), shown(True), "it together with unknown")
        if values["unknown"] and values["traffic"] == RESERVE:
            yield Fault(("traffic",), RESERVE, "free: ways are not known beforehand; or a map that was saved")
        if values["unknown"] and values["law"] == TRAJECTORY:
            yield Fault(("law",), TRAJECTORY, "profile or thesis: trajectories are rounded by the map")
        if values["traffic"] == RESERVE and values["world"] in FLEETS and (why := FLEETS[values["world"]].lacks(HOLDS)):
            yield Fault(("traffic",), RESERVE, f"free: {why}")
        real = values["world"] not in WORLDS
        what, other = ("real robots", SIMULATED) if real else ("a simulated world", REAL)
        for f in specified(RunRequest):
            given = values[f.name]
            if f.name != "world" and f.metadata.get("counts") == other and given != f.default:
                yield Fault((f.name,), shown(plain(given)), f"none: a run of {what} has no {f.name}")


SETTING_NAMES = tuple(f.name for f in specified(RunRequest) if f.name not in BESIDE_SETTINGS)
"""The settings of runs, whatever the fleet."""
