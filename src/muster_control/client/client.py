"""The client of a mission control server: its missions, plans, jobs, runs and records."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.options import options_from
from muster_control.client.connection import Connection
from muster_control.client.handles import RunningJob, RunningRun
from muster_control.client.reading import read
from muster_control.client.resources import Missions, MissionText, Plans, Records, number_of, path_part
from muster_control.client.server_plan import ServerPlan
from muster_control.contract import Action, Job, JobState, Run, World

API = 1
"""The version of the API that this client speaks."""
_TIMEOUT_S = 150.0  # explanations may take two minutes


class Client:
    """A server of mission control.

    Parameters
    ----------
    url
        `http://HOST:PORT`.
    token
        one of the server's tokens; None: none is sent, as on loopback.
    timeout_s
        timeout of one answer, seconds.

    Raises
    ------
    NetworkError
        by every method, if the server cannot be reached.
    NotFoundError, ConflictError, ForbiddenError, BusyError, StoreError, InputError, ParameterError, MusterError
        by every method: the error of the server.
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
        """Versions, worlds and limits of the server.

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
        """The user as the server sees it: name, role, address."""
        found: dict[str, Any] = self._connection.get("/me")
        return found

    def allocators(self) -> list[dict[str, Any]]:
        """The allocators of the server, with their parameters."""
        found: list[dict[str, Any]] = self._connection.get("/allocators")
        return found

    def plan(
        self,
        mission: Mission | MissionText | str | Path,
        *,
        start: int | Plan | None = None,
        fixed: int | Plan | None = None,
        **options: Any,
    ) -> RunningJob:
        """Have a mission planned.

        Parameters
        ----------
        mission
            a mission, or a mission file, which is sent with the files that it names; the id of a mission of the server,
            of which the newest version is planned; or one version of it.
        start, fixed
            plans, or the numbers of plans of the server: a plan to go on from, and a plan whose routes stay as the
            beginnings of the new ones.
        options
            as `muster.planning.options.PlanningOptions` has them: `allocator`, `parameters`, `objective`, `time_limit`,
            `iterations`, `seed`, `ignore`, `bound`, `rewire`, `traffic`.

        Raises
        ------
        ParameterError
            for an unknown option or a value out of range, before anything is sent.
        """
        plain = {name: value for name, value in options.items() if value is not None}
        if not isinstance(options_from(plain).allocator, str):
            raise ParameterError("allocator: a function; expected the name of an allocator of the server")
        there = self._mission(mission)
        address = there.id if isinstance(there, MissionText) else there
        if isinstance(there, MissionText) and there.version:
            plain["version"] = there.version
        for name, plan in (("start", start), ("fixed", fixed)):
            if plan is not None:
                plain[name] = plan if isinstance(plan, int) else self._number(address, plan)
        job = self._connection.post_once(f"/missions/{path_part(address)}/plans", plain)
        return RunningJob(self._connection, read(Job, job))

    def _mission(self, mission: Mission | MissionText | str | Path) -> MissionText | str:
        """A mission as the server has it: sent where it is a mission or a file."""
        if isinstance(mission, str | Path) and (isinstance(mission, Path) or Path(mission).is_file()):
            from muster.planning.loading import load

            mission = load(mission)
        return self.missions.keep(mission) if isinstance(mission, Mission) else mission

    def _number(self, mission: str, plan: Plan) -> int:
        """The number of a plan at the server: sent where the server does not have it."""
        return plan.id if isinstance(plan, ServerPlan) else self.plans.upload(mission, plan).id

    def job(self, job: int) -> RunningJob:
        """A job by its number."""
        return RunningJob(self._connection, read(Job, self._connection.get(f"/jobs/{job}")))

    def jobs(self, state: JobState | None = None, mission: str | None = None, limit: int | None = 200) -> list[Job]:
        """The newest jobs first, at most `limit` (None: all), of one state or mission, if given."""
        found = self._connection.pages("/jobs", limit, state=state, mission=mission)
        return [read(Job, job) for job in found]

    def start(
        self, plan: int | ServerPlan, *, world: World = "kinematic", speed: float | None = 1.0, **settings: Any
    ) -> RunningRun:
        """Have a plan of the server carried out.

        Parameters
        ----------
        plan
            or its number.
        speed
            times real time; None: as fast as possible.
        settings
            `seed`, `dt_s`, `avoidance`, `traffic`, `law`, `noise`, `pose`, `localise`, `unknown`, `explore`;
            of a bridge what it needs.
        """
        body = {"plan": number_of(plan), "world": world, "speed": speed, "settings": settings}
        return RunningRun(self._connection, read(Run, self._connection.post_once("/runs", body)))

    def run(self, run: int) -> RunningRun:
        """A run by its number."""
        return RunningRun(self._connection, read(Run, self._connection.get(f"/runs/{run}")))

    def runs(self) -> list[Run]:
        """All runs, the newest first."""
        return [read(Run, run) for run in self._connection.pages("/runs")]

    def actions(self, run: int | None = None, limit: int | None = 200) -> list[Action]:
        """The audit log, or the actions of one run; the newest first, at most `limit` (None: all)."""
        return [read(Action, action) for action in self._connection.pages("/actions", limit, run=run)]
