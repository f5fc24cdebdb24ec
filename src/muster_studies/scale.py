"""Quality against time from 100 to 100,000 tasks: each run is a `muster solve` in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile

from muster.generation.uniform import large_mission
from muster.mission.errors import MusterError
from muster_studies.peers.machine import machine
from muster_studies.tables import Cell, Report, Table

ROBOTS = {100: 5, 1_000: 20, 10_000: 200, 100_000: 2_000}
"""By the number of tasks of a mission."""
ALLOCATORS = ("greedy", "auction", "search")
_END_BY_THEMSELVES = ("greedy", "auction")
_KIB_PER_MB = 1000 if sys.platform != "darwin" else 1_000_000  # as systems count the greatest memory of a process
_COLUMNS = ("allocator", "limit [s]", "tasks done", "objective", "of the best", "CPU [s]", "wall [s]", "over [s]", "MB")
_LEGEND = (
    "Tasks and robots lie at random in a square of 1000 m; nothing limits them, the objective is total+max. Each line "
    "is a process of its own, `muster solve --time-limit --format json`: all is counted, from the start of Python to "
    "the end of the process.",
    "of the best: the objective by the least of those that do all tasks of that size. over: wall time beyond the "
    "limit. MB: the greatest memory. search has a thread for each processor, so its processor time can be above its "
    "wall time. greedy and auction end by themselves: once they have done all tasks there is no longer run.",
)


@dataclass(frozen=True)
class Run:
    """One process: what was asked for, what it came to and what it took."""

    tasks: int
    allocator: str
    limit_s: float
    done: int
    objective: float
    cpu_s: float
    wall_s: float
    memory_mb: float
    load: float

    @property
    def key(self) -> tuple[int, str, float]:
        return self.tasks, self.allocator, self.limit_s


OnRun = Callable[[Run], None]


def scale(
    sizes: Sequence[int], seconds: Sequence[float], kept: Path | None = None, on_run: OnRun | None = None
) -> Report:
    """The tables of these sizes and time limits.

    Parameters
    ----------
    kept
        a file to which each run is added; those that it has are not made again.
    """
    known = {run.key: run for run in _kept(kept)}
    tables = []
    with TemporaryDirectory() as folder:
        for size in sizes:
            own = list(_runs(size, sorted(seconds), known, Path(folder), kept, on_run))
            tables.append(_table(size, own))
            known |= {run.key: run for run in own}
    made = [run for key, run in known.items() if key[0] in sizes]
    loads = [run.load for run in made]
    legend = (*_LEGEND, f"Machine: {machine()}. Load average while it ran: {min(loads):.1f} to {max(loads):.1f}.")
    return Report(
        study="scale",
        document="quality against time from 100 to 100,000 tasks",
        seeds=None,
        runs=len(made),
        cpu_s=sum(run.cpu_s for run in made),
        legend=legend,
        tables=tuple(tables),
    )


def _kept(file: Path | None) -> Iterator[Run]:
    if file is not None and file.is_file():
        for line in file.read_text(encoding="utf-8").splitlines():
            yield Run(**json.loads(line))


def _runs(
    size: int,
    seconds: Sequence[float],
    known: dict[tuple[int, str, float], Run],
    folder: Path,
    kept: Path | None,
    on_run: OnRun | None,
) -> Iterator[Run]:
    """The runs of a size, those that are known and those that are made now."""
    ended: set[str] = set()
    for limit_s, allocator in product(seconds, ALLOCATORS):
        if allocator in ended:
            continue
        run = known.get((size, allocator, limit_s))
        if run is None:
            run = measured(_mission(size, folder), size, allocator, limit_s)
            _keep(run, kept)
            if on_run is not None:
                on_run(run)
        if allocator in _END_BY_THEMSELVES and run.done == size:
            ended.add(allocator)
        yield run


def _mission(size: int, folder: Path) -> Path:
    """The file of a mission, as JSON, which is read faster than YAML."""
    file = folder / f"uniform-{size}.yaml"
    if not file.exists():
        mission = large_mission(size, ROBOTS[size])
        places = {
            group: [{"id": one.id, "position": one.position} for one in ones]
            for group, ones in (("robots", mission.robots), ("tasks", mission.tasks))
        }
        file.write_text(json.dumps({"schema": "muster/1", "name": mission.name, **places}), encoding="utf-8")
    return file


def measured(mission: Path, size: int, allocator: str, limit_s: float) -> Run:
    """One run of `muster solve` in a process of its own.

    Raises
    ------
    MusterError
        if it fails.
    """
    verb = ["solve", str(mission), "-a", allocator, "--time-limit", f"{limit_s:g}", "-q", "--format", "json"]
    begin = time.perf_counter()
    with TemporaryFile("w+", encoding="utf-8") as out:
        process = subprocess.Popen([sys.executable, "-m", "muster.cli", *verb], stdout=out)
        _, status, used = os.wait4(process.pid, 0)
        wall_s = time.perf_counter() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise MusterError(f"muster {' '.join(verb)}: exit code {process.returncode}")
        out.seek(0)
        plan = json.load(out)
    return Run(
        tasks=size,
        allocator=allocator,
        limit_s=limit_s,
        done=plan["tasks_completed"],
        objective=plan["objective"]["value"],
        cpu_s=used.ru_utime + used.ru_stime,
        wall_s=wall_s,
        memory_mb=used.ru_maxrss / _KIB_PER_MB,
        load=os.getloadavg()[0],
    )


def _keep(run: Run, file: Path | None) -> None:
    if file is not None:
        with file.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(asdict(run)) + "\n")


def _table(size: int, runs: Sequence[Run]) -> Table:
    best = min((run.objective for run in runs if run.done == size), default=None)
    order = {name: k for k, name in enumerate(ALLOCATORS)}
    rows = [_row(run, best) for run in sorted(runs, key=lambda run: (order[run.allocator], run.limit_s))]
    return Table(f"{size}", f"{size:,} tasks, {ROBOTS[size]:,} robots", _COLUMNS, tuple(rows))


def _row(run: Run, best: float | None) -> tuple[Cell, ...]:
    share = f"{run.objective / best:.3f}" if best and run.done == run.tasks else None
    over_s = max(0.0, run.wall_s - run.limit_s)
    took = (run.cpu_s, run.wall_s, over_s, round(run.memory_mb))
    return run.allocator, f"{run.limit_s:g}", run.done, run.objective, share, *took
