"""The study: which method of avoidance jams least in narrow places, and what planned traffic does there.

By a method alone nothing else keeps robots apart and lets them through: no paths in space and time are planned.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial

from muster.generation import narrow
from muster.generation.narrow import KINEMATICS
from muster.mission.model import Mission
from muster.planning.solve import solve
from muster.running.simulation import carry_out
from muster.state import ExecutionEvent
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.jams.space_time import space_time_s
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.tables import Cell, Table

SCENES: Mapping[str, Callable[[str, int], Mission]] = {
    "face to face, 2": narrow.pair,
    "one-way door, 20": narrow.one_way_door,
    "two-way door, 20": narrow.two_way_door,
    "corridor, 20": narrow.corridor,
    "aisles, 6": narrow.aisles,
    "dead ends, 6": narrow.dead_ends,
    "circle, 50": partial(narrow.circle, apart_m=0.81),
    "streams, 40": narrow.streams,
}
METHODS = ("orca", "rvo", "hrvo")
RESERVE, ALONE = "reserve", "none"
"""Planned traffic; and robots that drive through each other, which is a bound."""
DEFAULT, SPACE_TIME = "auto", "space-time"
"""What Muster chooses; and paths of a yardstick, which nobody drives."""
_CALLED = {ALONE: "alone"}
"""Names of columns that are not those of methods."""
_FIGURES = ("runs", "done %", "s", "out", "jams", "touched")
SEEDS, QUICK_SEEDS = 5, 1
_QUICK_SCENES = ("face to face, 2", "one-way door, 20")
_NOTES = (
    "done: tasks done in all runs, per cent; s: the median of the mission times, with the way back where there is one; "
    "out: robots put out; jams: told as traffic_jam; touched: pairs of robots. Plans by greedy.",
)


@dataclass(frozen=True)
class Job:
    """One run: a scene by its name, kinematics, a method of avoidance or `RESERVE`, and a seed."""

    scene: str
    kinematics: str
    method: str
    seed: int


@dataclass(frozen=True)
class Outcome:
    """What became of one run."""

    tasks: int
    done: int
    out: int
    jams: int
    contacts: int
    mission_time_s: float
    waiting_s: float


def outcome_of(job: Job) -> Outcome:
    """Plan a scene and carry it out."""
    mission = SCENES[job.scene](job.kinematics, job.seed)
    if job.method == SPACE_TIME:
        return _yardstick(mission, job.seed)
    events: list[ExecutionEvent] = []
    plan = solve(mission, "greedy")
    avoidance, traffic = ("auto", job.method) if job.method in (RESERVE, DEFAULT) else (job.method, "free")
    report = carry_out(mission, plan, avoidance=avoidance, traffic=traffic, seed=job.seed, on_event=events.append)
    kinds = [event.kind for event in events]
    return Outcome(
        tasks=len(mission.tasks),
        done=len(report.tasks_done),
        out=kinds.count("robot_stuck"),
        jams=kinds.count("traffic_jam"),
        contacts=report.contacts or 0,
        mission_time_s=report.mission_time_s,
        waiting_s=report.waiting_by_cause_s.get("traffic", 0.0),
    )


def _yardstick(mission: Mission, seed: int) -> Outcome:
    """What space-time A* comes to: all tasks, or none where it finds no paths."""
    time_s, tasks = space_time_s(mission, seed), len(mission.tasks)
    return Outcome(tasks, 0 if time_s is None else tasks, 0, 0, 0, math.inf if time_s is None else time_s, 0.0)


@dataclass(frozen=True)
class Jams:
    """A row for each scene, kinematics and method."""

    number: str = "methods"
    columns: tuple[str, ...] = ("scene", "kinematics", "method", *_FIGURES)

    def jobs(self, effort: Effort) -> Iterator[Job]:
        for scene, kinematics, method in self._rows(effort):
            yield from _runs(scene, kinematics, method, effort)

    def table(self, effort: Effort, found: Mapping[Job, Outcome]) -> Table:
        rows = [
            (
                scene,
                kinematics,
                method,
                *_figures([found[job] for job in _runs(scene, kinematics, method, effort)]).values(),
            )
            for scene, kinematics, method in self._rows(effort)
        ]
        for method in METHODS:
            runs = [outcome for job, outcome in found.items() if job.method == method]
            rows.append(("all", "", method, *_figures(runs).values()))
        return Table(
            self.number, "Methods of avoidance in narrow places", self.columns, tuple(rows), _NOTES, decimals=1
        )

    def _rows(self, effort: Effort) -> Iterator[tuple[str, str, str]]:
        for scene in _QUICK_SCENES if effort.quick else SCENES:
            for kinematics in KINEMATICS:
                for method in METHODS:
                    yield scene, kinematics, method


@dataclass(frozen=True)
class Beside:
    """A row for each scene and kinematics: figures of the first method, and the times of the others."""

    number: str
    title: str
    scenes: tuple[str, ...]
    quick_scenes: tuple[str, ...]
    methods: tuple[str, ...]
    shown: tuple[str, ...]
    """Of `_FIGURES`."""
    notes: tuple[str, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        return "scene", "kinematics", *self.shown, *(f"{_CALLED.get(method, method)} s" for method in self.methods[1:])

    def jobs(self, effort: Effort) -> Iterator[Job]:
        for scene, kinematics in self._rows(effort):
            for method in self.methods:
                yield from _runs(scene, kinematics, method, effort)

    def table(self, effort: Effort, found: Mapping[Job, Outcome]) -> Table:
        rows = []
        for scene, kinematics in self._rows(effort):
            first, *others = (
                _figures([found[job] for job in _runs(scene, kinematics, method, effort)]) for method in self.methods
            )
            rows.append((scene, kinematics, *(first[name] for name in self.shown), *(other["s"] for other in others)))
        return Table(self.number, self.title, self.columns, tuple(rows), (*_NOTES, *self.notes), decimals=1)

    def _rows(self, effort: Effort) -> Iterator[tuple[str, str]]:
        for scene in self.quick_scenes if effort.quick else self.scenes:
            for kinematics in KINEMATICS:
                yield scene, kinematics


RESERVED = Beside(
    number="traffic",
    title="Planned traffic in narrow places",
    scenes=("one-way door, 20", "two-way door, 20", "aisles, 6", "dead ends, 6"),
    quick_scenes=_QUICK_SCENES,
    methods=(RESERVE, ALONE),
    shown=_FIGURES,
    notes=("alone: robots drive through each other.",),
)
"""Scenes with passages for one."""
SWAPPING = Beside(
    number="space-time",
    title="Default settings beside space-time A*",
    scenes=("one-way door, 20", "two-way door, 20", "corridor, 20", "circle, 50", "streams, 40"),
    quick_scenes=_QUICK_SCENES[1:],
    methods=(DEFAULT, RESERVE, SPACE_TIME, ALONE),
    shown=tuple(name for name in _FIGURES if name != "jams"),
    notes=("space-time: prioritised space-time A* over a grid of 0.65 m, at full speed and without turns.",),
)
"""Scenes in which robots have one goal each."""


def _runs(scene: str, kinematics: str, method: str, effort: Effort) -> list[Job]:
    seeds = effort.seeds or (QUICK_SEEDS if effort.quick else SEEDS)
    return [Job(scene, kinematics, method, seed) for seed in range(seeds)]


def _figures(runs: list[Outcome]) -> dict[str, Cell]:
    done = 100 * sum(run.done for run in runs) / sum(run.tasks for run in runs)
    median_s = statistics.median(run.mission_time_s for run in runs)
    counts = (sum(getattr(run, name) for run in runs) for name in ("out", "jams", "contacts"))
    return dict(zip(_FIGURES, (len(runs), done, median_s, *counts), strict=True))


_TABLES: tuple[Reproduction[Job, Outcome], ...] = (Jams(), RESERVED, SWAPPING)

JAMS = Repetition(
    **description("jams"),
    reproductions=_TABLES,
    perform=one_by_one(outcome_of),
    seeds=lambda effort: effort.seeds or (QUICK_SEEDS if effort.quick else SEEDS),
    extras=("map",),
)
