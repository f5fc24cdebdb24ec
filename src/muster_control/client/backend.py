"""The work of the command's verbs, done by a server: missions and plans are sent, results come back."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.mission.errors import Finding, MissionError, MusterError, NetworkError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.system.interrupts import ctrl_c_halts
from muster.planning.export_formats import ExportOptions, Files
from muster.planning.options import OPTIONS
from muster.planning.request import Request
from muster.state.words import DETAIL
from muster_control.client.client import Client
from muster_control.client.handles import RunningJob, RunningRun, report_from
from muster_control.client.resources import MissionText
from muster_control.client.server_plan import ServerPlan
from muster_control.client.uploads import packed_mission
from muster_control.contract import ConflictError, MissionEntry

if TYPE_CHECKING:
    from muster.allocation.stop import Progress, Stop
    from muster.execution import Report
    from muster.planning.explaining import Possible
    from muster.planning.explaining.tables import Explanation
    from muster.planning.solving import Solution
    from muster.running.observed_run import ObservedRun
    from muster.verification import Verdict

_NOTES = "NOTES.txt"
_TOKEN_VARIABLE = "MUSTER_TOKEN"  # noqa: S105 - a name
_LONGEST_TOKEN = 1000
Say = Callable[[str], None]


@contextmanager
def open_server(url: str, token_file: Path | None, say: Say, note: Say) -> Iterator[ServerBackend]:
    """Open a server that speaks this version of the API and takes the token, as a backend."""
    with Client(url, _token_from(token_file)) as client:
        yield ServerBackend(client, client.about()["muster"], say, note)


def _token_from(file: Path | None) -> str | None:
    where = _TOKEN_VARIABLE if file is None else file
    text = os.environ.get(_TOKEN_VARIABLE, "") if file is None else file.read_text(encoding="latin-1")
    token = text.strip()
    right = token.isascii() and token.isprintable() and " " not in token and len(token) <= _LONGEST_TOKEN
    if not right or (not token and file is not None):
        raise ParameterError(f"{where}: no token; expected one line that holds it")
    return token or None


class ServerBackend:
    """What `muster.cli.backend.Backend` asks for, at a server.

    Parameters
    ----------
    version
        version of Muster at the server.
    say, note
        receive messages for the user: important ones, and those of -v.
    """

    def __init__(self, client: Client, version: str, say: Say, note: Say) -> None:
        self._client = client
        self._version = version
        self._say = say
        self._note = note

    def version(self) -> str:
        return self._version

    def missions(self) -> tuple[Sequence[Mapping[str, Any]], Sequence[Mapping[str, str]]]:
        found = self._client.missions.list()
        return [_data(entry) for entry in found], [_row(entry) for entry in found]

    def check(self, mission: Mission, ignore: Sequence[str], time_limit: float) -> Possible:
        from muster.planning.explaining import Possible

        found = self._client.missions.check(*packed_mission(mission), ignore=ignore, time_limit=time_limit)
        if found["errors"]:
            raise MissionError([Finding(**error) for error in found["errors"]])
        return Possible.from_dict(found)

    def plan(self, request: Request, on_progress: Callable[[Progress], None] | None, interrupt: Stop) -> Solution:
        from muster.planning.judging import judged
        from muster.planning.solving import Solution

        there = self._kept(request.mission)
        options = {name: getattr(request, name) for name in OPTIONS} | {"ignore": list(request.ignore)}
        job = self._client.plan(there, start=request.start, fixed=request.fixed, **options)
        plan = awaited(job, on_progress, interrupt, self._say)
        self._note(f"plan {plan.id} of the server, in {plan.elapsed_s or 0.0:.3f} s")
        why = (job.seen.result or {}).get("why", "")
        return Solution(
            plan=plan,
            verdict=judged(request.mission, plan, request.ignore, request.objective),
            why=why,
            interrupted=interrupt.interrupted,
        )

    def kept(self, plan: Plan) -> str | None:
        return f"plan {plan.id} is kept at the server" if isinstance(plan, ServerPlan) else None

    def verify(self, mission: Mission, plan: Plan, ignore: Sequence[str], objective: str | None) -> Verdict:
        return self._client.plans.verdict(self._kept_plan(mission, plan), ignore, objective)

    def explain(
        self, mission: Mission, plan: Plan, task: str | None, ignore: Sequence[str], file: str, time_limit: float
    ) -> Explanation:
        from muster.planning.explaining.tables import Explanation, Table

        found = self._client.plans.explain(self._kept_plan(mission, plan), task, ignore)
        found.pop("words")
        parts = [part if isinstance(part, str) else Table(**part) for part in found.pop("tables")]
        return Explanation(found, parts)

    def export(
        self, mission: Mission, plan: Plan, form: str, ignore: Sequence[str], options: ExportOptions, file: str
    ) -> Files:
        asked = options.given()
        if options.altitudes:
            asked["altitudes"] = [f"{robot}={metres!r}" for robot, metres in options.altitudes.items()]
        return unpacked(*self._client.plans.export(self._kept_plan(mission, plan), form, ignore, **asked))

    def simulate(
        self, mission: Mission, plan: Plan | object, request: ObservedRun, on_line: Callable[[float, str], None] | None
    ) -> tuple[Report, float | None]:
        if not isinstance(plan, Plan):
            raise ParameterError(f"plan: {type(plan).__name__}; expected a Plan for a server")
        settings = request.as_settings()
        if plan.cut_short:
            settings["accept_partial"] = True  # or the verb has refused the plan
        kept = plan if isinstance(plan, ServerPlan) else self._kept_plan(mission, plan)
        with ctrl_c_halts() as halt:  # without an exception, so that every run that is started is known here
            run = self._client.start(kept, world=request.world, speed=request.speed, **settings)
        interrupted = followed(run, on_line, halt.is_set())
        if run.seen.report is None:
            raise MusterError(run.seen.remark or f"run {run.id} {run.seen.state}, without a report")
        if request.record is not None:
            Path(request.record).write_bytes(self._client.records.mcap(run.id))
        return report_from(run.seen.report), run.seen.time_s if interrupted else None

    def _kept(self, mission: Mission) -> MissionText:
        found = self._client.missions.keep(mission, "sent by the command")
        self._note(f"the server has it as mission {found.id}, version {found.version}")
        return found

    def _kept_plan(self, mission: Mission, plan: Plan) -> ServerPlan:
        entry = self._client.plans.upload(self._kept(mission).id, plan)
        self._note(f"the server has it as plan {entry.id}")
        return entry


def _data(entry: MissionEntry) -> dict[str, Any]:
    return asdict(entry) | {"changed_at": entry.changed_at and entry.changed_at.isoformat()}


def _row(entry: MissionEntry) -> dict[str, str]:
    return {
        "mission": entry.id,
        "robots": str(entry.robots),
        "tasks": str(entry.tasks),
        "version": str(entry.version or "-"),
        "changed (UTC)": "-" if entry.changed_at is None else f"{entry.changed_at:%Y-%m-%d %H:%M}",
        "name": entry.name if entry.name != entry.id else "",
    }


def awaited(job: RunningJob, on_progress: Callable[[Progress], None] | None, interrupt: Stop, say: Say) -> ServerPlan:
    """The plan of a job. Interrupted once, the job ends with its best plan; twice, it is cancelled.

    Raises
    ------
    KeyboardInterrupt
        if the job is cancelled; a message says so.
    """
    stopped = False

    def look() -> None:
        nonlocal stopped
        if interrupt.hurried:
            _cancel(job, say)
            raise KeyboardInterrupt
        if interrupt.interrupted and not stopped:
            stopped = True
            _stop(job, say)

    return job.wait(None if on_progress is None else _translated(on_progress), look)


def _translated(on_progress: Callable[[Progress], None]) -> Callable[[Mapping[str, Any]], None]:
    """A function that takes the progress of a job, plain data, and reports it as `Progress`."""
    from muster.allocation.stop import Progress

    def report(seen: Mapping[str, Any]) -> None:
        if seen.get("objective") is not None:
            figures = (seen["elapsed_s"], 0, seen["weight"], seen["objective"])
            on_progress(Progress(*figures, share=seen.get("share"), bound=seen.get("bound")))

    return report


def _stop(job: RunningJob, say: Say) -> None:
    """Ask for the best plan so far; a job that waits for its turn has none."""
    try:
        if job.stop().state == "cancelled":
            say(f"job {job.id} is cancelled at the server: it had not begun")
            raise KeyboardInterrupt
    except ConflictError:
        job.look()  # it has just ended


def _cancel(job: RunningJob, say: Say) -> None:
    try:
        job.cancel()
    except MusterError as error:
        say(f"job {job.id} may go on at the server: {error}")
    else:
        say(f"job {job.id} is cancelled at the server, which keeps no plan of it")


def followed(run: RunningRun, on_line: Callable[[float, str], None] | None, interrupted: bool = False) -> bool:
    """Report the events of a run until it is over; whether Ctrl-C, or the caller, had it cancelled."""
    try:
        if interrupted:
            raise KeyboardInterrupt
        for message in run.stream():
            if on_line is not None and message["type"] == "entry" and message["mark"] != DETAIL:
                on_line(message["time_s"], message["line"])
    except KeyboardInterrupt:
        interrupted = True
        with suppress(ConflictError):  # it has just ended
            run.cancel()
    run.wait()
    return interrupted


def unpacked(name: str, data: bytes) -> Files:
    """The exported files that a server sends, and the messages that come with them.

    Raises
    ------
    NetworkError
        if a file's name leads into another folder.
    """
    files = {name: data}
    if name.endswith(".zip"):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            files = {each: archive.read(each) for each in archive.namelist()}
    notes = files.pop(_NOTES, b"").decode("utf-8", "replace")
    for each in files:
        if Path(each).name != each:
            raise NetworkError(f"the server sends a file {each!r}; expected a name without folders")
    return Files({each: _text_or_bytes(content) for each, content in files.items()}, tuple(notes.splitlines()))


def _text_or_bytes(content: bytes) -> str | bytes:
    """The text that a file holds in UTF-8; the bytes of one that is no text."""
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        return content
