"""Buttons that act once, however often they are clicked."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from nicegui import ui
from nicegui.events import ClickEventArguments

from muster_control.pages.notices import errors_shown


def once(act: Callable[[], Awaitable[bool | None]]) -> Callable[[ClickEventArguments], Awaitable[None]]:
    """A click handler that runs `act` once; again only if `act` failed or returned False.

    The button is disabled at once: `act` begins after this event, and a second click may arrive before. NiceGUI ignores
    clicks on disabled buttons.
    """

    def clicked(event: ClickEventArguments) -> Awaitable[None]:
        assert isinstance(event.sender, ui.button)
        event.sender.disable()
        return _done(event.sender)

    async def _done(button: ui.button) -> None:
        done: bool | None = False
        try:
            with button.client, errors_shown():  # what is around the button may be gone when it is done
                done = await act()
        finally:
            if done is False and not button.is_deleted:
                button.enable()

    return clicked
