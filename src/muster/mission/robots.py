"""The robots of a mission."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from muster.mission.goods import Amount, Amounts, by_commodity
from muster.mission.place_types import Place
from muster.mission.records import Checked, Record, record, spec
from muster.mission.rule_keys import RuleKeys
from muster.mission.rules import Rules
from muster.mission.site import IN_DEGREES, Point
from muster.mission.stations import Battery
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import Choice, Fault, Flag, Many, Number, Position, Table, Text, Whole, shown
from muster.mission.values.clock_times import SHIFT
from muster.mission.values.energy import ENDURANCE, RANGE
from muster.mission.values.time_types import Window, Windows

MOST_PIXELS = (1920, 1440)
"""Of a simulated camera's picture: width and height."""


@record
class Camera(Checked):
    """A camera fixed to a robot's body."""

    fov_deg: float = spec(Number(above=0, below=180), "field of view, horizontal")
    tilt_deg: float = spec(Number(minimum=-90, maximum=90), "downward tilt", default=0.0)
    mount: Point = spec(Position(), "place on the body, body frame", default=(0.0, 0.0, 0.0))
    width_px: int = spec(Whole(minimum=1, maximum=MOST_PIXELS[0]), "width of its picture", default=640)
    height_px: int = spec(Whole(minimum=1, maximum=MOST_PIXELS[1]), "height of its picture", default=480)
    rate_hz: float = spec(Number(above=0, maximum=100), "pictures a second", default=2.0)


_ROUNDING_S = 1e-6
"""By how much what a robot does may last beyond its shift."""

_AVAILABLE: Mapping[str, float | None] = {"available_from_s": 0.0, "available_until_s": None}
"""What a file that does not say when a robot is available means."""


def _joined(shifts: Sequence[Window]) -> tuple[Window, ...]:
    """The shifts in order, those that touch made one: there is no break between them."""
    joined: list[Window] = []
    for begins, ends in shifts:
        if joined and joined[-1][1] == begins:
            joined[-1] = (joined[-1][0], ends)
        else:
            joined.append((begins, ends))
    return tuple(joined)


