"""The clauses: what a fleet must do. A check returns what it has seen, or raises `LackingError`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace

from muster.mission.errors import MusterError
from muster.mission.model import Robot
from muster.mission.records import key_of, required, specified
from muster.mission.value_types import Text
from muster.running.fleet_type import BATTERY, HOLDS, LEASED, RESUMES
from muster_robots.conformance.leases import orders_age
from muster_robots.conformance.stand import (
    FRESH_S,
    NEAR_M,
    STILL_M,
    LackingError,
    Resources,
    Stand,
    Trial,
    told,
)

_NONSENSE = "no such thing"
_HOLD_S, _WATCHED_S, _SILENT_S = 3.0, 2.0, 4.0
MOST_LATE_S = 1.0
"""Seconds by which `advance` may return late: meanwhile no other robot is told anything."""


@dataclass(frozen=True)
class Clause:
    """One thing that a fleet must do.

    Parameters
    ----------
    words : str
        What must hold, as a sentence.
    check : callable
        Returns what it has seen; raises `LackingError` with what the fleet lacks.
    ability : str
        Without this ability the clause does not apply; empty: it always does.
    silences : bool
        Whether a robot must be made silent.
    several : bool
        Whether it needs two robots.
    has_leases : bool
        Whether it needs the room in which leases are tested.
    """

    words: str
    check: Callable[[Stand], str]
    ability: str = ""
    silences: bool = False
    several: bool = False
    has_leases: bool = False


def settings_are_refused(stand: Stand) -> str:
    """Give wrong settings: unknown, missing, of another kind, or a text that leads nowhere."""
    kind, fields = stand.kind, specified(stand.kind.settings)
    given = {f.name: getattr(stand.settings, f.name) for f in fields}
    keys = {f.name: key_of(f) for f in fields}
    right = {keys[name]: value for name, value in given.items()}
    wrong = {"unknown_setting": {**right, "unknown_setting": 1}}
    for f in fields:
        wrong[keys[f.name]] = {**right, keys[f.name]: [[object()]]}
        if required(f):
            wrong[f"{keys[f.name]} (missing)"] = {key: value for key, value in right.items() if key != keys[f.name]}
    for name, settings in wrong.items():
        key = name.partition(" ")[0]
        try:
            kind.checked_settings(settings)
        except MusterError as error:
            if key not in str(error):
                raise LackingError(f"setting {name}: refused by {told(error)!r}, which does not name it") from None
        except Exception as error:
            raise LackingError(f"setting {name}: {told(error)}; expected a MusterError") from error
        else:
            raise LackingError(f"setting {name}: a wrong value is accepted; expected field, value and what is expected")
    texts = [f for f in fields if isinstance(f.metadata["kind"], Text)]
    for f in texts:
        try:
            stand.open(stand.mission, settings=replace(stand.settings, **{f.name: _NONSENSE})).close()
        except MusterError:
            continue
        except Exception as error:
            raise LackingError(f"setting {f.name}={_NONSENSE!r}: {told(error)}; expected a MusterError") from error
    return f"{len(wrong)} wrong settings refused by name"


def claims_are_stable(stand: Stand) -> str:
    """Ask for claims several times: the same texts, and nothing is opened for that."""
    if stand.kind.claims is None:
        return "claimed as a whole: one run at a time"
    before = Resources.now()
    found = [list(stand.kind.claims(stand.settings)) for _ in range(3)]
    if more := before.left_behind(stand.ends_s):
        raise LackingError(f"claims leave behind {more}; expected no side effect: other processes ask for them, too")
    if not found[0] or not all(isinstance(claim, str) and claim for claim in found[0]):
        raise LackingError(f"claims: {found[0]!r}; expected texts, at least one")
    if any(sorted(claims) != sorted(found[0]) for claims in found):
        raise LackingError(f"claims: {found[0]!r}, then {found[-1]!r}; expected the same for the same settings")
    return ", ".join(found[0])


def opens_and_closes(stand: Stand) -> str:
    """Open and close twice; afterwards no thread and no file is left."""
    stand.open(stand.mission).close()  # what is loaded once for all stays
    before = Resources.now()
    for _ in range(2):
        with stand.opened() as trial:
            for robot in trial.robots:
                trial.said(robot)
                if trial.fleet.ports[robot].robot != robot:
                    raise LackingError(f"port {robot}: its robot is {trial.fleet.ports[robot].robot!r}")
    if more := before.left_behind(stand.ends_s):
        raise LackingError(f"left behind after close: {more}")
    return f"three times, with {len(stand.mission.robots)} robots"


def unknown_robots_are_named(stand: Stand) -> str:
    """Open with a robot that does not exist: refused with its id."""
    first = stand.mission.robots[0]
    stranger = Robot(id="no_such_robot", position=first.position, kind=first.kind)
    try:
        fleet = stand.open(replace(stand.mission, robots=(*stand.mission.robots, stranger)))
    except MusterError as error:
        if stranger.id not in str(error):
            raise LackingError(f"robot {stranger.id}: refused by {told(error)!r}, which does not name it") from None
        return told(error)
    except Exception as error:
        raise LackingError(f"robot {stranger.id}: {told(error)}; expected a MusterError that names it") from error
    fleet.close()
    raise LackingError(f"robot {stranger.id}, which does not exist, is accepted; expected a MusterError that names it")


def poses_are_on_the_map(stand: Stand) -> str:
    """Robots report where the mission says that they stand, in metres of the map frame."""
    seen = []
    with stand.opened() as trial:
        for robot in stand.mission.robots:
            said = trial.said(robot.id)
            if len(said.position) != 3 or not all(map(math.isfinite, (*said.position, said.heading, *said.velocity))):
                raise LackingError(
                    f"{robot.id}: {said.position}, {said.heading}, {said.velocity}; expected finite numbers"
                )
            away_m = math.dist(said.position[: len(robot.position)], robot.position)
            if away_m > NEAR_M:
                where = ", ".join(f"{c:.2f}" for c in said.position)
                raise LackingError(
                    f"{robot.id}: at ({where}), {away_m:.2f} m from its place in the mission: map frame?"
                )
            seen.append(f"{robot.id} {away_m:.2f} m off")
    return ", ".join(seen)


def poses_age(stand: Stand) -> str:
    """Reports have the time of the fleet's clock, and new ones come."""
    with stand.opened() as trial:
        first = {robot: trial.said(robot).time_s for robot in trial.robots}
        trial.wait(FRESH_S, lambda: False)
        for robot, time_s in first.items():
            age_s = trial.fleet.time_s - trial.said(robot).time_s
            if trial.said(robot).time_s <= time_s or age_s > FRESH_S:
                raise LackingError(f"{robot}: last report {age_s:.1f} s old; expected a new one within {FRESH_S:g} s")
    return f"reports at most {FRESH_S:g} s old"


