"""Missions: listed, read, created, changed and checked; every change is a new version."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from datetime import datetime
from typing import Annotated, Any

from fastapi import APIRouter, Depends, File, Form, Header, HTTPException, Query, Request, Response, UploadFile
from pydantic import Field

from muster_control.api.bodies import BoundedRoute
from muster_control.api.dependencies import ThePage, TheServices, TheUser, require_known_form
from muster_control.api.parameter_types import (
    LARGEST,
    AfterMission,
    BeforeVersion,
    Body,
    FileName,
    Files,
    Ignored,
    MissionId,
    Name,
    Note,
    OptionalVersion,
    Search,
    Text,
    VersionNumber,
)
from muster_control.api.responses import (
    PAGED,
    Responses,
    errors,
    file_described,
    file_response,
    with_location,
)
from muster_control.contract import MissionEntry, MissionVersion, NotFoundError, VersionEntry
from muster_control.services.missions import place_of
from muster_control.services.uploads import answers_of

router = APIRouter(prefix="/missions", tags=["missions"], route_class=BoundedRoute)

_EXAMPLE = """schema: muster/1
name: yard
robots: [{id: r_0, position: [0, 0]}]
tasks: [{id: gate, position: [4, 3]}]
"""
_Kind = Annotated[str, Field(max_length=400)]
_KINDS = "What features of a site are, as NAME=KIND: a file, layer or feature, and task, robot, air, zone, survey, ..."
_WITH_ETAG: Responses = {200: {"headers": {"ETag": {"description": "Its version.", "schema": {"type": "string"}}}}}
_IfMatch = Annotated[
    str | None, Header(max_length=100, pattern=r'^"[0-9]{1,9}"$', description="The ETag of the version it is based on.")
]
_BasedOn = Annotated[int | None, Query(ge=0, le=LARGEST, description="Instead of If-Match.")]


@dataclass(frozen=True, kw_only=True)
class MissionText:
    """A version of a mission; `files` are the sizes, in bytes, of the files that it names.

    In the answer to an upload of files that were converted, `ledger` says what became of every element of these: read,
    passed over, or refused.
    """

    id: str
    version: int
    text: str
    author: str
    at: datetime | None
    note: str
    files: Mapping[str, int]
    ledger: Mapping[str, Any] | None = None


@dataclass(frozen=True, kw_only=True)
class Checked:
    """What is wrong with a mission, which tasks can never be done, and its size (null if it cannot be read).

    `conflict` are tasks that no single plan can do together; `unknown` is true if that was not checked or not decided.
    `shortfalls` prove that the work of the tasks is too much for the robots; `remedies` are the least changes of the
    mission that lift them all.
    `unseen` are raster searches of which robots that may do them do not see all.
    `blocked` are robots that cannot get past each other, and lanes that do not lead where robots must go.
    `cut_off` are stations to which no robot has a way.
    `floor` is the image of the mission's map, one of its files, with its resolution and origin.
    """

    errors: list[dict[str, Any]]
    impossible: list[dict[str, Any]]
    conflict: dict[str, Any] | None
    unknown: bool
    shortfalls: list[dict[str, Any]]
    remedies: list[dict[str, Any]]
    unseen: list[dict[str, Any]]
    blocked: list[dict[str, Any]]
    cut_off: list[dict[str, Any]]
    summary: dict[str, Any] | None
    mission: dict[str, Any] | None
    floor: dict[str, Any] | None


class NewMission(Body):
    """A new mission."""

    text: Text = Field(examples=[_EXAMPLE])
    files: Files = Field(default={}, examples=[{}])
    name: Name | None = Field(default=None, description="Instead of the mission's own.")


class ChangedMission(Body):
    """A new version of a mission."""

    text: Text = Field(examples=[_EXAMPLE])
    files: Files | None = Field(default=None, description="All files that it names; null: as they are.")
    base_version: int | None = Field(default=None, ge=0, le=LARGEST, description="Instead of If-Match.")
    note: Note = ""


class MissionToCheck(Body):
    """A mission to check; it is not stored."""

    text: str = Field(examples=[_EXAMPLE])
    files: Files = Field(default={}, examples=[{}])
    ignore: Ignored = Field(default=[])
    time_limit: float | None = Field(
        default=None, ge=0, le=10, description="Seconds for finding out whether one plan can do all tasks."
    )


@router.get("", summary="List missions", responses=PAGED)
async def missions(
    services: TheServices, page: ThePage, search: Search = "", after: AfterMission = ""
) -> list[MissionEntry]:
    """The missions made on this server, last changed first, then the shipped ones."""
    return page.of(await services.missions.list(page.rows, after, search), after=place_of)


@router.post("", status_code=201, summary="Make a mission", responses=with_location(201, "It is kept.", etag=True))
async def create(services: TheServices, who: TheUser, response: Response, body: NewMission) -> MissionText:
    """A mission with errors is refused. The id is made from the name."""
    made = await services.missions.create(who, body.text, body.files, body.name)
    return _made(response, made)


@router.post("/check", summary="Check a mission")
async def check(services: TheServices, body: MissionToCheck) -> Checked:
    """What is wrong with it, with line numbers, and the tasks that no robot can do. Nothing is stored."""
    found = await services.missions.check(body.text, body.files, ignore=body.ignore, time_limit=body.time_limit)
    return Checked(**found)


@router.post(
    "/upload",
    status_code=201,
    summary="Upload a mission",
    responses=with_location(201, "It is kept.", etag=True),
    dependencies=[Depends(require_known_form)],
)
async def upload(
    services: TheServices,
    who: TheUser,
    response: Response,
    file: Annotated[UploadFile, File(description="YAML, CSV, an instance file (TSPLIB, VRPLIB, ...), or .plan.")],
    kinds: Annotated[list[_Kind], Form(alias="as", max_length=200, description=_KINDS)] = [],  # noqa: B006
    height_m: Annotated[float | None, Form(gt=0, le=1e4, description="From which areas are surveyed.")] = None,
    fov_deg: Annotated[float | None, Form(gt=0, lt=180, description="Width of the picture of their cameras.")] = None,
    width_m: Annotated[float | None, Form(gt=0, le=1e4, description="Width of their tool, without a camera.")] = None,
) -> MissionText:
    """A file of any format that Muster reads; it is converted to a mission file.

    Where nothing says what a feature of a site is the answer is 400: a line for each such feature names what decides.
    """
    answers = answers_of("; ".join(kinds), height_m=height_m, fov_deg=fov_deg, width_m=width_m)
    made = await services.missions.upload(who, _base_name(file.filename), await file.read(), **answers)
    return _made(response, made)


@router.get(
    "/{mission}",
    summary="Read a mission",
    responses=_WITH_ETAG,
)
async def mission(
    services: TheServices, mission: MissionId, response: Response, version: OptionalVersion = None
) -> MissionText:
    """Its text, and the names and sizes of its files."""
    return _tagged(response, await services.missions.get(mission, version))


@router.put(
    "/{mission}",
    summary="Change a mission",
    responses=_WITH_ETAG | errors(409, 428),
)
async def save(
    services: TheServices,
    who: TheUser,
    mission: MissionId,
    response: Response,
    body: ChangedMission,
    if_match: _IfMatch = None,
) -> MissionText:
    """Save a new version.

    If-Match or `base_version` must name the version that it is based on; if there is a newer one the answer is 409.
    """
    base = _base(if_match, body.base_version)
    return _tagged(response, await services.missions.save(who, mission, body.text, base, body.files, body.note))


@router.delete("/{mission}", status_code=204, summary="Delete a mission", responses=errors(409))
async def delete(services: TheServices, who: TheUser, mission: MissionId) -> None:
    """Hide it from the list; its plans and runs stay."""
    await services.missions.delete(who, mission)


@router.get("/{mission}/versions", summary="List the versions of a mission", responses=PAGED)
async def versions(
    services: TheServices, page: ThePage, mission: MissionId, before: BeforeVersion = None
) -> list[VersionEntry]:
    """Newest first; `before` the last `version` gives the next ones."""
    found = await services.missions.versions(mission, page.rows, before)
    return page.of(found, before=lambda version: version.version)


@router.get("/{mission}/versions/{number}", summary="Read a version of a mission")
async def version(services: TheServices, mission: MissionId, number: VersionNumber) -> MissionText:
    """The text of that version."""
    return _text(await services.missions.get(mission, number))


@router.get(
    "/{mission}/files/{name}",
    summary="Read a file of a mission",
    response_class=Response,
    responses=file_described("application/octet-stream", what="The file."),
)
async def file(services: TheServices, mission: MissionId, name: FileName, version: OptionalVersion = None) -> Response:
    """A file that the mission names, such as a floor plan or a table."""
    found = await services.missions.get(mission, version)
    if name not in found.files:
        raise NotFoundError(f"no file {name} in mission {mission}; expected one of {', '.join(found.files) or 'none'}")
    return file_response(found.files[name], name, "application/octet-stream")


@router.put(
    "/{mission}/files/{name}",
    summary="Change a file of a mission",
    responses=errors(409, 428),
    openapi_extra={
        "requestBody": {
            "required": True,
            "content": {"application/octet-stream": {"schema": {"contentMediaType": "application/octet-stream"}}},
        }
    },
)
async def put_file(
    services: TheServices,
    who: TheUser,
    mission: MissionId,
    name: FileName,
    request: Request,
    response: Response,
    if_match: _IfMatch = None,
    base_version: _BasedOn = None,
) -> MissionText:
    """The body is the file. This saves a new version of the mission."""
    base, data = _base(if_match, base_version), await request.body()
    found = await services.missions.get(mission, base)
    saved = await services.missions.save(who, mission, found.text, base, {**found.files, name: data}, f"file {name}")
    return _tagged(response, saved)


def _base(if_match: str | None, base_version: int | None) -> int:
    if if_match is not None:
        return int(if_match.strip('"'))
    if base_version is None:
        raise HTTPException(428, "neither If-Match nor base_version; expected the version that it is based on")
    return base_version


def _made(response: Response, made: MissionVersion) -> MissionText:
    response.headers["Location"] = f"/api/v1/missions/{made.mission}"
    return _tagged(response, made)


def _tagged(response: Response, version: MissionVersion) -> MissionText:
    """A version of a mission, whose number stands in the head of the answer as its ETag."""
    response.headers["ETag"] = f'"{version.version}"'
    return _text(version)


def _text(version: MissionVersion) -> MissionText:
    """The answer for a version, without the contents of its files."""
    given = asdict(replace(version, files={}))
    sizes = {name: len(data) for name, data in version.files.items()}
    return MissionText(id=given.pop("mission"), **given | {"files": sizes})


def _base_name(name: str | None) -> str:
    """The name of an uploaded file without folders and control characters."""
    plain = re.sub(r"[\x00-\x1f\x7f]", "_", (name or "").replace("\\", "/").rpartition("/")[2])
    return plain.encode("utf-8", "replace").decode()[-200:] or "mission.yaml"
