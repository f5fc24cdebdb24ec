"""What became of robots that carried a mission out without a centre: processes, links, and what they refused."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class EndReport:
    """The end of a robot's process, seen at `at_s`, and its cause."""

    robot: str
    at_s: float
    why: str


@dataclass(frozen=True, kw_only=True)
class SilenceReport:
    """A time in which a robot's process ran and was silent, and why; `until_s` None: until the end."""

    robot: str
    from_s: float
    until_s: float | None
    why: str


@dataclass(frozen=True, kw_only=True)
class SplitReport:
    """A time in which robots counted each other as members in these groups alone; `until_s` None: until the end."""

    groups: tuple[tuple[str, ...], ...]
    from_s: float
    until_s: float | None


@dataclass(frozen=True, kw_only=True)
class RefusedStatements:
    """How many statements of a sender a robot refused for a reason."""

    robot: str
    sender: str
    reason: str
    count: int


@dataclass(frozen=True, kw_only=True)
class RefusedOrder:
    """An order that does not count, the robot to which it was given, and the reason.

    `task` is empty where that robot refused the order at once; the reason names it.
    """

    robot: str
    task: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class TeamReport:
    """What became of the processes of a team. Times are those of the mission, in seconds.

    Tasks that several robots began or did are in `Report.done_twice`.

    Parameters
    ----------
    ended
        Processes that ended before the mission did, in order of time.
    silent
        Times in which a process ran and was silent: its radio was off, or it did not answer.
    splits
        Times in which robots that had met did not count each other as members.
    refused_statements
        Statements of robots that others refused.
    refused_orders
        Orders of operators that do not count.
    """

    ended: tuple[EndReport, ...] = ()
    silent: tuple[SilenceReport, ...] = ()
    splits: tuple[SplitReport, ...] = ()
    refused_statements: tuple[RefusedStatements, ...] = ()
    refused_orders: tuple[RefusedOrder, ...] = ()
