"""Runs: plans that are carried out, started, watched and controlled."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Response, WebSocket
from pydantic import Field

from muster.running.run_request import SETTING_NAMES
from muster.state.words import words_of
from muster_control.api.bodies import BoundedRoute
from muster_control.api.dependencies import IdempotencyKey, ThePage, TheServices, TheUser, key_of
from muster_control.api.parameter_types import LARGEST, After, Before, Body, MissionQuery, Name, RunId
from muster_control.api.responses import PAGED, errors, with_location
from muster_control.api.sockets import answer, message, tell
from muster_control.contract import MOST_ROWS, OVER, Action, ConflictError, Entry, Run
from muster_control.runs.run_settings import MOST_ORDERS
from muster_control.services.runs import Runs

router = APIRouter(prefix="/runs", tags=["runs"], route_class=BoundedRoute)

Speed = Annotated[float, Field(gt=0, le=1e6)]


class NewRun(Body):
    """A plan to carry out."""

    plan: int = Field(ge=1, le=LARGEST, description="Its id.", examples=[1])
    world: Name = Field(default="kinematic", description="GET /about says which there are.")
    speed: Speed | None = Field(default=1.0, description="Times real time; null: as fast as it goes.")
    settings: dict[Name, Any] = Field(
        default={},
        max_length=50,
        description=f"{', '.join(f'`{name}`' for name in SETTING_NAMES)}; a fleet of real robots has its own besides.",
    )


class ActionToTake(Body):
    """A command to a run."""

    verb: Literal["pause", "resume", "speed", "cancel", "event", "orders"]
    data: dict[Name, Any] = Field(
        default={},
        max_length=50,
        description='Of speed `{"speed": 2.0}`; of event one of a mission file without `at_s`; orders: see /orders.',
        examples=[{"robot_fails": "r_0"}],
    )


class Orders(Body):
    """Tasks that come, are cancelled, moved or delayed: events of a mission file without `at_s`, in order."""

    orders: list[dict[Name, Any]] = Field(
        min_length=1,
        max_length=MOST_ORDERS,
        description="Each `new_task`, `cancel_task`, `move_task` or `delay_task`.",
        examples=[[{"new_task": {"id": "o1", "position": [3, 4], "priority": 5}}]],
    )


@router.post("", status_code=201, summary="Start a run", responses=with_location(201, "It has begun.") | errors(409))
async def start(
    services: TheServices, who: TheUser, response: Response, body: NewRun, idempotency_key: IdempotencyKey = None
) -> Run:
    """A separate process carries out the plan, and continues after a crash of the server."""
    request = key_of(who, idempotency_key, "/runs", body)
    run = await services.runs.start(who, body.plan, body.world, body.speed, body.settings, request=request)
    response.headers["Location"] = f"/api/v1/runs/{run.id}"
    return run


@router.get("", summary="List runs", responses=PAGED)
async def runs(services: TheServices, page: ThePage, mission: MissionQuery = None, before: Before = None) -> list[Run]:
    """Newest first; `before` the last `id` gives the next ones."""
    return page.of(await services.runs.list(page.rows, before, mission), before=lambda run: run.id)


@router.get("/{run}", summary="See how a run is")
async def run(services: TheServices, run: RunId) -> Run:
    """Its state, and when it is over its report."""
    return await services.runs.get(run)


@router.post("/{run}/actions", status_code=202, summary="Act upon a run", responses=errors(409))
async def act(services: TheServices, who: TheUser, run: RunId, body: ActionToTake) -> Action:
    """Pause, resume, change the speed, cancel, or report an event: a new task, a robot that fails or is recalled.

    The stream and GET /actions tell its `outcome`.
    """
    return await services.runs.act(who, run, body.verb, body.data)


@router.post("/{run}/orders", status_code=202, summary="Order tasks", responses=errors(409))
async def order(services: TheServices, who: TheUser, run: RunId, body: Orders) -> Action:
    """Many at once; they are planned for together. The `outcome` says how many did not fit, and why the first."""
    return await services.runs.act(who, run, "orders", {"orders": body.orders})


@router.get("/{run}/events", summary="Read the log of a run", responses=PAGED)
async def events(services: TheServices, page: ThePage, run: RunId, after: After = 0) -> list[Entry]:
    """In order; `after` the last `seq` gives the next ones."""
    return page.of(await services.runs.entries(run, after, page.rows), after=lambda entry: entry.seq)


@router.get("/{run}/report", summary="Read the report of a run", responses=errors(409))
async def report(services: TheServices, run: RunId) -> dict[str, Any]:
    """As `muster simulate --format json` prints it; 409 until the run is over."""
    found = await services.runs.get(run)
    if found.report is None:
        why = "has no report" if found.state in OVER else f"is {found.state}"
        raise ConflictError(f"run {run} {why}; expected one that has ended")
    return dict(found.report)


@router.websocket("/{run}/stream")
async def stream(
    socket: WebSocket, services: TheServices, run: RunId, after: Annotated[int, Query(ge=0, le=LARGEST)] = 0
) -> None:
    """Send what happens; docs/mission-control-api.md describes the messages."""
    subscribers = services.runs.subscribers(run)
    await tell(socket, _past(services.runs, run, after) if subscribers is None else subscribers.watch(after))


@router.websocket("/{run}/orders")
async def take_orders(socket: WebSocket, services: TheServices, who: TheUser, run: RunId) -> None:
    """Take orders, a message each or a list of them; docs/mission-control-api.md describes the answers."""
    await services.runs.require_under_way(run)

    async def take(data: Any) -> Action:
        orders = data if isinstance(data, list) else [data]
        return await services.runs.act(who, run, "orders", {"orders": orders})

    await answer(socket, take)


async def _past(runs: Runs, run: int, after: int) -> AsyncIterator[str]:
    """The messages of a run that is over: its log, and how it ended."""
    found = await runs.get(run)
    yield message("hello", {"run": found, "mission": None, "seq": after})
    while entries := await runs.entries(run, after, MOST_ROWS):
        for entry in entries:
            said = {"seq": entry.seq, "time_s": entry.time_s, "kind": entry.kind, "data": entry.data}
            yield message("entry", said | words_of(entry.kind, entry.data))
        after = entries[-1].seq
    ended = {key: getattr(found, key) for key in ("state", "speed", "time_s", "remark", "share")}
    yield message("run", ended)
