"""The data that the parts of mission control exchange, under the names of the API.

Times of the wall clock are aware datetimes in UTC; times of a mission's clock are seconds (`..._s`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Any, Literal

from muster.mission.errors import MusterError

Role = Literal["watch", "command"]
JobState = Literal["queued", "running", "done", "failed", "cancelled"]
RunState = Literal["starting", "resuming", "running", "paused", "ended", "cancelled", "failed"]
"""`resuming`: the run goes on soon where a crash has stopped it; what it is asked meanwhile waits, in order."""
World = str
"""kinematic, physics, ros1, ros2, mavlink, or a world or fleet of an installed package."""

OVER = ("ended", "cancelled", "failed")
"""States of a run after which nothing more happens in it."""
JOB_OVER = ("done", "failed", "cancelled")
"""States of a job after which nothing more happens in it."""
PAGE_ROWS, MOST_ROWS = 50, 500
"""Rows of one page of a list: by default, and at most."""


class NotFoundError(MusterError):
    """There is no such mission, plan, job, run or record."""


class ConflictError(MusterError):
    """The request conflicts with the present state: a run that has ended, a mission changed by another user."""


class ForbiddenError(MusterError):
    """The user may only watch."""


class BusyError(MusterError):
    """A limit, which the message names, is reached. The request may be repeated later."""


class StoreError(MusterError):
    """The database cannot be read or written: full, read-only, missing; the message says which, and what to do."""


@dataclass(frozen=True)
class User:
    """A user: a name, what they may do, and from which address they ask."""

    name: str
    role: Role
    address: str = ""

    def require_command(self) -> None:
        """Raise ForbiddenError for a user who may only watch."""
        if self.role != "command":
            raise ForbiddenError(f"{self.name} may only watch; expected the role command")


@dataclass(frozen=True, kw_only=True)
class MissionEntry:
    """A mission of the list; `version` is its newest, 0 for a shipped one that nobody has used yet."""

    id: str
    name: str
    shipped: bool
    version: int
    robots: int
    tasks: int
    dimensions: int
    changed_at: datetime | None


@dataclass(frozen=True, kw_only=True)
class MissionVersion:
    """A mission's text as it was at one time, with the files that it names (floor plans, tables) by their names.

    Where it was just made of files of other programs, `ledger` says what became of every element of these.
    """

    mission: str
    version: int
    text: str
    author: str
    at: datetime | None
    note: str = ""
    files: Mapping[str, bytes] = field(default_factory=dict)
    ledger: Mapping[str, Any] | None = None


@dataclass(frozen=True, kw_only=True)
class VersionEntry:
    """A version of a mission in the list of them: who saved it, and when."""

    mission: str
    version: int
    author: str
    at: datetime | None
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class PlanEntry:
    """A plan of one version of a mission; `version` counts the plans of the mission; `plan` is as in a plan file."""

    id: int
    mission: str
    mission_version: int
    version: int
    origin: Literal["planned", "uploaded"]
    author: str
    at: datetime
    plan: Mapping[str, Any]

    @property
    def ignored(self) -> tuple[str, ...]:
        """The rules that were ignored when the server made it; none for an uploaded plan, whatever it states."""
        return tuple(self.plan.get("ignored", ())) if self.origin == "planned" else ()

    @property
    def objective(self) -> str | None:
        """The objective for which the server made it; of an uploaded plan None: the mission's."""
        return (self.plan.get("objective") or {}).get("name") if self.origin == "planned" else None


@dataclass(frozen=True, kw_only=True)
class Job:
    """A job: queued, running, ended.

    Parameters
    ----------
    kind
        `plan` (others may come).
    arguments
        of the request, plain data.
    progress
        the newest: for a plan `elapsed_s`, `share` (0 to 1, or null), `weight`, `objective`, `bound`, and `history`,
        which has [seconds, objective] of each improvement.
    result
        for a plan `{"plan": its id}`.
    error
        one line for the user.
    """

    id: int
    kind: str
    state: JobState
    mission: str
    mission_version: int
    arguments: Mapping[str, Any]
    author: str
    asked_at: datetime
    begun_at: datetime | None = None
    ended_at: datetime | None = None
    progress: Mapping[str, Any] | None = None
    result: Mapping[str, Any] | None = None
    error: str = ""


@dataclass(frozen=True, kw_only=True)
class Run:
    """A plan that is or was carried out.

    Parameters
    ----------
    settings
        `seed`, `dt_s`, `avoidance`, `traffic`, `law`, `noise`, `pose`, `localise`, `unknown`, `explore` of a simulated
        world; of a bridge what it needs (docs/mission-control.md).
    speed
        times real time; null: as fast as possible. Of real robots always 1.
    time_s
        the mission time up to which the log reaches.
    resumed
        how often the run was resumed after a crash.
    remark
        one line for the user: why the run failed, or that it is not recorded.
    report
        as `muster simulate --format json` prints it, after the end.
    share
        which share of going on is done while it is resuming, 0 to 1; else null.
    """

    id: int
    mission: str
    mission_version: int
    plan: int
    world: World
    settings: Mapping[str, Any]
    speed: float | None
    state: RunState
    time_s: float
    author: str
    at: datetime
    ended_at: datetime | None = None
    resumed: int = 0
    remark: str = ""
    report: Mapping[str, Any] | None = None
    share: float | None = None


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One entry of a run's log, which only grows. `seq` counts from 1 within a run.

    Kinds are those of a record's events (docs/records.md), and: `plan` (data: what it changes of the plan before,
    `routes`, `lines`, `left_out`; of the first one `plan`, `lines`), `command` (a user's action took effect; data:
    `action`, its id), `report` (data: the report), `resumed`.
    """

    run: int
    seq: int
    time_s: float
    kind: str
    data: Mapping[str, Any]
    at: datetime | None = None


@dataclass(frozen=True, kw_only=True)
class Tick:
    """The end of what happened at once in a run: its last entry, and where bodies are then, if the world says so."""

    run: int
    seq: int
    bodies: Mapping[str, Any] | None


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """The positions of robots over some time: a packed piece of a run's tracks (`runs.tracks`). `seq` counts from 1."""

    run: int
    seq: int
    from_s: float
    until_s: float
    data: bytes


@dataclass(frozen=True, kw_only=True)
class Checkpoint:
    """The state of a run after an entry of its log: with the entries that follow, all that is needed to go on.

    Parameters
    ----------
    seq
        of the last entry that is in it.
    data
        the mission's state, packed by the runner.
    facts
        `state`, `speed` and `resumed` of the run.
    """

    run: int
    seq: int
    data: bytes
    facts: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class Action:
    """What a user did, for the audit log; of a run also how and when it took effect on the mission's clock.

    Parameters
    ----------
    verb
        `mission.save`, `mission.delete`, `plan.ask`, `plan.upload`, `job.cancel`, `job.stop`, `run.start`, `run.pause`,
        `run.resume`, `run.speed`, `run.cancel`, `run.event`, `login`, `refused`, ...
    outcome
        empty until it is known; `done`, or why the action was refused.
    kept
        whether the database has it. What a run is told while the database is away takes effect, and is kept in the
        server's journal until the database is back.
    """

    id: int
    at: datetime
    who: str
    role: str
    address: str
    verb: str
    data: Mapping[str, Any]
    run: int | None = None
    applied_s: float | None = None
    outcome: str = ""
    kept: bool = True

    def as_kept(self) -> Action:
        """The same action as one that the database has."""
        return replace(self, kept=True)
