"""Records: runs that are over, replayed, exported and compared with their plans."""

from __future__ import annotations

from typing import Any, Literal

from fastapi import APIRouter, Response

from muster_control.api.bodies import BoundedRoute
from muster_control.api.dependencies import ThePage, TheServices
from muster_control.api.parameter_types import Before, MissionQuery, RunId
from muster_control.api.responses import PAGED, archive_response, errors, file_described, file_response
from muster_control.contract import Run

router = APIRouter(prefix="/records", tags=["records"], route_class=BoundedRoute)

ExportTo = Literal["csv", "geojson", "gpx", "kml", "json"]


@router.get("", summary="List records", responses=PAGED)
async def records(
    services: TheServices, page: ThePage, mission: MissionQuery = None, before: Before = None
) -> list[Run]:
    """Runs that are over, newest first; `before` the last `id` gives the next ones."""
    return page.of(await services.runs.over(page.rows, before, mission), before=lambda run: run.id)


@router.get(
    "/{run}/page.html",
    summary="Replay a record",
    response_class=Response,
    responses=file_described("text/html", what="A page that needs nothing but itself.") | errors(409),
)
async def page(services: TheServices, run: RunId) -> Response:
    """The page that `muster replay --html` writes."""
    html = await services.records.page(run)
    return file_response(html.encode(), f"run-{run}.html", "text/html; charset=utf-8", shown_in_place=True)


@router.get(
    "/{run}/record.mcap",
    summary="Take a record away",
    response_class=Response,
    responses=file_described("application/octet-stream", what="An MCAP file, for `muster replay` and Foxglove.")
    | errors(409),
)
async def mcap(services: TheServices, run: RunId) -> Response:
    """The record in the format of docs/records.md."""
    return file_response(await services.records.mcap(run), f"run-{run}.mcap", "application/octet-stream")


@router.get("/{run}/flown", summary="Compare what was planned and flown", responses=errors(409))
async def flown(services: TheServices, run: RunId) -> dict[str, Any]:
    """In all, per robot and per task."""
    return dict(await services.records.flown(run))


@router.get(
    "/{run}/export",
    summary="Write a record for other tools",
    response_class=Response,
    responses=file_described("application/octet-stream", "application/zip", what="The file, or a ZIP of several.")
    | errors(409),
)
async def export(services: TheServices, run: RunId, to: ExportTo) -> Response:
    """Tracks and events for spreadsheets and maps."""
    return await archive_response(await services.records.export(run, to), f"run-{run}")
