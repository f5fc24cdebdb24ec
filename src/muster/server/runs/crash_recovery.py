"""Recovers a run of real robots from its log after a crash: what was done, and what is left.

A task that may be started at most once (`across_partition`), and was started but did not end in the log, is not started
again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from muster.execution import CompletedTask, CompletedWork
from muster.execution.changes import lying as lying_elsewhere
from muster.mission.doors import Doors
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.mission.plan_reader import plan_from
from muster.report.record.mission_state import MissionState

BARRED = "it was begun before a crash, and may be begun at most once; its end is not known"
_OURS = ("plan", "report", "command", "resumed", "robot_joins")
_OUT = ("robot_fails", "robot_stuck")


@dataclass(frozen=True)
class Recovered:
    """The mission with its changes, the plan in force, and what was done."""

    mission: Mission
    plan: Plan
    past: CompletedWork


def recovered_from(mission: Mission, plan: Plan, log: Sequence[Mapping[str, Any]]) -> Recovered:
    """Recover the state from a log: entries with `time_s`, `kind`, `data`."""
    mission_state = MissionState(mission)
    arrives: dict[str, float] = {}
    starts: dict[str, float] = {}
    done: dict[str, CompletedTask] = {}
    cancelled: dict[str, float] = {}
    delays: dict[str, float] = {}
    used: dict[str, float] = {}
    failed: dict[str, float] = {}
    routes: Mapping[str, Any] | None = None
    for entry in log:
        now, kind, data = float(entry["time_s"]), entry["kind"], entry["data"]
        if kind not in _OURS:
            mission_state.take(kind, data)
        if "used" in data:
            used[data["robot"]] = data["used"]
        if kind == "plan":
            routes = data["plan"]
        elif kind == "arrives":
            arrives[data["task"]] = now
        elif kind == "starts":
            starts[data["task"]] = now
        elif kind == "ends":
            task, robot = data["task"], data["robot"]
            usage = (data["usage"][0], data["usage"][1])
            done[task] = CompletedTask(
                robot=robot,
                arrives_s=arrives.get(task, now),
                starts_s=starts.get(task, now),
                ends_s=now,
                arrival_usage=data["arrival_usage"],
                usage=usage,
                team=tuple(data.get("team", ())),
            )
        elif kind == "cancel_task":
            cancelled[data["task"]] = now
        elif kind == "delay_task":
            delays[data["task"]] = delays.get(data["task"], 0.0) + data["by_s"]
        elif kind in _OUT:
            failed[data["robot"]] = now
        elif kind == "robot_returns":
            failed.pop(data["robot"], None)
    lying = _goods_that_lie(mission_state, done, log)
    once = {name for name, task in mission_state.tasks.items() if task.across_partition == "at-most-once"}
    barred = dict.fromkeys((once & starts.keys()) - done.keys() - cancelled.keys(), BARRED)
    past = CompletedWork(
        done=done,
        cancelled=cancelled,
        delays_s=delays,
        barred=barred,
        used=used,
        failed_s=failed,
        closed=_closed_after(mission, log),
        unloaded_s=_unloaded(log),
        levels=_levels(log),
        lying=lying,
    )
    names = tuple(robot.id for robot in mission.robots)
    tasks = tuple(
        replace(task, only_robots=names) if task.id in barred else task for task in mission_state.tasks.values()
    )
    current = plan if routes is None else _of_those(routes, names)
    return _with_locks_of_barred(Recovered(mission.at_once(tasks=tasks), replace(current, ignored=plan.ignored), past))


def _goods_that_lie(
    mission_state: MissionState, done: dict[str, CompletedTask], log: Sequence[Mapping[str, Any]]
) -> dict[str, Mapping[str, float]]:
    """By task the goods that lie where their robot failed: it is not done any more, and elsewhere."""
    found: dict[str, Mapping[str, float]] = {}
    for entry in log:
        task = entry["data"]["task"] if entry["kind"] == "load_lies" else None
        if task in done and done[task].ends_s <= entry["time_s"]:
            found[task], at = entry["data"]["load"], tuple(entry["data"]["position"])
            mission_state.tasks[task] = lying_elsewhere(mission_state.tasks[task], at, found[task])
            del done[task]
    return found


def _unloaded(log: Sequence[Mapping[str, Any]]) -> list[tuple[float, str]]:
    """When robots unloaded at stations, in order."""
    ends = [entry for entry in log if entry["kind"] == "service_ends" and entry["data"].get("unloaded")]
    return [(float(entry["time_s"]), entry["data"]["robot"]) for entry in ends]


def _levels(log: Sequence[Mapping[str, Any]]) -> dict[str, tuple[float, float]]:
    """By robot the share that its battery last held, as far as the log tells, and its usage then."""
    told = [entry["data"] for entry in log if {"robot", "charge", "used"} <= entry["data"].keys()]
    return {data["robot"]: (data["charge"], data["used"]) for data in told}


def _closed_after(mission: Mission, log: Sequence[Mapping[str, Any]]) -> frozenset[str] | None:
    """The doors that are closed after a log; None where the mission has none."""
    doors = Doors.of(mission)
    for entry in log:
        if entry["kind"] in ("door_closes", "door_opens"):
            doors.take(Event(at_s=0, **{entry["kind"]: entry["data"]["door"]}))
    return doors.closed if doors.known else None


def _with_locks_of_barred(found: Recovered) -> Recovered:
    """Keep the locks of barred tasks if locks are ignored: all other tasks lose theirs, and the rule holds."""
    if "lock" not in found.plan.ignored:
        return found
    tasks = tuple(
        task if task.id in found.past.barred else replace(task, only_robots=None) for task in found.mission.tasks
    )
    others = tuple(rule for rule in found.plan.ignored if rule != "lock")
    return replace(found, mission=replace(found.mission, tasks=tasks), plan=replace(found.plan, ignored=others))


def _of_those(plan: Mapping[str, Any], robots: Sequence[str]) -> Plan:
    """The plan without routes of robots that joined during the run: they join again if they are there."""
    routes = [route for route in plan["routes"] if route["robot"] in robots]
    return plan_from({**plan, "routes": routes}, "the log")
