"""What the commands of a mission come to: stops with their holds, speeds, and where the vehicle ends.

Jumps are unrolled: what is repeated is so many tasks, and a round begins after the one before it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from muster.mission.errors import MissionError
from muster.mission.import_ledger import Fate, passed_over, read_as
from muster_files.qgc import plan_format as qgc
from muster_files.qgc.commands import LANDINGS, PASSED_OVER, READ, STOPS, TAKEOFFS, name_of, param_of, told
from muster_files.qgc.fields import Degrees, PlanFields, is_number
from muster_files.sites.frame import FARTHEST_M, Frame

_RELATIVE = (qgc.FRAME_GLOBAL_RELATIVE_ALT, qgc.FRAME_GLOBAL_RELATIVE_ALT_INT)
_FRAMES = (*_RELATIVE, qgc.FRAME_GLOBAL, qgc.FRAME_GLOBAL_INT)
MOST_STOPS = 5_000
"""That jumps come to."""
_NOTHING = passed_over("is 0, and says nothing", minor=True)
_ANEW = passed_over("is planned anew: Muster stops at every stop")
_CLIMBS = passed_over("belongs to take-off: Muster climbs from home on the way to the first task")
_LANDS = passed_over("belongs to landing: Muster leaves it to the autopilot")
_ENDS = (*LANDINGS, qgc.NAV_RETURN_TO_LAUNCH)
_JUMPS = "a jump to an item before it, a whole number of times"


@dataclass(eq=False)
class Command:
    """One command of a file.

    Parameters
    ----------
    number
        of its item in the file, from 1: the id of a task has it.
    sequence
        the number by which jumps name it.
    names
        what the file calls the parameters and other fields, for errors.
    fates
        of its parameters by index, as they are taken.
    whole
        the fate of all of it, if it is passed over.
    """

    fields: PlanFields
    number: int
    sequence: int | None
    command: int
    frame: object
    params: Sequence[Any]
    names: Mapping[int | str, str]
    fates: dict[int, Fate] = field(default_factory=dict)
    whole: Fate | None = None

    def __post_init__(self) -> None:
        if self.command in PASSED_OVER:
            self.whole = passed_over(PASSED_OVER[self.command])
        elif self.command not in READ:
            expected = f"one of {', '.join(map(name_of, READ))}, or a command of cameras or payloads"
            raise self.fields.refused_as(self.names["command"], told(self.command), expected)

    def param(self, k: int, what: str) -> Any:
        """The parameter at an index, which is marked as read."""
        self.fates.setdefault(k, read_as(what))
        return self.params[k]

    def number_at(self, k: int, what: str, expected: str) -> float:
        """The number at an index; 0 where nothing is said."""
        value = self.param(k, what)
        if value is None:
            return 0.0
        if not is_number(value) or value < 0:
            raise self.wrong(k, value, expected)
        return float(value)

    def wrong(self, key: int | str, value: object, expected: str) -> MissionError:
        """The error for a parameter, or another field."""
        if isinstance(key, int):
            expected += f" ({name_of(self.command)} {param_of(self.command, key)})"
        return self.fields.refused(self.names[key], value, expected)

    def fate(self, k: int) -> Fate:
        """The fate of the parameter at an index."""
        fate = self.whole or self.fates.get(k)
        if fate is not None:
            return fate
        if not self.params[k]:
            return _NOTHING
        return _CLIMBS if self.command in TAKEOFFS else _LANDS if self.command in _ENDS else _ANEW

    def place(self, home: Degrees, here: Degrees) -> Degrees:
        """The place of the command; without latitude and longitude, or with 0 for both, it is `here`."""
        for k in (4, 5, 6):
            self.fates.setdefault(k, read_as("a place"))
        lat, lon, height = self.params[4:]
        is_here = (lat is None and lon is None) or (lat == 0 and lon == 0)
        if is_here and self.command in LANDINGS:
            return (*here[:2], home[2])
        if is_here:
            lat, lon, height = *here[:2], here[2] - home[2] if height is None else height
        if self.frame not in _FRAMES:
            raise self.wrong("frame", self.frame, f"one of {', '.join(map(str, sorted(_FRAMES)))}")
        lat, lon, height = self.fields.place([lat, lon, height], self.names["place"])
        require_near(self.fields, (lat, lon), home, self.names["place"])
        return (lat, lon, home[2] + height) if self.frame in _RELATIVE else (lat, lon, height)


def require_near(fields: PlanFields, place: Sequence[float], home: Degrees, at: str) -> None:
    """Raise MissionError for a place that cannot be meant, as it is far from home."""
    frame, spot = Frame(*home), (place[1], place[0])
    if frame.is_far(spot):
        value = f"latitude {place[0]:g}, longitude {place[1]:g}"
        expected = f"within {FARTHEST_M / 1000:g} km of the planned home, not {frame.distance(spot) / 1000:,.0f}"
        raise fields.refused_as(at, value, expected)


@dataclass(frozen=True)
class Stop:
    """A way point: the number of its item, its place, and seconds of hold."""

    number: int
    place: Degrees
    hold_s: float


@dataclass
class Flight:
    """The flight of one vehicle.

    Parameters
    ----------
    stops
        by the number of their items.
    order
        the numbers of stops and surveys in the order of the flight, repeated where jumps repeat them.
    loops
        for each item that a jump repeats the items of that jump's round.
    speeds, climbs
        all that the flight sets, m/s; `late` is whether something comes before the first speed.
    """

    stops: dict[int, Stop] = field(default_factory=dict)
    order: list[int] = field(default_factory=list)
    loops: dict[int, tuple[int, ...]] = field(default_factory=dict)
    speeds: list[float] = field(default_factory=list)
    climbs: list[float] = field(default_factory=list)
    late: bool = False
    returns: bool = False
    lands_at: Degrees | None = None
    takes_off: bool = False


def flight_of(commands: Sequence[Command], surveys: Mapping[int, Degrees | None], home: Degrees) -> Flight:
    """Return what commands come to.

    Parameters
    ----------
    surveys
        by the number of their items, where each ends, if the file says so.
    """
    flight, here, held = Flight(), home, 0
    by_number = {command.number: command for command in commands}
    ended: Command | None = None
    for number in sorted({*by_number, *surveys}):
        if number in surveys:
            here, held = surveys[number] or here, 0
            continue
        command = by_number[number]
        if command.whole is not None:
            continue
        if ended is not None and command.command in (*STOPS, *TAKEOFFS):
            expected = "it after the last way point: a vehicle that lands on the way is not read"
            raise ended.fields.refused_as(ended.names["command"], told(ended.command), expected)
        if command.command in STOPS:
            place = here = command.place(home, here)
            flight.stops[number] = Stop(number, place, command.number_at(0, "seconds of hold", "seconds of at least 0"))
            held = number
        elif command.command in _ENDS:
            ended = command
            flight.returns = flight.returns or command.command == qgc.NAV_RETURN_TO_LAUNCH
            if command.command in LANDINGS:
                flight.lands_at = command.place(home, here)
        elif command.command == qgc.NAV_DELAY:
            _delay(flight, command, held)
        elif command.command == qgc.DO_CHANGE_SPEED:
            if not flight.speeds:
                flight.late = bool(flight.stops) or any(survey < number for survey in surveys)
            _change_speed(flight, command)
        flight.takes_off = flight.takes_off or command.command in TAKEOFFS
    _unroll(flight, commands, surveys)
    return flight


def _delay(flight: Flight, command: Command, held: int) -> None:
    """Add a delay to the hold of the stop before it."""
    seconds = command.number_at(0, "seconds of hold", "seconds of at least 0: times of day are not read")
    if not held:
        raise command.wrong(0, command.params[0], "a way point before the delay")
    stop = flight.stops[held]
    flight.stops[held] = Stop(held, stop.place, stop.hold_s + seconds)


def _change_speed(flight: Flight, command: Command) -> None:
    """Add the speed that a command sets; the slowest of a flight is the robot's, as routes are planned anew."""
    kind = command.param(0, "what the speed is of")
    known = (qgc.AIR_SPEED, qgc.GROUND_SPEED, qgc.CLIMB_SPEED, qgc.DESCENT_SPEED)
    if isinstance(kind, bool) or kind not in known:
        raise command.wrong(0, kind, f"one of {', '.join(map(str, known))}")
    if command.param(3, "whether the speed is relative") not in (0, None):
        raise command.wrong(3, command.params[3], "0: speeds in m/s, not relative ones")
    if command.param(2, "no throttle") not in (-1, 0, None):
        raise command.wrong(2, command.params[2], "-1: a speed in metres a second, not a throttle")
    of = flight.climbs if kind in (qgc.CLIMB_SPEED, qgc.DESCENT_SPEED) else flight.speeds
    speed = command.param(1, "a speed: the slowest of the flight is taken")
    if is_number(speed) and speed > 0:
        of.append(float(speed))
    elif speed not in (-1, -2, None):
        raise command.wrong(1, speed, "metres a second above 0, or -1 for no change")


