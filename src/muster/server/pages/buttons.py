"""Buttons that do something once, however often they are clicked."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from nicegui import ui
from nicegui.events import ClickEventArguments

from muster.server.pages.notices import told


def once(act: Callable[[], Awaitable[bool | None]]) -> Callable[[ClickEventArguments], Awaitable[None]]:
    """What a button does: `act`, and nothing more from then on, unless that fails or gives back False.

    So a double click asks for one thing. The button is disabled here, as `act` begins only after this event, and the
    second click may be heard before that; NiceGUI ignores clicks on what is disabled, whatever a browser shows.
    """

    def clicked(event: ClickEventArguments) -> Awaitable[None]:
        assert isinstance(event.sender, ui.button)
        event.sender.disable()
        return _done(event.sender)

    async def _done(button: ui.button) -> None:
        done: bool | None = False
        try:
            with button.client, told():  # what is around the button may be gone when it is done
                done = await act()
        finally:
            if done is False and not button.is_deleted:
                button.enable()

    return clicked
