"""A standing fleet under load: part of `muster bench`.

Twenty robots at random places of a field of 60 m x 40 m, 1 m/s fast, take orders for random places, 10 s of work each.
They come at random (Poisson) at the rate that the fleet can carry, and for one minute in twenty at 2 a second. How much
any fleet could do: docs/standing-fleets.md. The same fleet with batteries charges at docks along the walls meanwhile.
"""

from __future__ import annotations

import math
import resource
import time
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from random import Random

import numpy as np

from muster.execution import Standing
from muster.execution.reports.report import Report
from muster.mission.model import Event, Mission, Robot, Rules, Station, Task
from muster.mission.stations import Battery
from muster.planning.solve import solve
from muster.running.simulation import LOOK_S, Simulation
from muster.state.orders import OrdersReport
from muster_studies.benches.measurement import Measurement
from muster_studies.benches.nearest_free import seconds_until_done

ROBOTS, SIZE_M, SPEED_MPS, WORK_S = 20, (60.0, 40.0), 1.0, 10.0
RATE, BURST_RATE = 1.2, 2.0
"""Orders a second: usually, and in a burst."""
BURST_EVERY_S, BURST_AT_S, BURST_S = 1200.0, 300.0, 60.0
HOUR_S, LIVE_S = 3600.0, 600.0
BATTERY_M, RESERVE, CHARGE_PER_S = 300.0, 0.1, 3.0
DOCKS = ((10.0, 0.0), (30.0, 0.0), (50.0, 0.0), (10.0, 40.0), (30.0, 40.0), (50.0, 40.0))
BETA = 0.7124
"""The length of the shortest tour through n random places of an area A is this times sqrt(n A) ([beardwood1959])."""


def fleet(seed: int) -> Mission:
    """Robots without tasks; what counts is how long each order takes."""
    random = Random(seed)
    robots = tuple(
        Robot(id=f"r_{k}", position=_place(random), speed_mps=SPEED_MPS, radius_m=0.25) for k in range(ROBOTS)
    )
    return Mission(name="standing-fleet", robots=robots, tasks=(), rules=Rules(objective="lateness"))


def fleet_that_charges(seed: int) -> Mission:
    """The same robots with batteries, of 45 to 100 % at first, and docks."""
    mission = fleet(seed)
    shares = [0.45 + 0.55 * k / (ROBOTS - 1) for k in range(ROBOTS)]
    Random(seed).shuffle(shares)
    batteries = [Battery(capacity=BATTERY_M, at_start=share, reserve=RESERVE) for share in shares]
    return mission.at_once(
        robots=tuple(replace(robot, battery=one) for robot, one in zip(mission.robots, batteries, strict=True)),
        stations=tuple(
            Station(id=f"dock{k}", position=at, services=("charge",), charge_per_s=CHARGE_PER_S)
            for k, at in enumerate(DOCKS)
        ),
    )


def orders(seed: int, until_s: float, burst_at_s: float = BURST_AT_S) -> Iterator[Event]:
    """Orders until a time, in order of time, with the first burst from a time on."""
    random, now, number = Random(seed + 1), 0.0, 0
    while True:
        now += random.expovariate(BURST_RATE if 0 <= now % BURST_EVERY_S - burst_at_s < BURST_S else RATE)
        if now >= until_s:
            return
        number += 1
        yield Event(at_s=now, new_task=Task(id=f"o{number}", position=_place(random), duration_s=WORK_S))


def most_per_hour(orders_in_all: float) -> float:
    """What twenty robots can do in an hour at most, if the places of so many orders were known from the beginning."""
    way_s = BETA * math.sqrt(SIZE_M[0] * SIZE_M[1] / orders_in_all) / SPEED_MPS
    return 3600 * ROBOTS / (WORK_S + way_s)


@dataclass(frozen=True)
class Shift:
    """What came of a time on duty.

    Parameters
    ----------
    orders
        figures of all orders.
    lost
        tasks that were not done, with reasons.
    cpu_s
        processor time of all of it.
    half_way_mb, end_mb
        the most memory that the process has had until the middle, and until the end.
    report
        of the simulation.
    """

    orders: OrdersReport
    lost: int
    cpu_s: float
    half_way_mb: float
    end_mb: float
    report: Report


def on_duty(
    mission: Mission, seed: int, until_s: float, *, speed: float | None = None, burst_at_s: float = BURST_AT_S
) -> Shift:
    """Let a fleet take orders until a time, and do what is open then; `speed` times real time, None: at once."""
    cpu_s, half_way_mb = time.process_time(), 0.0
    standing = Standing(until_s=until_s, orders=orders(seed, until_s, burst_at_s))
    with closing(Simulation(mission, solve(mission, "greedy"), seed=seed, standing=standing)) as simulation:
        begin = time.monotonic()
        while not simulation.done:
            simulation.advance(simulation.time_s + LOOK_S)
            if speed is not None:
                ahead_s = begin + simulation.time_s / speed - time.monotonic()
                simulation.note_lag(max(0.0, -ahead_s))
                time.sleep(max(0.0, ahead_s))
            if simulation.time_s <= until_s / 2:
                half_way_mb = _memory_mb()
        report = simulation.result()
    assert report.orders is not None
    return Shift(report.orders, report.orders.lost, time.process_time() - cpu_s, half_way_mb, _memory_mb(), report)