def _unroll(flight: Flight, commands: Sequence[Command], surveys: Mapping[int, object]) -> None:
    """Set the order of a flight, with what jumps repeat."""
    steps: list[tuple[int, Command | None]] = [(number, None) for number in (*flight.stops, *surveys)]
    steps += [(command.number, command) for command in commands if command.command == qgc.DO_JUMP]
    steps.sort(key=lambda step: step[0])
    by_sequence = {command.sequence: command.number for command in commands if command.sequence is not None}
    done: Counter[int] = Counter()
    at = 0
    while at < len(steps):
        number, jump = steps[at]
        at += 1
        if jump is None:
            flight.order.append(number)
            continue
        target, times = _jump(jump, by_sequence)
        if done[number] > times:
            raise jump.wrong(0, jump.params[0], "a jump that no other jump repeats")
        done[number] += 1
        if done[number] <= times:
            loop = tuple(n for n, other in steps if other is None and target <= n < number)
            flight.loops |= dict.fromkeys(loop, loop)
            _require_room(flight, jump, times * len(loop))
            at = next(k for k, (n, _) in enumerate(steps) if n >= target)


def _jump(jump: Command, by_sequence: Mapping[int, int]) -> tuple[int, int]:
    """The number of the item that a jump leads to, and how often."""
    named, times = jump.param(0, "where a jump leads"), jump.param(1, "how often it is repeated")
    for k, value in ((0, named), (1, times)):
        if not is_number(value) or value % 1 or value < 0:
            raise jump.wrong(k, value, _JUMPS)
    target = by_sequence.get(int(named))
    if target is None or target >= jump.number:
        raise jump.wrong(0, named, _JUMPS)
    return target, int(times)


def _require_room(flight: Flight, jump: Command, more: int) -> None:
    if len(flight.order) + more > MOST_STOPS:
        raise jump.wrong(1, jump.params[1], f"at most {MOST_STOPS:,} stops in all")
