"""The keys of an action over an area: which of them go together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from muster.mission.value_types import Fault, JsonSchema, shown

WITH_AREA: JsonSchema = {
    "required": ["action"],
    "properties": {"action": {"type": "object", "required": ["area"]}},
}
"""Of a task that may be without a position: its area has a middle."""

_FROM_CAMERA = "height_m, from which the camera looks; or width_m, the width of a tool"


def coverage_faults(values: Mapping[str, Any]) -> Iterable[Fault]:
    """What is wrong between the keys of `coverage`."""
    if values.get("width_m") is None and values.get("height_m") is None:
        yield Fault(("height_m",), "missing", _FROM_CAMERA)
    if values.get("width_m") is not None and values.get("fov_deg") is not None:
        yield Fault(("fov_deg",), shown(values["fov_deg"]), "width_m or fov_deg, not both")
    part, split = values.get("part"), values.get("split")
    if part is not None and split is None:
        yield Fault(("part",), shown(part), "split beside it: into how many parts the area is split")
    elif part is not None and part > split:
        yield Fault(("part",), shown(part), f"a whole number from 1 to split ({split})")
