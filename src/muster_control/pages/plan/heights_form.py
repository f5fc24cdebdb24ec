"""The dialog that asks at which heights the drones of a mission in the plane fly, for an export."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping

from nicegui import ui

from muster.planning.export_formats import RANGES
from muster_control.pages.buttons import once
from muster_control.pages.notices import warn

_ALTITUDE_M = 20.0
_WORDS = (
    "The mission is in the plane and has drones: say how high they fly. Each drone flies higher than the one before it "
    "by the step; with 0 all fly at one height."
)


def open_heights(export: Callable[[Mapping[str, float]], Awaitable[None]]) -> None:
    """Ask for `altitude` and `altitude_step`, in metres, and export with them."""
    with ui.dialog() as dialog, ui.card().classes("making"):
        ui.label("Heights of drones").classes("dialog-title")
        ui.label(_WORDS).classes("quiet")
        fields = {
            "altitude": _metres("Height above the start, m", "altitude", _ALTITUDE_M),
            "altitude_step": _metres("Step between drones, m", "altitude_step", 0.0),
        }

        async def take() -> bool:
            heights = {name: float(field.value or 0.0) for name, field in fields.items()}
            if heights["altitude"] <= 0:
                warn("Height above the start: expected more than 0 m")
                return False
            await export(heights)
            dialog.close()
            return True

        with ui.element("div").classes("dialog-buttons"):
            ui.button("Cancel", on_click=dialog.close).props("flat")
            ui.button("Export", icon="download", on_click=once(take)).props("unelevated")
    dialog.open()


def _metres(label: str, option: str, value: float) -> ui.number:
    low, high = RANGES[option]
    field = ui.number(label, value=value, min=low, max=high)
    return field.props("outlined dense").classes("full")
