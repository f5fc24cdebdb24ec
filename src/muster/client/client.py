"""A server of mission control: its missions, plans, jobs, runs and records."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from urllib.parse import quote

from muster.client.connection import Connection
from muster.client.handles import RunningJob, RunningRun
from muster.client.reading import read
from muster.exchange.mission_control import Action, Job, JobState, MissionEntry, PlanEntry, Run, World
from muster.mission.errors import NetworkError

API = 1
"""What this client speaks."""
_TIMEOUT_S = 150.0  # explanations may take two minutes


@dataclass(frozen=True, kw_only=True)
class MissionText:
    """A version of a mission; `files` are the sizes, in bytes, of the files that it names."""

    mission: str
    version: int
    text: str
    author: str
    at: datetime | None
    note: str
    files: Mapping[str, int]


class Client:
    """A server.

    Parameters
    ----------
    url
        `http://HOST:PORT`.
    token
        of the server's tokens; None: none is sent, which is right on loopback.
    timeout_s
        how long one answer may take.

    Raises
    ------
    NetworkError
        by every method, if the server cannot be reached.
    NotFoundError, ConflictError, ForbiddenError, BusyError, StoreError, InputError, ParameterError, MusterError
        by every method: what the server raised.
    """

    def __init__(self, url: str, token: str | None = None, timeout_s: float = _TIMEOUT_S) -> None:
        self._url = url
        self._connection = Connection(url, token, timeout_s)
        self.missions = Missions(self._connection)
        self.plans = Plans(self._connection)
        self.records = Records(self._connection)

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *failure: object) -> None:
        self.close()

    def close(self) -> None:
        """End the connection."""
        self._connection.close()

    def about(self) -> dict[str, Any]:
        """What the server is: versions, worlds, limits.

        Raises
        ------
        NetworkError
            if it speaks another version of the API.
        """
        found: dict[str, Any] = self._connection.get("/about")
        if found.get("api") != API:
            spoken = f"{found.get('api')} (Muster {found.get('muster')})"
            raise NetworkError(f"{self._url}: speaks version {spoken} of the API; expected {API}: another release")
        return found

    def me(self) -> dict[str, Any]:
        """Who asks, as the server sees it: name, role, address."""
        found: dict[str, Any] = self._connection.get("/me")
        return found

    def allocators(self) -> list[dict[str, Any]]:
        """Algorithms that plan, with their parameters."""
        found: list[dict[str, Any]] = self._connection.get("/allocators")
        return found

    def plan(self, mission: str | MissionText, **how: Any) -> RunningJob:
        """Have a mission planned.

        Parameters
        ----------
        mission
            its id (its newest version is planned), or one version of it.
        how
            `allocator`, `objective`, `time_limit` (s), `iterations`, `seed`, `ignore`, `bound`, `start` (the id of a
            plan), `parameters` (of the allocator, by name).
        """
        if isinstance(mission, MissionText):
            how |= {"version": mission.version or None}
            mission = mission.mission
        given = {name: value for name, value in how.items() if value is not None}
        return RunningJob(
            self._connection, read(Job, self._connection.post_once(f"/missions/{_in(mission)}/plans", given))
        )

    def job(self, job: int) -> RunningJob:
        """A job that was asked for before."""
        return RunningJob(self._connection, read(Job, self._connection.get(f"/jobs/{job}")))

    def jobs(self, state: JobState | None = None, mission: str | None = None, limit: int = 200) -> list[Job]:
        """Of one state and one mission or of all, newest first."""
        found = self._connection.get("/jobs", state=state, mission=mission, limit=limit)
        return [read(Job, job) for job in found]

    def start(
        self, plan: int | PlanEntry, *, world: World = "kinematic", speed: float | None = 1.0, **settings: Any
    ) -> RunningRun:
        """Have a plan carried out.

        Parameters
        ----------
        plan
            or its id.
        speed
            times real time; None: as fast as it goes.
        settings
            `seed`, `dt_s`, `avoidance`, `noise`; of a bridge what it needs.
        """
        number = plan.id if isinstance(plan, PlanEntry) else plan
        body = {"plan": number, "world": world, "speed": speed, "settings": settings}
        return RunningRun(self._connection, read(Run, self._connection.post_once("/runs", body)))

    def run(self, run: int) -> RunningRun:
        """A run that was started before."""
        return RunningRun(self._connection, read(Run, self._connection.get(f"/runs/{run}")))

    def runs(self) -> list[Run]:
        """Newest first."""
        return [read(Run, run) for run in self._connection.get("/runs")]

    def actions(self, run: int | None = None) -> list[Action]:
        """Who commanded what; newest first."""
        return [read(Action, action) for action in self._connection.get("/actions", run=run)]


class Missions:
    """The missions of a server. Files are those that a mission names, by their names."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(self) -> Sequence[MissionEntry]:
        """Those that ship with Muster, and those made there."""
        return [read(MissionEntry, entry) for entry in self._connection.get("/missions")]

    def get(self, mission: str, version: int | None = None) -> MissionText:
        """The newest version, or another."""
        return read(MissionText, self._connection.get(f"/missions/{_in(mission)}", version=version))

    def file(self, mission: str, name: str) -> bytes:
        """A file that it names."""
        return self._connection.file(f"/missions/{_in(mission)}/files/{_in(name)}")[1]

    def create(self, text: str, files: Mapping[str, bytes] | None = None, name: str | None = None) -> MissionText:
        """Have a mission (YAML) kept."""
        body = {"text": text, "files": _packed(files or {})} | ({} if name is None else {"name": name})
        return read(MissionText, self._connection.post("/missions", body))

    def save(
        self, mission: str, text: str, base_version: int, files: Mapping[str, bytes] | None = None, note: str = ""
    ) -> MissionText:
        """Have a new version kept, made from `base_version`; without `files` they stay.

        Raises
        ------
        ConflictError
            if another has saved one since.
        """
        body = {"text": text, "base_version": base_version, "note": note}
        body |= {} if files is None else {"files": _packed(files)}
        return read(MissionText, self._connection.put(f"/missions/{_in(mission)}", body))

    def check(
        self,
        text: str,
        files: Mapping[str, bytes] | None = None,
        *,
        ignore: Sequence[str] = (),
        time_limit: float | None = None,
    ) -> dict[str, Any]:
        """What is wrong with a mission, and which tasks can never be done; nothing is kept.

        With a `time_limit`, in seconds, also whether one plan can do all of them.
        """
        asked = {"text": text, "files": _packed(files or {}), "ignore": list(ignore), "time_limit": time_limit}
        found: dict[str, Any] = self._connection.post("/missions/check", asked)
        return found

    def delete(self, mission: str) -> None:
        """List it no more."""
        self._connection.delete(f"/missions/{_in(mission)}")


