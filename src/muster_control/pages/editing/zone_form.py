"""The form of a zone that was drawn on the map: its heights, and the robots that it excludes."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Sequence

from nicegui import ui

from muster_control.pages.buttons import once

Corner = Sequence[float]

_WHOM = {"both": "ground and air robots", "ground": "ground robots", "air": "air robots"}


def open_zone(corners: Sequence[Corner], ground: object, edit: Callable[..., Awaitable[bool]]) -> ui.dialog:
    """Ask for the properties of a zone, and add it by `edit`."""
    with ui.dialog() as dialog, ui.card().classes("making"):
        ui.label(f"A new zone of {len(corners)} corners").classes("dialog-title")
        whom = ui.select(_WHOM, value="both", label="forbidden_to").props("outlined dense").classes("full")
        with ui.element("div").classes("fields full"):
            floor = ui.number("floor_m").props('outlined dense clearable hint="empty: from the ground"')
            ceiling = ui.number("ceiling_m").props('outlined dense clearable hint="empty: without an end"')
        for note in _notes(corners, ground):
            ui.label(note).classes("quiet small")

        async def make() -> bool:
            kinds = ["ground", "air"] if whom.value == "both" else [whom.value]
            made = await edit("add_zone", corners, floor.value, ceiling.value, kinds)
            if made:
                dialog.close()
            return made

        with ui.element("div").classes("dialog-buttons"):
            ui.button("Cancel", on_click=dialog.close).props("flat")
            ui.button("Add the zone", on_click=once(make)).props('unelevated autofocus id="add-zone"')
    dialog.open()
    return dialog


def _notes(corners: Sequence[Corner], ground: object) -> list[str]:
    """Warnings about the zone."""
    if not ground:
        return [
            "The mission has no map, and a zone needs one: a boundary is drawn around everything. "
            "From then on robots find ways around zones, and stay within it."
        ]
    if lies_outside(ground, corners):
        return ["Part of the zone lies outside the boundary of the map, where nobody goes anyway."]
    return []


def lies_outside(ground: object, corners: Iterable[Corner]) -> bool:
    """Whether a corner is outside the boundary of a map, if that has one in metres."""
    boundary = ground.get("boundary") if isinstance(ground, dict) else None
    return isinstance(boundary, list) and any(not _is_within(corner, boundary) for corner in corners)


def _is_within(point: Corner, polygon: Sequence[Corner]) -> bool:
    """Whether a ray to the east crosses the outline an odd number of times."""
    x, y = point
    within = False
    for k, (x2, y2) in enumerate(polygon):
        x1, y1 = polygon[k - 1]
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) * (x2 - x1) / (y2 - y1):
            within = not within
    return within
