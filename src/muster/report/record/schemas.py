"""JSON schemas of the messages in a record: those of Foxglove that are used, by their own names, and Muster's.

Names and fields are those of Foxglove's published schemas (docs.foxglove.dev, "Schemas"; JSON encoding), of which only
what Muster writes is here: a viewer knows a schema by its name.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

Schema = dict[str, Any]

_NUMBER: Schema = {"type": "number"}
_TEXT: Schema = {"type": "string"}
_FLAG: Schema = {"type": "boolean"}
_COUNT: Schema = {"type": "integer", "minimum": 0}


def _record(title: str, *, maybe: Mapping[str, Schema] = MappingProxyType({}), **fields: Schema) -> Schema:
    return {"title": title, "type": "object", "properties": {**fields, **maybe}, "required": list(fields)}


def _many(item: Schema) -> Schema:
    return {"type": "array", "items": item}


def _one_of(title: str, **values: int) -> Schema:
    return {"title": title, "oneOf": [{"title": name, "const": value} for name, value in values.items()]}


_TIME = _record("time", sec=_COUNT, nsec={**_COUNT, "maximum": 999999999})
_DURATION = _record("duration", sec={"type": "integer"}, nsec={**_COUNT, "maximum": 999999999})
_VECTOR = _record("foxglove.Vector3", x=_NUMBER, y=_NUMBER, z=_NUMBER)
_POINT = _record("foxglove.Point3", x=_NUMBER, y=_NUMBER, z=_NUMBER)
_TURN = _record("foxglove.Quaternion", x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER)
_POSE = _record("foxglove.Pose", position=_VECTOR, orientation=_TURN)
_COLOR = _record("foxglove.Color", r=_NUMBER, g=_NUMBER, b=_NUMBER, a=_NUMBER)

_SPHERE = _record("foxglove.SpherePrimitive", pose=_POSE, size=_VECTOR, color=_COLOR)
_CYLINDER = _record(
    "foxglove.CylinderPrimitive",
    pose=_POSE,
    size=_VECTOR,
    bottom_scale=_NUMBER,
    top_scale=_NUMBER,
    color=_COLOR,
)
_LINE = _record(
    "foxglove.LinePrimitive",
    type=_one_of("foxglove.LineType", LINE_STRIP=0, LINE_LOOP=1, LINE_LIST=2),
    pose=_POSE,
    thickness=_NUMBER,
    scale_invariant=_FLAG,
    points=_many(_POINT),
    color=_COLOR,
    colors=_many(_COLOR),
    indices=_many(_COUNT),
)
_LABEL = _record(
    "foxglove.TextPrimitive",
    pose=_POSE,
    billboard=_FLAG,
    font_size=_NUMBER,
    scale_invariant=_FLAG,
    color=_COLOR,
    text=_TEXT,
)
_NONE = _many({"type": "object"})
_ENTITY = _record(
    "foxglove.SceneEntity",
    timestamp=_TIME,
    frame_id=_TEXT,
    id=_TEXT,
    lifetime=_DURATION,
    frame_locked=_FLAG,
    metadata=_many(_record("foxglove.KeyValuePair", key=_TEXT, value=_TEXT)),
    arrows=_NONE,
    cubes=_NONE,
    spheres=_many(_SPHERE),
    cylinders=_many(_CYLINDER),
    lines=_many(_LINE),
    triangles=_NONE,
    texts=_many(_LABEL),
    models=_NONE,
)
_DELETION = _record(
    "foxglove.SceneEntityDeletion",
    timestamp=_TIME,
    type=_one_of("foxglove.SceneEntityDeletionType", MATCHING_ID=0, ALL=1),
    id=_TEXT,
)
_TRANSFORM = _record(
    "foxglove.FrameTransform",
    timestamp=_TIME,
    parent_frame_id=_TEXT,
    child_frame_id=_TEXT,
    translation=_VECTOR,
    rotation=_TURN,
)
_FIELD = _record(
    "foxglove.PackedElementField", name=_TEXT, offset=_COUNT, type=_one_of("foxglove.NumericType", UINT8=1)
)
_LINES = {"type": "object", "additionalProperties": _many(_many(_NUMBER))}
_STATE = _record("muster.RobotState", **dict.fromkeys(("x", "y", "z", "heading_rad", "vx", "vy", "vz"), _NUMBER))

SCHEMAS: dict[str, Schema] = {
    schema["title"]: schema
    for schema in (
        _record("foxglove.FrameTransforms", transforms=_many(_TRANSFORM)),
        _record("foxglove.PosesInFrame", timestamp=_TIME, frame_id=_TEXT, poses=_many(_POSE)),
        _record("foxglove.SceneUpdate", deletions=_many(_DELETION), entities=_many(_ENTITY)),
        _record(
            "foxglove.Grid",
            timestamp=_TIME,
            frame_id=_TEXT,
            pose=_POSE,
            column_count=_COUNT,
            cell_size=_record("foxglove.Vector2", x=_NUMBER, y=_NUMBER),
            row_stride=_COUNT,
            cell_stride=_COUNT,
            fields=_many(_FIELD),
            data={**_TEXT, "contentEncoding": "base64"},
        ),
        _record(
            "foxglove.Log",
            timestamp=_TIME,
            level=_one_of("foxglove.LogLevel", UNKNOWN=0, DEBUG=1, INFO=2, WARNING=3, ERROR=4, FATAL=5),
            message=_TEXT,
            name=_TEXT,
            file=_TEXT,
            line=_COUNT,
        ),
        _record("muster.State", time_s=_NUMBER, robots={"type": "object", "additionalProperties": _STATE}),
        _record("muster.Event", time_s=_NUMBER, kind=_TEXT, data={"type": "object"}),
        _record(
            "muster.Plan",
            time_s=_NUMBER,
            lines=_LINES,
            maybe={key: {"type": "object"} for key in ("plan", "routes", "stops", "left_out")},
        ),
        _record(
            "muster.Bid", time_s=_NUMBER, round=_COUNT, task=_TEXT, robot=_TEXT, price=_NUMBER, bids={"type": "object"}
        ),
        _record("muster.Report", time_s=_NUMBER, report={"type": "object"}),
    )
}
"""By name."""

TOPICS = {
    "/tf": "foxglove.FrameTransforms",
    "/poses": "foxglove.PosesInFrame",
    "/scene": "foxglove.SceneUpdate",
    "/map": "foxglove.Grid",
    "/log": "foxglove.Log",
    "/muster/state": "muster.State",
    "/muster/event": "muster.Event",
    "/muster/plan": "muster.Plan",
    "/muster/bid": "muster.Bid",
    "/muster/report": "muster.Report",
}
"""The schema of each topic."""

MISSION_FILE = "mission.yaml"
"""The attachment that holds the mission."""