class Plans:
    """The plans of a server."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(self, mission: str | None = None, limit: int = 200, before: int | None = None) -> Sequence[PlanEntry]:
        """Without their routes; of one mission, or of all; newest first, with ids below `before`, if given."""
        found = self._connection.get("/plans", mission=mission, limit=limit, before=before)
        return [read(PlanEntry, entry) for entry in found]

    def get(self, plan: int) -> PlanEntry:
        return read(PlanEntry, self._connection.get(f"/plans/{plan}"))

    def upload(self, mission: str, plan: Mapping[str, Any]) -> PlanEntry:
        """Have a plan kept: what a plan file holds."""
        return read(PlanEntry, self._connection.post(f"/missions/{_in(mission)}/plans/upload", plan))

    def verdict(self, plan: int, ignore: Sequence[str] | None = None, objective: str | None = None) -> dict[str, Any]:
        """What the judge says, some rules ignored; by default those without which the server made the plan."""
        found: dict[str, Any] = self._connection.get(f"/plans/{plan}/verdict", ignore=ignore, objective=objective)
        return found

    def explain(self, plan: int, task: str | None = None, ignore: Sequence[str] | None = None) -> dict[str, Any]:
        """Why tasks are left out; of one task, why this robot does it. `ignore` is as for `verdict`."""
        found: dict[str, Any] = self._connection.get(f"/plans/{plan}/explain", task=task, ignore=ignore)
        return found

    def export(self, plan: int, to: str, ignore: Sequence[str] | None = None, **options: Any) -> tuple[str, bytes]:
        """The name and the bytes of a file for other tools; of qgc with several robots a ZIP."""
        return self._connection.file(f"/plans/{plan}/export", to=to, ignore=ignore, **options)

    def picture(self, plan: int, what: str = "routes", form: str = "svg") -> bytes:
        """Routes on the map, or the time chart (`gantt`); png or svg."""
        return self._connection.file(f"/plans/{plan}/picture", what=what, format=form)[1]


class Records:
    """What happened in the runs of a server that are over."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(self) -> Sequence[Run]:
        """Newest first."""
        return [read(Run, run) for run in self._connection.get("/records")]

    def page(self, run: int) -> str:
        """A page to look at in a browser, offline."""
        return self._connection.file(f"/records/{run}/page.html")[1].decode()

    def mcap(self, run: int) -> bytes:
        """The record, for `muster replay`."""
        return self._connection.file(f"/records/{run}/record.mcap")[1]

    def flown(self, run: int) -> dict[str, Any]:
        """What was flown beside what was planned."""
        found: dict[str, Any] = self._connection.get(f"/records/{run}/flown")
        return found


def _in(part: str) -> str:
    """A part of a path."""
    return quote(part, safe="/")


def _packed(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: b64encode(data).decode("ascii") for name, data in files.items()}
