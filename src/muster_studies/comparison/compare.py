"""The function `compare` of the package."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from operator import index
from pathlib import Path
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.system.platforms import usable_processors
from muster.mission.value_types import shown
from muster_studies.comparison.comparison import Comparison
from muster_studies.comparison.contestants import AllocatorSpec, contestants_of
from muster_studies.comparison.missions import MissionSpec, missions_of
from muster_studies.comparison.performer import Performer, Trial, trials_of
from muster_studies.comparison.results_file import ResultsFile, require_results_place
from muster_studies.comparison.run import Run
from muster_studies.comparison.settings import Settings
from muster_studies.comparison.statistics import require_scipy
from muster_studies.comparison.workers import Lost, in_processes

DEFAULT_SEEDS = 10
_LARGEST_SEED = 2**64 - 1
OnRun = Callable[[Run, int, int], None]
"""Called after each run, with it, the number of runs done and that of all."""


def compare(
    missions: MissionSpec | Iterable[MissionSpec],
    allocators: AllocatorSpec | Iterable[AllocatorSpec] | Mapping[str, AllocatorSpec],
    *,
    seeds: int | Iterable[int] = DEFAULT_SEEDS,
    jobs: int | None = None,
    time_limit: float | None = None,
    iterations: int | None = None,
    objective: str | None = None,
    clock: str = "wall",
    give_up: float | None = None,
    against: str | None = None,
    results: str | Path | None = None,
    on_run: OnRun | None = None,
) -> Comparison:
    """Let allocators plan missions, each run with one thread, and have every plan judged.

    Parameters
    ----------
    missions
        missions, files, patterns of files, folders, shipped names, or families of random missions with their
        parameters, such as `uniform:tasks=40:count=20`.
    allocators
        names, with parameters such as `genetic:population_size=40`; MODULE:NAME; allocators; functions that make routes
        (docs/extending.md). A mapping says what results shall call them.
    seeds
        how many, from 0; or which.
    jobs
        processes; by default one for each processor. With 1, and no `give_up`, all runs are made in this process. In
        others functions of a notebook or script need cloudpickle (extra `compare`).
    time_limit, iterations
        when an allocator stops; 1 s if neither is given. Iterations are those of anytime allocators. The time limit
        also ends one that makes a single pass, such as `greedy` or `auction`, before it has come to all tasks; such
        runs are marked (`Run.cut_short`).
    objective
        instead of the missions' own.
    clock
        `wall`, or `processor`: seconds of processor time, which other programs on the machine do not use up.
    give_up
        seconds after which a run that does not end is ended, with its process.
    against
        an allocator: pairs with it alone are tested.
    results
        a file (.csv) to which each run is added as it comes; runs that it has are not made again.
    on_run
        called after each run that is made.

    Raises
    ------
    ParameterError, InputError, PluginError, MissingExtraError
    """
    pending = begun(
        missions,
        allocators,
        seeds=seeds,
        jobs=jobs,
        settings=Settings(
            time_limit=time_limit, iterations=iterations, clock=clock, objective=objective, give_up=give_up
        ),
        against=against,
        results=results,
    )
    pending.run(on_run)
    return pending.comparison()


def begun(
    missions: MissionSpec | Iterable[MissionSpec],
    allocators: AllocatorSpec | Iterable[AllocatorSpec] | Mapping[str, AllocatorSpec],
    *,
    seeds: int | Iterable[int],
    jobs: int | None,
    settings: Settings,
    against: str | None,
    results: str | Path | None,
) -> Pending:
    """A comparison that is about to be made, as `compare` makes it; all that is wrong is told here."""
    require_scipy()
    contestants = {one.name: one for one in contestants_of(allocators)}
    if against is not None and against not in contestants:
        raise ParameterError(f"against: {shown(against)}; expected one of the allocators: {', '.join(contestants)}")
    which, processes = _seeds(seeds), _jobs(jobs)
    performer = Performer(missions_of(missions), contestants, settings)
    trials = trials_of(list(performer.missions), list(contestants), which)
    return Pending(performer, trials, processes, against, None if results is None else Path(results))


class Pending:
    """A comparison under way: what there is of it can be had at any time."""

    def __init__(
        self, performer: Performer, trials: Sequence[Trial], jobs: int, against: str | None, results: Path | None
    ) -> None:
        self._performer, self._trials, self._jobs, self._against = performer, trials, jobs, against
        self._file: ResultsFile | None = None
        self._runs: dict[Trial, Run] = {}
        if results is not None:
            require_results_place(results)
            self._file = ResultsFile(results)
            self._runs = self._file.known(map(performer.blank, trials))

    @property
    def total(self) -> int:
        """How many runs there will be."""
        return len(self._trials)

    @property
    def made(self) -> int:
        """How many runs there are, those of the file included."""
        return len(self._runs)

    def run(self, on_run: OnRun | None = None) -> None:
        """Make the runs that are missing; each is kept as it comes, also where this is interrupted."""
        missing = [trial for trial in self._trials if trial not in self._runs]
        with self._file or nullcontext():
            for trial, run in self._performed(missing):
                self._runs[trial] = run
                if self._file is not None:
                    self._file.add(run)
                if on_run is not None:
                    on_run(run, self.made, self.total)

    def comparison(self) -> Comparison:
        """What there is of it."""
        return Comparison(
            runs=tuple(self._runs[trial] for trial in self._trials if trial in self._runs),
            allocators=tuple(self._performer.contestants),
            settings=self._performer.settings,
            against=self._against,
            expected=self.total,
        )

    def _performed(self, trials: Sequence[Trial]) -> Iterator[tuple[Trial, Run]]:
        performer, give_up_s = self._performer, self._performer.settings.give_up
        if self._jobs == 1 and give_up_s is None:
            yield from ((trial, performer(trial)) for trial in trials)
            return
        for trial, found in in_processes(performer, trials, self._jobs, give_up_s):
            yield trial, performer.lost(trial, found.reason) if isinstance(found, Lost) else found


def _seeds(given: int | Iterable[int]) -> list[int]:
    count = _whole(given)
    seeds = given if count is None else range(count)
    if isinstance(seeds, str) or not isinstance(seeds, Iterable):
        raise ParameterError(f"seeds: {shown(given)}; expected how many, or which")
    found: dict[int, None] = {}
    for one in seeds:
        seed = _whole(one)
        if seed is None or not 0 <= seed <= _LARGEST_SEED:
            raise _wrong_seeds(one)
        found[seed] = None
    if not found:
        raise _wrong_seeds(given)
    return list(found)


def _wrong_seeds(given: object) -> ParameterError:
    return ParameterError(f"seeds: {shown(given)}; expected a number above 0, or whole numbers from 0 to 2**64 - 1")


def _jobs(given: int | None) -> int:
    jobs = usable_processors() if given is None else _whole(given)
    if jobs is None or jobs < 1:
        raise ParameterError(f"jobs: {shown(given)}; expected a whole number of at least 1")
    return jobs


def _whole(given: Any) -> int | None:
    """A whole number, NumPy's too; None if it is something else."""
    try:
        return None if isinstance(given, bool) else index(given)
    except TypeError:
        return None
