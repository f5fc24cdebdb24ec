"""The runs of the study: a plan of the market, or one carried out undisturbed, with noise, or with a failing robot."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from muster.execution.record import NoObserver
from muster.execution.reports.report import Report
from muster.mission.model import Event, Mission
from muster.motion.grid import Floats
from muster.motion.port import Telemetry
from muster.running.simulation import carry_out
from muster.simulation import NO_NOISE, Noise
from muster.verification import Visit
from muster_studies.effort import QUICK_SEEDS, Effort
from muster_studies.rescue.teams import mission_of, plan_of, verdict_of
from muster_studies.runs import Case, Outcome, perform

REPETITIONS = 5
"""As the paper repeats its experiment."""

NOISE = Noise(velocity=0.05, slip=0.02, odometry=0.01, position_m=0.002, heading_rad=0.01)
"""Ours: the paper states none."""


def repetitions(effort: Effort) -> int:
    """How often what is random is repeated, with seeds from 0; and at how many moments a robot fails."""
    return effort.seeds or (QUICK_SEEDS if effort.quick else REPETITIONS)


@dataclass(frozen=True)
class Planning:
    """The market once."""

    case: Case
    seed: int

    def perform(self) -> Outcome:
        return perform(self.case, self.seed)


@dataclass(frozen=True, kw_only=True)
class FlightResult:
    """What one carrying out was.

    Parameters
    ----------
    times, positions
        (t,) seconds and (t, n, 2) metres, true ones, robots in order of the mission.
    last_words
        by robot the last that it said.
    visits
        by robot the tasks that it did, in order; `arrival_usage` is its time on the way and at work until then.
    moved
        how many tasks went to another robot, over all times that the rest was planned again.
    planning_s
        processor time of planning the rest again, in all.
    """

    report: Report
    times: Floats
    positions: Floats
    last_words: Mapping[str, Telemetry]
    visits: Mapping[str, tuple[Visit, ...]]
    moved: int
    planning_s: float


@dataclass(frozen=True, kw_only=True)
class Flight:
    """A plan carried out in the kinematic world.

    Parameters
    ----------
    team
        see `teams.mission_of`.
    iterations
        of the market that plans.
    seed
        of the noise; None without noise.
    fails, share
        a robot that fails when this share is over of the time that the plan has it busy for.
    """

    team: str
    iterations: int
    seed: int | None = None
    fails: str | None = None
    share: float = 0.0

    @cached_property
    def mission(self) -> Mission:
        mission = mission_of(self.team)
        if self.fails is None:
            return mission
        (route,) = (route for route in verdict_of(self.team, self.iterations).routes if route.robot == self.fails)
        return replace(mission, events=(Event(at_s=self.share * route.visits[-1].ends_s, robot_fails=self.fails),))

    def perform(self) -> FlightResult:
        log = Log(self.mission)
        report = carry_out(
            self.mission,
            plan_of(self.team, self.iterations),
            seed=self.seed or 0,
            noise=NO_NOISE if self.seed is None else NOISE,
            pose="true",
            avoidance="orca",
            recorder=log,
        )
        return log.flown(report)


@dataclass
class Log(NoObserver):
    """Keeps what happens: an `execution.Recorder`."""

    mission: Mission
    times: list[float] = field(default_factory=list)
    positions: list[Floats] = field(default_factory=list)
    last_words: dict[str, Telemetry] = field(default_factory=dict)
    moments: dict[tuple[str, str, str], float] = field(default_factory=dict)
    """Of the last event of a kind, robot and task."""
    moved: int = 0
    planning_s: float = 0.0
    _heard_cpu_s: float = 0.0

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        if kind == "replanned":  # told as soon as it is done; what asked for it was told just before
            self.planning_s += time.process_time() - self._heard_cpu_s
            self.moved += len(data["moved"])
        elif "robot" in data and "task" in data:
            self.moments[kind, data["robot"], data["task"]] = now
        self._heard_cpu_s = time.process_time()

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        self.last_words[robot] = telemetry

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        self.times.append(now)
        self.positions.append(positions[:, :2])

    def flown(self, report: Report) -> FlightResult:
        return FlightResult(
            report=report,
            times=np.array(self.times),
            positions=np.array(self.positions),
            last_words=self.last_words,
            visits={robot.id: self._visits(robot.id) for robot in self.mission.robots},
            moved=self.moved,
            planning_s=self.planning_s,
        )

    def _visits(self, robot: str) -> tuple[Visit, ...]:
        done, used = [], 0.0
        for (kind, who, task), ends in self.moments.items():
            if (kind, who) == ("ends", robot):
                leaves, arrives, starts = (self.moments[k, robot, task] for k in ("sets_out", "arrives", "starts"))
                used += arrives - leaves
                done.append(Visit(task, arrives, starts, ends, used))
                used += ends - starts
        return tuple(done)
