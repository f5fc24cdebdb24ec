"""Jobs: planning requests, followed, stopped and cancelled."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Query, WebSocket

from muster_control.api.bodies import BoundedRoute
from muster_control.api.dependencies import ThePage, TheServices, TheUser
from muster_control.api.parameter_types import Before, JobId, MissionQuery
from muster_control.api.responses import PAGED, errors
from muster_control.api.sockets import message, tell
from muster_control.contract import Job, JobState
from muster_control.services.jobs import Jobs

router = APIRouter(prefix="/jobs", tags=["jobs"], route_class=BoundedRoute)


@router.get("", summary="List jobs", responses=PAGED)
async def jobs(
    services: TheServices,
    page: ThePage,
    state: Annotated[JobState | None, Query(description="Only those.")] = None,
    mission: MissionQuery = None,
    before: Before = None,
) -> list[Job]:
    """Newest first; `before` the last `id` gives the next ones."""
    return page.of(await services.jobs.list(state, mission, page.rows, before), before=lambda job: job.id)


@router.get("/{job}", summary="See how far a job is")
async def job(services: TheServices, job: JobId) -> Job:
    """Its state and `progress`; when it is over its `result` or its `error`."""
    return await services.jobs.get(job)


@router.delete("/{job}", summary="Cancel a job", responses=errors(409))
async def cancel(services: TheServices, who: TheUser, job: JobId) -> Job:
    """Its process ends at once."""
    return await services.jobs.cancel(who, job)


@router.post("/{job}/stop", status_code=202, summary="Stop a job with what it has", responses=errors(409))
async def stop(services: TheServices, who: TheUser, job: JobId) -> Job:
    """A running job ends with the best plan so far, or the first one; a queued job is cancelled.

    A second request also leaves out the reasons for unassigned tasks.
    """
    return await services.jobs.stop(who, job)


@router.websocket("/{job}/stream")
async def stream(socket: WebSocket, services: TheServices, job: JobId) -> None:
    """Send the job as `{"type": "job", ...}` now and after each change, until it is over."""
    await tell(socket, _changes(services.jobs, job))


async def _changes(jobs: Jobs, job: int) -> AsyncIterator[str]:
    last = message("job", await jobs.get(job))
    yield last
    async for each in jobs.follow(job):
        text = message("job", each)
        if text != last:
            yield text
        last = text
