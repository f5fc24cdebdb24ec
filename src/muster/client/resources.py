"""The missions, plans and records of a server."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from muster.client.connection import Connection
from muster.client.reading import read
from muster.client.server_plan import ServerPlan
from muster.client.uploads import packed_mission
from muster.exchange.mission_control import MissionEntry, PlanEntry, Run
from muster.mission.model import Mission
from muster.mission.plan import Plan, read_plan

if TYPE_CHECKING:
    from muster.verification import Verdict


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
    """The missions of a server. Files are those that a mission names, by their names."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(self) -> Sequence[MissionEntry]:
        """Those that ship with Muster, and those made there."""
        return [read(MissionEntry, entry) for entry in self._connection.get("/missions")]

    def get(self, mission: str, version: int | None = None) -> MissionText:
        """The newest version, or another."""
        return read(MissionText, self._connection.get(f"/missions/{path_part(mission)}", version=version))

    def file(self, mission: str, name: str) -> bytes:
        """A file that it names."""
        return self._connection.file(f"/missions/{path_part(mission)}/files/{path_part(name)}")[1]

    def create(self, text: str, files: Mapping[str, bytes] | None = None, name: str | None = None) -> MissionText:
        """Have a mission (YAML) kept."""
        body = {"text": text, "files": _packed(files or {})} | ({} if name is None else {"name": name})
        return read(MissionText, self._connection.post("/missions", body))

    def keep(self, mission: Mission, note: str = "") -> MissionText:
        """Have a mission kept with the files that it names, and return the version that the server has of it.

        A mission that is there already is used. A mission of that name that this user saved last gets a new version.
        Otherwise it is a new mission: those of other users stay as they are.
        """
        text, files = packed_mission(mission)
        same_name = [entry.id for entry in self.list() if mission.name in (entry.id, entry.name)]
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
        """Have a new version kept, made from `base_version`; without `files` they stay.

        Raises
        ------
        ConflictError
            if another has saved one since.
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
        """What is wrong with a mission, and which tasks can never be done; nothing is kept.

        With a `time_limit`, in seconds, also whether one plan can do all of them.
        """
        asked = {"text": text, "files": _packed(files or {}), "ignore": list(ignore), "time_limit": time_limit}
        found: dict[str, Any] = self._connection.post("/missions/check", asked)
        return found

    def delete(self, mission: str) -> None:
        """List it no more."""
        self._connection.delete(f"/missions/{path_part(mission)}")


class Plans:
    """The plans of a server; a plan is meant by its number, or by what a method here returned."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def list(self, mission: str | None = None, limit: int = 200, before: int | None = None) -> Sequence[PlanEntry]:
        """Without their routes; of one mission, or of all; newest first, with ids below `before`, if given."""
        found = self._connection.get("/plans", mission=mission, limit=limit, before=before)
        return [read(PlanEntry, entry) for entry in found]

    def get(self, plan: int) -> ServerPlan:
        return ServerPlan.of(self._connection.get(f"/plans/{plan}"))

    def upload(self, mission: str, plan: Plan | str | Path | Mapping[str, Any]) -> ServerPlan:
        """Have a plan of a mission kept: a plan, a plan file, or what it holds."""
        if isinstance(plan, str | Path):
            plan = read_plan(plan)
        data = plan.as_dict() if isinstance(plan, Plan) else plan
        return ServerPlan.of(self._connection.post(f"/missions/{path_part(mission)}/plans/upload", data))

    def verdict(
        self, plan: int | ServerPlan, ignore: Sequence[str] | None = None, objective: str | None = None
    ) -> Verdict:
        """What the judge says, some rules ignored; by default those without which the server made the plan."""
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
        """Routes on the map, or the time chart (`gantt`); png or svg."""
        return self._connection.file(f"/plans/{number_of(plan)}/picture", what=what, format=form)[1]


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


def path_part(part: str) -> str:
    """An id or a name as a part of an address."""
    return quote(part, safe="/")


def _packed(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: b64encode(data).decode("ascii") for name, data in files.items()}


def number_of(plan: int | ServerPlan) -> int:
    """The number of a plan at its server."""
    return plan.id if isinstance(plan, ServerPlan) else plan
