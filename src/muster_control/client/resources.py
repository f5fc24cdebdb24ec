"""The missions, plans and records of a server."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import read_plan
from muster_control.client.connection import Connection
from muster_control.client.reading import read
from muster_control.client.server_plan import ServerPlan
from muster_control.client.uploads import packed_mission
from muster_control.contract import MissionEntry, PlanEntry, Run

if TYPE_CHECKING:
    from muster.verification import Verdict

_LONGEST_SEARCH = 200


@dataclass(frozen=True, kw_only=True)
class MissionText:
    """A version of a mission; `files` are the sizes, in bytes, of the files that it names."""

    id: str
    version: int
    text: str
    author: str
    at: datetime | None
    note: str
    files: Mapping[str, int]


class Missions:
    """The missions of a server. `files` are the files that a mission names, by name."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(self, search: str | None = None) -> Sequence[MissionEntry]:
        """The missions created on the server, last changed first, and the shipped ones; all, or those that are found.

        Parameters
        ----------
        search
            words that all stand in the name or id of a mission.
        """
        return [read(MissionEntry, entry) for entry in self._connection.pages("/missions", search=search)]

    def get(self, mission: str, version: int | None = None) -> MissionText:
        """A version of a mission, by default the newest."""
        return read(MissionText, self._connection.get(f"/missions/{path_part(mission)}", version=version))

    def file(self, mission: str, name: str) -> bytes:
        """A file that a mission names."""
        return self._connection.file(f"/missions/{path_part(mission)}/files/{path_part(name)}")[1]

    def create(self, text: str, files: Mapping[str, bytes] | None = None, name: str | None = None) -> MissionText:
        """Store a new mission (YAML)."""
        body = {"text": text, "files": _packed(files or {})} | ({} if name is None else {"name": name})
        return read(MissionText, self._connection.post("/missions", body))

    def keep(self, mission: Mission, note: str = "") -> MissionText:
        """Store a mission with the files that it names; returns the version on the server.

        A mission that the server has already is used. A mission of that name that this user saved last gets a new
        version. Otherwise it is a new mission: those of other users are not changed.
        """
        text, files = packed_mission(mission)
        same_name = [
            entry.id
            for entry in self.list(search=" ".join(mission.name.split())[:_LONGEST_SEARCH])
            if mission.name in (entry.id, entry.name)
        ]
        there = [self.get(mission_id) for mission_id in same_name]
        found = next((old for old in there if old.text == text and self._has_files(old, files)), None)
        if found is not None:
            return found
        me = self._connection.get("/me")["name"]
        ours = next((old for old in there if old.author == me), None)
        return self.create(text, files) if ours is None else self.save(ours.id, text, ours.version, files, note)

    def _has_files(self, old: MissionText, files: Mapping[str, bytes]) -> bool:
        if dict(old.files) != {name: len(data) for name, data in files.items()}:
            return False
        return all(self.file(old.id, name) == data for name, data in files.items())

    def save(
        self, mission: str, text: str, base_version: int, files: Mapping[str, bytes] | None = None, note: str = ""
    ) -> MissionText:
        """Store a new version, made from `base_version`; without `files` the files stay.

        Raises
        ------
        ConflictError
            if another version was saved since.
        """
        body = {"text": text, "base_version": base_version, "note": note}
        body |= {} if files is None else {"files": _packed(files)}
        return read(MissionText, self._connection.put(f"/missions/{path_part(mission)}", body))

    def check(
        self,
        text: str,
        files: Mapping[str, bytes] | None = None,
        *,
        ignore: Sequence[str] = (),
        time_limit: float | None = None,
    ) -> dict[str, Any]:
        """What is wrong with a mission, and which tasks can never be done; nothing is stored.

        With a `time_limit`, in seconds, also whether one plan can do all of them.
        """
        asked = {"text": text, "files": _packed(files or {}), "ignore": list(ignore), "time_limit": time_limit}
        found: dict[str, Any] = self._connection.post("/missions/check", asked)
        return found

    def delete(self, mission: str) -> None:
        """Remove a mission from the list."""
        self._connection.delete(f"/missions/{path_part(mission)}")


class Plans:
    """The plans of a server; each is named by its number or a `ServerPlan`."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(
        self, mission: str | None = None, limit: int | None = 200, before: int | None = None
    ) -> Sequence[PlanEntry]:
        """Plans without routes, the newest first: of one mission or of all, with ids below `before`, if given.

        At most `limit`; None: all.
        """
        found = self._connection.pages("/plans", limit, mission=mission, before=before)
        return [read(PlanEntry, entry) for entry in found]

    def get(self, plan: int) -> ServerPlan:
        return ServerPlan.of(self._connection.get(f"/plans/{plan}"))

    def upload(self, mission: str, plan: Plan | str | Path | Mapping[str, Any]) -> ServerPlan:
        """Store a plan of a mission: a plan, a plan file, or its content."""
        if isinstance(plan, str | Path):
            plan = read_plan(plan)
        data = plan.as_dict() if isinstance(plan, Plan) else plan
        return ServerPlan.of(self._connection.post(f"/missions/{path_part(mission)}/plans/upload", data))

    def verdict(
        self, plan: int | ServerPlan, ignore: Sequence[str] | None = None, objective: str | None = None
    ) -> Verdict:
        """The verdict with some rules ignored; by default those that were ignored when the server made the plan."""
        from muster.verification import Verdict

        path = f"/plans/{number_of(plan)}/verdict"
        return read(Verdict, self._connection.get(path, ignore=ignore, objective=objective))

    def explain(
        self, plan: int | ServerPlan, task: str | None = None, ignore: Sequence[str] | None = None
    ) -> dict[str, Any]:
        """Why tasks are left out; of one task, why this robot does it. `ignore` is as for `verdict`."""
        found: dict[str, Any] = self._connection.get(f"/plans/{number_of(plan)}/explain", task=task, ignore=ignore)
        return found

    def export(
        self, plan: int | ServerPlan, to: str, ignore: Sequence[str] | None = None, **options: Any
    ) -> tuple[str, bytes]:
        """The name and the bytes of a file for other tools; of qgc with several robots a ZIP."""
        return self._connection.file(f"/plans/{number_of(plan)}/export", to=to, ignore=ignore, **options)

    def picture(self, plan: int | ServerPlan, what: str = "routes", form: str = "svg") -> bytes:
        """The routes on the map, or the time chart (`gantt`), as png or svg."""
        return self._connection.file(f"/plans/{number_of(plan)}/picture", what=what, format=form)[1]


class Records:
    """The records of the runs of a server that have ended."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(self) -> Sequence[Run]:
        """The runs that have ended, the newest first."""
        return [read(Run, run) for run in self._connection.pages("/records")]

    def page(self, run: int) -> str:
        """A page for a browser, which needs no network."""
        return self._connection.file(f"/records/{run}/page.html")[1].decode()

    def mcap(self, run: int) -> bytes:
        """The record, for `muster replay`."""
        return self._connection.file(f"/records/{run}/record.mcap")[1]

    def flown(self, run: int) -> dict[str, Any]:
        """The planned and the measured figures."""
        found: dict[str, Any] = self._connection.get(f"/records/{run}/flown")
        return found


def path_part(part: str) -> str:
    """An id or a name as a part of an address."""
    return quote(part, safe="/")


def _packed(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: b64encode(data).decode("ascii") for name, data in files.items()}


def number_of(plan: int | ServerPlan) -> int:
    """The number of a plan at its server."""
    return plan.id if isinstance(plan, ServerPlan) else plan
