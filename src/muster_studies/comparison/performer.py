"""Makes the runs of a comparison, one at a time, in this process or in one of its own."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from muster.allocation.allocator import Allocator
from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.yaml_writer import yaml_text
from muster_studies.comparison.contestants import Contestant
from muster_studies.comparison.run import FAILED, NOT_APPLICABLE, Run, attempt, figures, stop_of
from muster_studies.comparison.settings import Settings

if TYPE_CHECKING:
    from muster.model.problem import Problem

Trial = tuple[str, str, int]
"""The names of a mission and of an allocator, and a seed."""

_MOST_PROBLEMS = 4
"""Compiled missions that are kept: the runs of a mission follow one another."""
_LONGEST_REASON = 300


@dataclass
class Performer:
    """Makes runs. What is lost in the way to another process is made again there.

    Parameters
    ----------
    missions, contestants
        by name.
    settings
        of all runs.
    """

    missions: Mapping[str, Mission]
    contestants: Mapping[str, Contestant]
    settings: Settings
    _problems: OrderedDict[str, Any] = field(default_factory=OrderedDict, init=False, repr=False)
    _allocators: dict[str, tuple[Allocator, Any]] = field(default_factory=dict, init=False, repr=False)
    _digests: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"_problems": OrderedDict(), "_allocators": {}}

    def blank(self, trial: Trial) -> Run:
        """The row of a trial before it is made: what was asked for."""
        mission, allocator, seed = trial
        settings, values = self.settings, self.contestants[allocator].values
        return Run(
            mission=mission,
            allocator=allocator,
            seed=seed,
            objective=settings.objective or self.missions[mission].rules.objective,
            parameters=" ".join(f"{name}={value}" for name, value in sorted(values.items())),
            time_limit_s=None if settings.time_limit is None else float(settings.time_limit),
            iteration_limit=settings.iterations,
            clock=settings.clock,
            digest=self._digest(mission),
        )

    def lost(self, trial: Trial, reason: str) -> Run:
        """The row of a trial that came to nothing."""
        return replace(self.blank(trial), status=FAILED, reason=reason)

    def __call__(self, trial: Trial) -> Run:
        """Make a run; whatever an allocator raises is the reason of a failed one."""
        row, (mission, name, seed) = self.blank(trial), trial
        try:
            allocator, params = self._allocator(name)
            problem = self._problem(mission)
            unable = _unable(allocator, problem, seed)
            if unable is not None:
                return replace(row, status=NOT_APPLICABLE, reason=unable)
            stop = stop_of(self.settings, allocator)
            made = attempt(problem, allocator, stop, seed, params)
            return replace(row, **figures(made, problem, stop))
        except Exception as error:  # allocators are code of others, which may raise anything
            return replace(row, status=FAILED, reason=_reason(error))

    def _allocator(self, name: str) -> tuple[Allocator, Any]:
        if name not in self._allocators:
            allocator = self.contestants[name].allocator()
            self._allocators[name] = allocator, self.contestants[name].parameters(allocator)
        return self._allocators[name]

    def _problem(self, mission: str) -> Problem:
        from muster.model.problem import Problem

        if mission not in self._problems:
            while len(self._problems) >= _MOST_PROBLEMS:
                self._problems.popitem(last=False)
            self._problems[mission] = Problem.compile(self.missions[mission], self.settings.objective, ()).ready()
        found: Problem = self._problems[mission]
        return found

    def _digest(self, mission: str) -> str:
        if mission not in self._digests:
            self._digests[mission] = _digest(self.missions[mission])
        return self._digests[mission]


def _digest(mission: Mission) -> str:
    """What tells a mission from any other: all that its file holds, and its travel tables."""
    tables = repr(sorted(mission.travel_tables.items()))
    return hashlib.sha256(f"{yaml_text(mission)}{tables}".encode()).hexdigest()[:12]


def _unable(allocator: Allocator, problem: Problem, seed: int) -> str | None:
    """Why an allocator cannot take a mission, where it cannot."""
    try:
        allocator.require_able(problem, seed)
    except MusterError as error:
        return str(error)
    return None


def _reason(error: Exception) -> str:
    said = " ".join(str(error).split())
    text = said if isinstance(error, MusterError) else f"{type(error).__name__}: {said}"
    return text if len(text) <= _LONGEST_REASON else text[: _LONGEST_REASON - 3] + "..."


def trials_of(missions: Sequence[str], allocators: Sequence[str], seeds: Sequence[int]) -> list[Trial]:
    """All runs; those on one mission follow one another, and of those the ones of a seed."""
    return [(mission, allocator, seed) for mission in missions for seed in seeds for allocator in allocators]
