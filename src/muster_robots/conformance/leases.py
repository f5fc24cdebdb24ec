"""The clause of leases: robots go on while their orders are renewed, and stop by themselves where Muster is gone."""

from __future__ import annotations

import math

from muster.motion.kinematics.registry import limits_of
from muster.running.fleet_type import RESUMES
from muster_robots.conformance.stand import FRESH_S, LATENCY_S, NEAR_M, STILL_M, LackingError, Stand
from muster_robots.goal_fleet import LEASE_S

_STANDS_S = 1.0
"""Seconds in which a robot that drives moves: one that stands is given its goal again after a little longer."""
_WATCHED_S = 2.0


def orders_age(stand: Stand) -> str:
    """Send a robot far: it goes on for longer than a lease, and stops within one after Muster is gone.

    Afterwards it takes orders again, by which it comes back.
    """
    with stand.abandoned() as trial:
        robot = trial.robots[0]
        there = trial.lease_target(robot)
        trial.takes(robot, trial.send(robot, there))
        trial.starts_moving(robot)
        begun_s = trial.fleet.time_s
        while trial.fleet.time_s < begun_s + LEASE_S + FRESH_S:
            before, before_s = trial.said(robot).position, trial.fleet.time_s
            trial.wait(_STANDS_S, lambda: False)
            if trial.away(robot, before) < STILL_M:
                raise LackingError(f"{robot}: stopped {before_s - begun_s:.1f} s after its order, which was renewed")
        left_at, limits = trial.said(robot).position, limits_of(stand.mission.robots[0])
    braking_m = limits.braking_m(limits.speed_mps)
    stand.idle(LEASE_S + LATENCY_S + 2 * braking_m / limits.speed_mps)
    with stand.opened(stand.mission if stand.is_declared(RESUMES) else None, again=stand.is_declared(RESUMES)) as trial:
        here = trial.said(robot).position
        trial.wait(_WATCHED_S, lambda: False)
        gone_m, moved_m = math.dist(here, left_at), trial.away(robot, here)
        most_m = limits.speed_mps * (LEASE_S + LATENCY_S) + braking_m + NEAR_M
        if moved_m > STILL_M or gone_m > most_m:
            raise LackingError(
                f"{robot}: {gone_m:.2f} m farther, and {moved_m:.2f} m more, {LEASE_S:g} s after orders were renewed "
                f"last; expected at most {most_m:.2f} m, and that it stands"
            )
        back = trial.start(robot)
        trial.passes(robot, trial.send(robot, back), 1, back)
        return f"{robot} went on while renewed, stopped after {gone_m:.2f} m without, and came back"