def goes_and_arrives(stand: Stand) -> str:
    """Send a robot through two places: it passes both, in order, and says so where it is there."""
    with stand.opened() as trial:
        robot = trial.robots[0]
        begin, there = trial.said(robot), trial.target(robot)
        x, y, z = (0.5 * (a + b) for a, b in zip(begin.position, there, strict=True))
        order = trial.send(robot, (x, y, z), there)
        trial.passes(robot, order, 2, there)
        gone_m, way_m = trial.said(robot).odometry_m - begin.odometry_m, math.dist(begin.position, there)
        if not 0.5 * way_m - NEAR_M <= gone_m <= 2.0 * way_m + NEAR_M:
            raise LackingError(f"{robot}: odometry grew by {gone_m:.2f} m on a way of {way_m:.2f} m")
        return f"{robot} came to {trial.away(robot, there):.2f} m, {gone_m:.2f} m by odometry"


def stays_for_holds(stand: Stand) -> str:
    """Send a robot to a place where it stays: the way point is passed only afterwards."""
    with stand.opened() as trial:
        robot = trial.robots[0]
        there = trial.target(robot)
        order = trial.send(robot, there, hold_s=_HOLD_S)
        trial.takes(robot, order)
        trial.wait(60.0, lambda: trial.away(robot, there) <= NEAR_M or trial.said(robot).passed > 0)
        near_s = trial.said(robot).time_s
        trial.passes(robot, order, 1, there)
        stayed_s = trial.said(robot).time_s - near_s
        if stayed_s < _HOLD_S - 0.2:
            raise LackingError(f"{robot}: passed {stayed_s:.1f} s after it came; expected hold_s={_HOLD_S:g} s")
        return f"{robot} stayed {stayed_s:.1f} s"