@record
class Robot(RuleKeys, bearer="robot"):
    """One agent."""

    id: str = spec(Text(), "unique among the robots")
    position: Point = spec(Position(), "where it starts", instead=IN_DEGREES)
    type: str | None = spec(Text(), "row of the suitability table", default=None)
    work_capacity: float | None = spec(
        Number(minimum=0), "most usage; without it unlimited", unit="unit of usage", default=None
    )
    skills: tuple[str, ...] = spec(Many(Text()), "what it can do", default=())
    skill_quality: Mapping[str, float] | None = spec(
        Table(Number(above=0, maximum=1), "a mapping from skills to qualities, above 0 to 1"),
        "how well it can do that, for bids; of skills that are not named 1",
        default=None,
    )
    abilities: Mapping[str, float] | None = spec(
        Table(Number(minimum=0), "a mapping from abilities to amounts"),
        "what it can add to a team, for tasks with needs",
        default=None,
        if_used=True,
    )
    load_capacity: Amount | None = spec(
        Amounts(minimum=0),
        "the most that it carries, or by commodity; without it unlimited",
        default=None,
        if_used=True,
    )
    load_at_start: Amount | None = spec(
        Amounts(minimum=0), "what it carries at first, or by commodity", default=None, if_used=True
    )
    battery: Battery | None = spec(
        Record(Battery, "a battery"), "its energy", default=None, instead=(ENDURANCE, RANGE), if_used=True
    )
    speed_mps: float = spec(Number(above=0), "speed of travel", default=1.0)
    efficiency: float = spec(Number(above=0), "work of duration d takes d / efficiency (aging factor)", default=1.0)
    return_to_start: bool | None = spec(Flag(), "goes back to its start; without it as the rules say", default=None)
    end_position: Point | None = spec(Place(), "where its route ends; stronger than return_to_start", default=None)
    available_from_s: float = spec(Number(minimum=0), "earliest time it can leave", default=0.0, if_used=True)
    available_until_s: float | None = spec(
        Number(minimum=0),
        "when its route, the way to its end included, must have ended",
        default=None,
        instead=SHIFT,
        if_used=True,
    )
    shifts_s: tuple[Window, ...] = spec(
        Windows(),
        "when it works and drives: several shifts, between which it rests where it stands",
        default=(),
        if_used=True,
    )
    min_tasks: int = spec(Whole(), "it does at least so many tasks, or none at all", default=0, if_used=True)
    longest_duty_s: float | None = spec(
        Number(minimum=0),
        "longest time from leaving its start to the end of its route",
        default=None,
        if_used=True,
    )
    heading_deg: float = spec(Number(), "heading at the start, from east, anticlockwise", default=0.0)
    radius_m: float = spec(Number(minimum=0), "radius of its body", default=0.0)
    kind: str = spec(Choice(("ground", "air")), "where it moves", default="ground")
    kinematics: str = spec(
        Choice(("holonomic", "differential-drive", "quadcopter", "hexacopter")), "how it moves", default="holonomic"
    )
    yaw_rate_radps: float | None = spec(Number(above=0), "greatest yaw rate", default=None)
    acceleration_mps2: float | None = spec(Number(above=0), "greatest acceleration", default=None)
    climb_mps: float | None = spec(Number(above=0), "greatest speed of climb and descent, in the air", default=None)
    avoidance_priority: float = spec(Number(minimum=0), "who gives way: the lower one", default=0.0)
    camera: Camera | None = spec(Record(Camera, "a camera"), "its camera", default=None)

    tied = frozenset({"skill_quality", "available_until_s", "shifts_s", "load_at_start"})

    @classmethod
    def settled(cls, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """With `shifts_s` the robot is available from the first shift until the last; one shift alone says no more."""
        shifts = _joined(values.get("shifts_s", ()))
        if not shifts:
            return {}
        bounds = {"available_from_s": shifts[0][0], "available_until_s": shifts[-1][1]}
        if any(values.get(name, _AVAILABLE[name]) not in (_AVAILABLE[name], bound) for name, bound in bounds.items()):
            return {}  # a fault
        return {"shifts_s": shifts if len(shifts) > 1 else (), **bounds}

    def from_time(self, now_s: float) -> Robot:
        """Return the robot available no sooner than at a time, with what is left of its shifts then."""
        if not self.shifts_s:
            return self.changed(available_from_s=max(self.available_from_s, now_s))
        return self._with_shifts(self._shifts_from(now_s))

    def busy(self, from_s: float, until_s: float) -> Robot:
        """Return the robot available from a time on: at work until another, and then in what is left of its shifts."""
        if not self.shifts_s:
            ends_s = self.available_until_s
            ends_s = None if ends_s is None else max(ends_s, from_s)
            return self.changed(available_from_s=from_s, available_until_s=ends_s)
        left = self._shifts_from(until_s)
        return self._with_shifts([(from_s, until_s), *left] if from_s < until_s else left)

    def _shifts_from(self, now_s: float) -> list[Window]:
        left = [(max(begins, now_s), ends) for begins, ends in self.shifts_s if ends is None or ends > now_s]
        return left or [(now_s, now_s)]

    def _with_shifts(self, shifts: Sequence[Window]) -> Robot:
        (begins, _), (_, ends) = shifts[0], shifts[-1]
        return self.changed(shifts_s=tuple(shifts), available_from_s=begins, available_until_s=ends)

    def file_values(self) -> Mapping[str, Any]:
        return _AVAILABLE if self.shifts_s else {}

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        skills = values.get("skills", ())
        for name in values.get("skill_quality") or ():
            if name not in skills:
                yield Fault(("skill_quality", name), shown(name), f"one of its skills{did_you_mean(name, skills)}")
        begins, ends = values.get("available_from_s", 0.0), values.get("available_until_s")
        shifts = values.get("shifts_s") or ((begins, ends),)
        for name, given, bound in (
            ("available_from_s", begins, shifts[0][0]),
            ("available_until_s", ends, shifts[-1][1]),
        ):
            if given not in (_AVAILABLE[name], bound):
                yield Fault((name,), shown(given), f"{name} or shifts_s, not both")
        if ends is not None and ends < begins:
            yield Fault(("available_until_s",), shown(ends), f"a number of at least available_from_s ({begins:g})")
        most = values.get("load_capacity")
        for name, amount in by_commodity(values.get("load_at_start")).items():
            if most is not None and amount > (room := by_commodity(most).get(name, 0.0)):
                yield Fault(("load_at_start",), f"{amount:g} {name}".rstrip(), f"at most load_capacity ({room:g})")

    def place_at_end(self, rules: Rules) -> Point | None:
        """Where the robot's route must end, or None where it may end anywhere."""
        if self.end_position is not None:
            return self.end_position
        returns = rules.return_to_start if self.return_to_start is None else self.return_to_start
        return self.position if returns else None
