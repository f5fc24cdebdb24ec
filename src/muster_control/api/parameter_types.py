"""Types of parameters: values that are too long, too large or of a wrong form are refused before the services."""

from __future__ import annotations

import binascii
from base64 import b64decode
from typing import Annotated, Any

from fastapi import Path, Query
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from muster.mission.ignorable_rules import IGNORABLE
from muster_control.contract import MOST_ROWS
from muster_control.services import uploads

LARGEST = 2**31 - 1
"""Of ids and counts: what an integer column of every database holds."""
_WITHOUT_CONTROLS = r"^[^\x00-\x1f\x7f]*$"
_ID = r"^[A-Za-z0-9][A-Za-z0-9._+-]*$"
_FILE_NAME = f"^{uploads.FILE_NAME}$"


class Body(BaseModel):
    """A JSON body: unknown fields are refused, and no value is converted to another type."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, ser_json_inf_nan="null")


def _decoded(value: Any) -> bytes:
    try:
        return b64decode(value, validate=True)
    except (binascii.Error, TypeError, ValueError):
        raise PydanticCustomError("base64", "Input should be a file in base64") from None


def _without_nul(text: str) -> str:
    if "\0" in text:
        raise PydanticCustomError("nul", "Input should be a text without NUL")
    return text


MissionId = Annotated[str, Path(max_length=200, pattern=_ID, description="Of a mission.", examples=["31T-6R50"])]
FileName = Annotated[
    str, Path(max_length=uploads.LONGEST_FILE_NAME, pattern=_FILE_NAME, description="Of a file of the mission.")
]
PlanId = Annotated[int, Path(ge=1, le=LARGEST, description="Of a plan.", examples=[1])]
JobId = Annotated[int, Path(ge=1, le=LARGEST, description="Of a job.", examples=[1])]
RunId = Annotated[int, Path(ge=1, le=LARGEST, description="Of a run.", examples=[1])]
VersionNumber = Annotated[int, Path(ge=1, le=LARGEST, description="Of a mission, counted from 1.", examples=[1])]

Limit = Annotated[int, Query(ge=1, le=MOST_ROWS, description="At most so many.")]
OptionalVersion = Annotated[int | None, Query(ge=1, le=LARGEST, description="Of the mission; the newest without.")]
After = Annotated[int, Query(ge=0, le=LARGEST, description="Only what has a greater `seq`.")]
MissionQuery = Annotated[str | None, Query(max_length=200, pattern=_ID, description="Only those of this mission.")]
RunQuery = Annotated[int | None, Query(ge=1, le=LARGEST, description="Only those of this run.")]
Before = Annotated[int | None, Query(ge=1, le=LARGEST, description="Only what has a smaller `id`.")]
BeforeAction = Annotated[int | None, Query(ge=1, le=2**53 - 1, description="Only what has a smaller `id`.")]
AfterMission = Annotated[
    str, Query(max_length=300, pattern=_WITHOUT_CONTROLS, description="Only what follows; the header `Link` has it.")
]
Search = Annotated[
    str, Query(max_length=200, pattern=_WITHOUT_CONTROLS, description="Words that all stand in its name or id.")
]
BeforeVersion = Annotated[int | None, Query(ge=1, le=LARGEST, description="Only what has a smaller `version`.")]
TaskQuery = Annotated[
    str | None, Query(min_length=1, max_length=200, pattern=_WITHOUT_CONTROLS, description="The id of a task.")
]

Name = Annotated[str, Field(min_length=1, max_length=200, pattern=_WITHOUT_CONTROLS)]
Note = Annotated[str, Field(max_length=1000, pattern=_WITHOUT_CONTROLS)]
Text = Annotated[str, Field(min_length=1, description="A mission file (YAML)."), AfterValidator(_without_nul)]
Base64 = Annotated[bytes, BeforeValidator(_decoded), WithJsonSchema({"type": "string", "contentEncoding": "base64"})]
Files = Annotated[
    dict[Annotated[str, Field(max_length=uploads.LONGEST_FILE_NAME, pattern=_FILE_NAME)], Base64],
    Field(
        max_length=uploads.MOST_FILES,
        description="The files that the mission names (floor plans, tables), in base64, by name.",
    ),
]
Count = Annotated[int, Field(ge=0, le=LARGEST)]
Seed = Annotated[int, Field(ge=0, le=2**63 - 1)]
Ignored = Annotated[
    list[Annotated[str, WithJsonSchema({"enum": [*IGNORABLE]})]],
    Field(max_length=2 * len(IGNORABLE), description="Rules that do not hold."),
]
IgnoredQuery = Annotated[
    Ignored | None,
    Query(description="Rules that do not hold. Default: those that were ignored when the server made the plan."),
]
"""The planning request checks the values, with the texts of the command; the schema lists them."""
Seconds = Annotated[float, Field(ge=0, le=1e6)]