def a_changed_order_replaces(stand: Stand) -> str:
    """Send a robot elsewhere while it drives: it goes to the new place alone, and stays there."""
    with stand.opened() as trial:
        robot = trial.robots[0]
        first = trial.target(robot)
        second = trial.other(robot, first)
        trial.send(robot, first)
        trial.starts_moving(robot)
        order = trial.send(robot, second)
        trial.passes(robot, order, 1, second)
        trial.wait(_WATCHED_S, lambda: trial.away(robot, second) > NEAR_M + STILL_M)
        if trial.away(robot, second) > NEAR_M + STILL_M:
            raise LackingError(f"{robot}: left the place of its last order: does it go on with the one before?")
        return f"{robot} turned, and is {trial.away(robot, second):.2f} m from the new place"


def cancel_stops(stand: Stand) -> str:
    """Cancel while a robot drives: it stops."""
    with stand.opened() as trial:
        robot = trial.robots[0]
        trial.send(robot, trial.target(robot))
        trial.starts_moving(robot)
        order = trial.fleet.ports[robot].cancel()
        seen = trial.stops(robot, "cancel")
        trial.takes(robot, order)
        return seen


def stop_stops_all(stand: Stand) -> str:
    """Stop the fleet while robots drive, and close it: all of them stop."""
    with stand.opened() as trial:
        for robot in trial.robots:
            trial.send(robot, trial.target(robot))
        for robot in trial.robots:
            trial.starts_moving(robot)
        trial.fleet.stop()
        return ", ".join([trial.stops(robot, "stop") for robot in trial.robots])


def robots_are_independent(stand: Stand) -> str:
    """Send one robot, and then another one elsewhere: no order reaches another robot."""
    with stand.opened() as trial:
        one, other = trial.robots[:2]
        before, there = trial.said(other), trial.target(one)
        trial.passes(one, trial.send(one, there), 1, there)
        moved_m = math.dist(trial.said(other).position, before.position)
        if moved_m > STILL_M or trial.said(other).order != before.order:
            raise LackingError(f"{other}: moved {moved_m:.2f} m by an order to {one}")
        places = {one: trial.other(one, there), other: trial.target(other)}
        orders = {robot: trial.send(robot, place) for robot, place in places.items()}
        for robot, place in places.items():
            trial.passes(robot, orders[robot], 1, place)
        return f"{one} and {other} went to places of their own"


@contextmanager
def _silencing(stand: Stand) -> Iterator[tuple[Trial, str]]:
    """Open the fleet, and let its first robot answer again at the end, whatever happened."""
    with stand.opened() as trial:
        robot = trial.robots[0]
        trial.said(robot)
        try:
            yield trial, robot
        finally:
            if stand.wake is not None:
                stand.wake(robot)


def _silenced(stand: Stand, trial: Trial, robot: str) -> None:
    """Let a robot be silent for a while, in which it is ordered and cancelled, and let it answer again."""
    assert stand.silence is not None
    stand.silence(robot)
    port = trial.fleet.ports[robot]
    trial.wait(_SILENT_S / 2, lambda: False)
    for act in (lambda: port.send(()), port.cancel, port.telemetry):
        act()
    trial.wait(_SILENT_S / 2, lambda: False)


def a_silent_robot_ages(stand: Stand) -> str:
    """The reports of a silent robot grow old; those of the others do not."""
    with _silencing(stand) as (trial, robot):
        _silenced(stand, trial, robot)
        age_s = trial.fleet.time_s - trial.said(robot).time_s
        if age_s < _SILENT_S - FRESH_S:
            raise LackingError(
                f"{robot}: silent for {_SILENT_S:g} s, but reported {age_s:.1f} s ago: an old pose with a new time?"
            )
        for other in trial.robots[1:]:
            if trial.fleet.time_s - trial.said(other).time_s > FRESH_S:
                raise LackingError(f"{other}: not heard while {robot} is silent")
        return f"the last report of {robot} was {age_s:.1f} s old"


def silence_raises_nothing(stand: Stand) -> str:
    """While a robot is silent no call raises."""
    with _silencing(stand) as (trial, robot):
        try:
            _silenced(stand, trial, robot)
        except LackingError:
            raise
        except Exception as error:
            raise LackingError(f"an error while a robot is silent ends the run for all: {told(error)}") from error
        return "advance, send, cancel and telemetry went on"


