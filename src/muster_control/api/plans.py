"""Plans: requested, uploaded, judged, explained, exported and drawn."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Response
from pydantic import Field, WithJsonSchema

from muster.mission.model import OBJECTIVES
from muster.planning.options import BOUNDS, HELP
from muster.traffic.names import TRAFFIC
from muster_control.api.bodies import BoundedRoute
from muster_control.api.dependencies import IdempotencyKey, ThePage, TheServices, TheUser, key_of
from muster_control.api.parameter_types import (
    LARGEST,
    Before,
    Body,
    Count,
    Ignored,
    IgnoredQuery,
    MissionId,
    MissionQuery,
    Name,
    PlanId,
    Seconds,
    Seed,
    TaskQuery,
)
from muster_control.api.responses import (
    PAGED,
    archive_response,
    errors,
    file_described,
    file_response,
    with_location,
)
from muster_control.contract import Job, PlanEntry

router = APIRouter(tags=["plans"], route_class=BoundedRoute)

Objective = Annotated[str, WithJsonSchema({"enum": [*OBJECTIVES]})]
Bound = Annotated[str, WithJsonSchema({"enum": [*BOUNDS]})]
Traffic = Annotated[str, WithJsonSchema({"enum": [*TRAFFIC]})]
ExportTo = Annotated[
    str,
    Query(
        max_length=50,
        description="qgc, geojson, gpx, kml, csv, sol, sheets, overview, xlsx, ics, json, or one of a package.",
    ),
]
PlanNumber = Annotated[int, Field(ge=1, le=LARGEST)]
_PLAN = {"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["gate"]}]}
_PICTURES = {"png": "image/png", "svg": "image/svg+xml"}


class PlanToMake(Body):
    """A planning request; the defaults are those of `muster solve`."""

    allocator: Name | None = Field(default=None, description=HELP["allocator"], examples=["search"])
    parameters: dict[Name, bool | int | float | Name] = Field(
        default={}, max_length=50, description=f"{HELP['parameters']} GET /allocators says which there are."
    )
    objective: Objective | None = Field(default=None, description=HELP["objective"])
    time_limit: Seconds | None = Field(default=None, description=HELP["time_limit"], examples=[1.0])
    iterations: Count | None = Field(default=None, description=HELP["iterations"])
    seed: Seed = Field(default=0, description=HELP["seed"])
    ignore: Ignored = Field(default=[])
    bound: Bound | None = Field(default=None, description=HELP["bound"])
    rewire: bool = Field(default=False, description=HELP["rewire"])
    traffic: Traffic | None = Field(default=None, description=HELP["traffic"])
    start: PlanNumber | None = Field(default=None, description="The id of a plan to go on from.")
    fixed: PlanNumber | None = Field(
        default=None, description="The id of a plan whose routes stay, as the beginnings of the new ones."
    )
    version: int | None = Field(default=None, ge=1, le=LARGEST, description="Of the mission; null: the newest.")


@router.post(
    "/missions/{mission}/plans",
    status_code=202,
    summary="Plan a mission",
    responses=with_location(202, "It is under way; the job says how far it is.") | errors(409),
)
async def ask(
    services: TheServices,
    who: TheUser,
    mission: MissionId,
    response: Response,
    body: PlanToMake,
    idempotency_key: IdempotencyKey = None,
) -> Job:
    """The answer is a job. Follow it by GET /jobs/{id} or its stream; its `result` names the plan."""
    given = body.model_dump(exclude={"version"}, exclude_none=True, exclude_defaults=True)
    request = key_of(who, idempotency_key, f"/missions/{mission}/plans", body)
    job = await services.jobs.ask_plan(who, mission, body.version, request=request, **given)
    response.headers["Location"] = f"/api/v1/jobs/{job.id}"
    return job


@router.post(
    "/missions/{mission}/plans/upload",
    status_code=201,
    summary="Upload a plan",
    responses=with_location(201, "It is kept.") | errors(409),
)
async def upload(
    services: TheServices,
    who: TheUser,
    mission: MissionId,
    response: Response,
    plan: Annotated[dict[str, Any], Field(examples=[_PLAN])],
) -> PlanEntry:
    """The body is a plan file (`muster-plan/1`) of any program."""
    entry = await services.plans.upload(who, mission, plan)
    response.headers["Location"] = f"/api/v1/plans/{entry.id}"
    return entry


@router.get("/plans", summary="List plans", responses=PAGED)
async def plans(
    services: TheServices, page: ThePage, mission: MissionQuery = None, before: Before = None
) -> list[PlanEntry]:
    """Newest first, without routes and histories; `before` the last `id` gives the next ones."""
    return page.of(await services.plans.list(mission, page.rows, before), before=lambda plan: plan.id)


@router.get("/plans/{plan}", summary="Read a plan")
async def plan(services: TheServices, plan: PlanId) -> PlanEntry:
    """Its `plan` is a plan file."""
    return await services.plans.get(plan)


@router.get("/plans/{plan}/verdict", summary="Judge a plan")
async def verdict(
    services: TheServices,
    plan: PlanId,
    ignore: IgnoredQuery = None,
    objective: Annotated[Objective | None, Query(description="That was to be minimised.")] = None,
) -> dict[str, Any]:
    """Whether it is admissible, all figures, who is where when: from scratch, by code that no allocator uses."""
    return dict(await services.plans.verdict(plan, ignore, objective))


@router.get("/plans/{plan}/explain", summary="Say why")
async def explain(
    services: TheServices, plan: PlanId, task: TaskQuery = None, ignore: IgnoredQuery = None
) -> dict[str, Any]:
    """Why tasks are unassigned, or why one task is done by its robot."""
    return dict(await services.plans.explain(plan, task, ignore))


@router.get(
    "/plans/{plan}/export",
    summary="Write a plan for other tools",
    response_class=Response,
    responses=file_described(
        "application/octet-stream", "application/zip", what="The file; a ZIP of several, as of qgc."
    ),
)
async def export(
    services: TheServices,
    plan: PlanId,
    to: ExportTo,
    ignore: IgnoredQuery = None,
    altitude: Annotated[float | None, Query(ge=0, le=1e5, description="Drones fly at least so many m up.")] = None,
    altitude_step: Annotated[
        float | None, Query(ge=0, le=1e4, description="Each drone flies so many m higher than the one before.")
    ] = None,
    altitudes: Annotated[
        list[Annotated[str, Query(max_length=1000)]] | None,  # what a line of HTTP has room for, however it is quoted
        Query(max_length=4, description="Of single drones, in m: r_0=30,r_1=40."),
    ] = None,
    clearance: Annotated[float | None, Query(ge=0, le=1e5, description="Warn of bodies that near, in m.")] = None,
    tolerance: Annotated[float | None, Query(ge=0, le=1e3, description="qgc: bends thinned out, in m.")] = None,
    firmware: Annotated[Literal["px4", "ardupilot"] | None, Query(description="qgc.")] = None,
    per_robot: Annotated[bool | None, Query(description="sheets, ics: a file for each robot.")] = None,
) -> Response:
    """As `muster export` writes it."""
    options: dict[str, Any] = {
        "altitude": altitude,
        "altitude_step": altitude_step,
        "altitudes": altitudes,
        "clearance": clearance,
    }
    options |= {"tolerance": tolerance, "firmware": firmware, "per_robot": per_robot}
    files = await services.plans.export(
        plan, to, {name: value for name, value in options.items() if value is not None}, ignore
    )
    return await archive_response(files, f"plan-{plan}")


@router.get(
    "/plans/{plan}/picture",
    summary="Draw a plan",
    response_class=Response,
    responses=file_described(*_PICTURES.values(), what="The picture."),
)
async def picture(
    services: TheServices,
    plan: PlanId,
    what: Annotated[Literal["routes", "gantt"], Query(description="On the map, or in time.")] = "routes",
    form: Annotated[Literal["png", "svg"], Query(alias="format")] = "svg",
) -> Response:
    """Routes on the map, or the time chart."""
    data = await services.plans.picture(plan, what, form)
    return file_response(data, f"plan-{plan}-{what}.{form}", _PICTURES[form], shown_in_place=True)


@router.get("/plans/{plan}/compare/{other}", summary="Compare two plans")
async def compare(services: TheServices, plan: PlanId, other: PlanId) -> dict[str, Any]:
    """Their figures, and which robot does which task."""
    return dict(await services.plans.compare(plan, other))
