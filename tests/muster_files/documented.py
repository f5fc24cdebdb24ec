"""QGroundControl's documented plan format as a JSON Schema, written from the developer guide's page on plan files.

Stricter than the ground station: no keys but those documented, latitude and longitude within their own ranges.
"""

from typing import Any

LATITUDE = {"type": "number", "minimum": -90, "maximum": 90}
LONGITUDE = {"type": "number", "minimum": -180, "maximum": 180}
METRES = {"type": "number"}
WHOLE = {"type": "integer", "minimum": 0}


def record(required: dict[str, Any]) -> dict[str, Any]:
    """Of exactly these keys."""
    return {"type": "object", "properties": required, "required": list(required), "additionalProperties": False}


def row(*items: Any) -> dict[str, Any]:
    """Of exactly these items."""
    return {"type": "array", "prefixItems": list(items), "minItems": len(items), "maxItems": len(items)}


PARAMETER = {"type": ["number", "null"]}
ITEM = {
    "type": {"const": "SimpleItem"},
    "autoContinue": {"type": "boolean"},
    "command": WHOLE,
    "doJumpId": {"type": "integer", "minimum": 1},
}
PLACED_ITEM = record(
    ITEM
    | {
        "command": {"enum": [16, 21, 22]},
        "frame": {"const": 3},
        "AMSLAltAboveTerrain": {"type": ["number", "null"]},
        "Altitude": METRES,
        "AltitudeMode": {"const": 1},
        "params": row(*[PARAMETER] * 4, LATITUDE, LONGITUDE, METRES),
    }
)
OTHER_ITEM = record(ITEM | {"command": {"enum": [20, 115, 178]}, "frame": {"const": 2}, "params": row(*[METRES] * 7)})

POLYGON = record(
    {
        "inclusion": {"type": "boolean"},
        "polygon": {"type": "array", "items": row(LATITUDE, LONGITUDE), "minItems": 3},
        "version": {"const": 1},
    }
)

PLAN = record(
    {
        "fileType": {"const": "Plan"},
        "groundStation": {"const": "QGroundControl"},
        "version": {"const": 1},
        "mission": record(
            {
                "version": {"const": 2},
                "firmwareType": {"enum": [3, 12]},
                "globalPlanAltitudeMode": {"const": 1},
                "vehicleType": {"enum": [2, 10]},
                "cruiseSpeed": {"type": "number", "exclusiveMinimum": 0},
                "hoverSpeed": {"type": "number", "exclusiveMinimum": 0},
                "items": {"type": "array", "items": {"oneOf": [PLACED_ITEM, OTHER_ITEM]}, "minItems": 1},
                "plannedHomePosition": row(LATITUDE, LONGITUDE, METRES),
            }
        ),
        "geoFence": record(
            {
                "version": {"const": 2},
                "circles": {"type": "array", "maxItems": 0},
                "polygons": {"type": "array", "items": POLYGON},
            }
        ),
        "rallyPoints": record(
            {"version": {"const": 2}, "points": {"type": "array", "items": row(LATITUDE, LONGITUDE, METRES)}}
        ),
    }
)