def hour(runs: int) -> list[Measurement]:
    """One hour, simulated as fast as it goes; once, however many runs are asked for."""
    shift = on_duty(fleet(0), 0, HOUR_S)
    what = f"an hour of {ROBOTS} robots"
    growth_mb, most = shift.end_mb - shift.half_way_mb, most_per_hour(shift.orders.taken)
    return [
        *_orders(what, shift, most),
        Measurement.once(f"{what}: memory, second half", "MB", growth_mb, "< 5", f"{shift.half_way_mb:.0f} MB before"),
        Measurement.once(f"{what}: processor time", "s", shift.cpu_s, "< 3600"),
    ]


def live(runs: int) -> list[Measurement]:
    """Ten minutes in real time; once, however many runs are asked for."""
    shift = on_duty(fleet(0), 0, LIVE_S, speed=1.0)
    what, lag = f"10 minutes of {ROBOTS} robots", shift.orders.clock_lag
    assert lag is not None
    note = f"median {lag.median_s:.3f} s, 95 % {lag.p95_s:.3f} s"
    return [
        *_orders(what, shift, most_per_hour(shift.orders.taken)),
        Measurement.once(f"{what}: clock behind at most", "s", lag.most_s, "< 0.5", note),
        Measurement.once(f"{what}: processor time", "s", shift.cpu_s, "< 600"),
    ]


def charging(runs: int) -> list[Measurement]:
    """One hour of the fleet that charges, beside what any fleet could do that knows all orders in advance; once."""
    mission = fleet_that_charges(0)
    shift = on_duty(mission, 0, HOUR_S)
    robots = shift.report.robots
    visits, least = sum(row.station_visits for row in robots), min(row.least_charge or 0.0 for row in robots)
    what, most = f"an hour of {ROBOTS} robots that charge", charging_per_hour(mission, [*orders(0, HOUR_S)])
    return [
        *_orders(what, shift, most),
        Measurement.once(f"{what}: of what any fleet could do", "%", 100 * shift.orders.done_per_hour / most, ">= 90"),
        Measurement.once(
            f"{what}: least level", "%", 100 * least, "> 0", f"reserve {100 * RESERVE:.0f} %; {visits} charges"
        ),
        Measurement.once(f"{what}: processor time", "s", shift.cpu_s, "< 3600"),
    ]


def by_nearest_free(runs: int) -> list[Measurement]:
    """The same orders by the rule of `nearest_free`, which plans nothing; once."""
    found = []
    for what, mission, until_s in (
        (f"an hour of {ROBOTS} robots", fleet(0), HOUR_S),
        (f"10 minutes of {ROBOTS} robots", fleet(0), LIVE_S),
        (f"an hour of {ROBOTS} robots that charge", fleet_that_charges(0), HOUR_S),
    ):
        begin_s, came = time.process_time(), list(orders(0, until_s))
        took_s = seconds_until_done(mission, came)
        cpu_s = time.process_time() - begin_s
        ends_s = max(event.at_s + took for event, took in zip(came, took_s, strict=True))
        half_s, most_of_all_s = np.quantile(took_s, [0.5, 0.95]).tolist()
        found += [
            Measurement.once(f"rule, {what}: half done after", "s", half_s, "", f"95 % after {most_of_all_s:.0f} s"),
            Measurement.once(f"rule, {what}: orders done an hour", "", 3600 * len(took_s) / ends_s, ""),
            Measurement.once(f"rule, {what}: an order", "ms", 1000 * cpu_s / len(took_s), "< 3"),
        ]
    return found


def charging_per_hour(mission: Mission, came: Sequence[Event]) -> float:
    """As `most_per_hour`, for robots that charge what they drive beyond what they have at first.

    Nobody does an order before it comes.
    """
    way_m = BETA * math.sqrt(SIZE_M[0] * SIZE_M[1] / len(came))
    batteries = [robot.battery for robot in mission.robots if robot.battery is not None]
    at_first_m = sum(battery.level_at_start - battery.least for battery in batteries)
    times_s = 3600 * ROBOTS + at_first_m / CHARGE_PER_S
    most = times_s / (WORK_S + way_m * (1 / SPEED_MPS + 1 / CHARGE_PER_S))
    return min(most, most_per_hour(len(came)), 3600 * len(came) / (came[-1].at_s + WORK_S))


def _orders(what: str, shift: Shift, most: float) -> list[Measurement]:
    seen = shift.orders
    routed, done = seen.until_in_route, seen.until_done
    return [
        Measurement.once(
            f"{what}: orders lost", "of all", shift.lost + seen.open, "0", f"{seen.taken} came, {seen.done} done"
        ),
        Measurement.once(f"{what}: 95 % in a route after", "s", routed.p95_s, "< 1", f"at most {routed.most_s:.2f} s"),
        Measurement.once(f"{what}: half done after", "s", done.median_s, "", f"95 % after {done.p95_s:.0f} s"),
        Measurement.once(f"{what}: orders done an hour", "", seen.done_per_hour, "", f"any fleet: at most {most:,.0f}"),
    ]


def _memory_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def _place(random: Random) -> tuple[float, float]:
    return random.uniform(0, SIZE_M[0]), random.uniform(0, SIZE_M[1])