def silence_holds_nobody_up(stand: Stand) -> str:
    """While a robot is silent `advance` returns in time."""
    with _silencing(stand) as (trial, robot):
        _silenced(stand, trial, robot)
        if trial.late_s > MOST_LATE_S:
            raise LackingError(f"advance returned {trial.late_s:.1f} s late; expected at most {MOST_LATE_S:g} s")
        return f"advance returned at most {trial.late_s:.2f} s late"


def a_robot_is_heard_again(stand: Stand) -> str:
    """A robot that answers again is heard, and takes orders."""
    with _silencing(stand) as (trial, robot):
        _silenced(stand, trial, robot)
        assert stand.wake is not None
        stand.wake(robot)
        if not trial.wait(10.0, lambda: trial.fleet.time_s - trial.said(robot).time_s < FRESH_S / 2):
            raise LackingError(f"{robot}: not heard within 10 s after it answers again")
        there = trial.target(robot)
        trial.passes(robot, trial.send(robot, there), 1, there)
        return f"{robot} was heard, and went where it was sent"


def a_run_is_resumed(stand: Stand) -> str:
    """Open again where robots are away from their starts: they are where they are, and go on."""
    with stand.opened() as trial:
        robot = trial.robots[0]
        there = trial.target(robot)
        if math.dist(there[:2], stand.mission.robots[0].position[:2]) < NEAR_M:
            trial.passes(robot, trial.send(robot, there), 1, there)
            there = trial.target(robot)
        trial.passes(robot, trial.send(robot, there), 1, there)
        left_at = trial.said(robot).position
    with stand.opened(stand.mission, again=True) as trial:
        moved_m = trial.away(robot, left_at)
        if moved_m > NEAR_M:
            raise LackingError(f"{robot}: {moved_m:.2f} m from where it was left, when opened again")
        back = trial.target(robot)
        trial.passes(robot, trial.send(robot, back), 1, back)
        return f"{robot} was {moved_m:.2f} m from where it was left, and went on"


def charge_is_a_share(stand: Stand) -> str:
    """Robots report their charge as a share."""
    with stand.opened() as trial:
        for robot in trial.robots:
            trial.wait(2.0, lambda: False)
            charge = trial.said(robot).charge
            if charge is None or not 0.0 <= charge <= 1.0:
                raise LackingError(f"{robot}: charge {charge}; expected a share, 0 to 1")
        return ", ".join(f"{robot} {trial.said(robot).charge:.2f}" for robot in trial.robots)


CLAUSES: Mapping[str, Clause] = {
    "settings": Clause("a wrong setting is refused by name", settings_are_refused),
    "claims": Clause("claims are the same each time, and have no side effect", claims_are_stable),
    "opens": Clause("it opens and closes, and leaves nothing behind", opens_and_closes),
    "unknown": Clause("a robot that does not exist is refused by its id", unknown_robots_are_named),
    "poses": Clause("poses are in the map frame", poses_are_on_the_map),
    "times": Clause("reports have the time of the fleet's clock, and new ones come", poses_age),
    "charge": Clause("the charge of a battery is a share", charge_is_a_share, ability=BATTERY),
    "arrives": Clause("a robot goes to its way points, and says so where it is there", goes_and_arrives),
    "stays": Clause("a robot stays at a way point for hold_s", stays_for_holds),
    "replaces": Clause("a changed order replaces the one before", a_changed_order_replaces),
    "cancel": Clause("cancel stops a robot", cancel_stops, ability=HOLDS),
    "stop": Clause("stop stops all robots", stop_stops_all, ability=HOLDS),
    "independent": Clause("an order reaches one robot alone", robots_are_independent, several=True),
    "ages": Clause("reports of a silent robot grow old", a_silent_robot_ages, silences=True),
    "raises": Clause("a silent robot raises no error", silence_raises_nothing, silences=True),
    "prompt": Clause("a silent robot holds nobody up", silence_holds_nobody_up, silences=True),
    "again": Clause("a robot that answers again takes orders", a_robot_is_heard_again, silences=True),
    "restart": Clause("a run goes on from where robots are", a_run_is_resumed, ability=RESUMES),
    "lease": Clause("orders that nobody renews end", orders_age, ability=LEASED, has_leases=True),
}
"""What is tested, in this order, by name."""
