"""Errors of the services and news as notices; the user never sees a traceback."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from weakref import WeakKeyDictionary

from nicegui import Client, ui

from muster.mission.errors import InputError, MusterError

_MOST_LINES = 5
_WARNED_S = 20.0
_warnings: WeakKeyDictionary[Client, ui.notification] = WeakKeyDictionary()
_log = logging.getLogger("muster_control.pages")


@contextmanager
def errors_shown() -> Iterator[None]:
    """Show an error of the block as a notice, if the page is still open."""
    client = ui.context.client
    try:
        yield
    except MusterError as error:
        if not client.is_deleted:
            warn(words_of(error))
    except Exception:
        _log.exception("a page failed")
        if not client.is_deleted:
            warn("That went wrong inside Muster. The server's log says more.")


def words_of(error: MusterError) -> str:
    """An error in a few lines."""
    lines = [str(finding) for finding in error.findings] if isinstance(error, InputError) else str(error).splitlines()
    more = [f"and {len(lines) - _MOST_LINES} more"] if len(lines) > _MOST_LINES else []
    return "\n".join(lines[:_MOST_LINES] + more)


def say(text: str) -> None:
    """Show news for a few seconds."""
    ui.notify(text, position="bottom-left", timeout=4000, classes="notice", group=False, attrs={"role": "status"})


def end_warning() -> None:
    """Take away the last error, if it is still shown: what was wrong is not any more."""
    before = _warnings.pop(ui.context.client, None)
    if before is not None and not before.is_deleted:
        before.dismiss()


def warn(text: str) -> None:
    """Show an error in place of the last one; it stays for a while, or until it is closed."""
    end_warning()
    _warnings[ui.context.client] = ui.notification(
        text,
        position="bottom-left",
        timeout=_WARNED_S,
        multi_line=True,
        actions=[{"label": "Close", "color": "white"}],
        classes="notice alarming",
        group=False,
        attrs={"role": "alert"},
    )


def offer(text: str, label: str, answer: Callable[[], object], seconds: float = 12) -> None:
    """Show news with a button, such as undo."""
    with ui.context.client.content:
        bar = ui.element("div").classes("offer").props('role="status"')
        with bar:
            ui.label(text)

            async def chosen() -> None:
                bar.delete()
                result = answer()
                if hasattr(result, "__await__"):
                    await result

            ui.button(label, on_click=chosen).props("flat dense no-caps")
            ui.timer(seconds, bar.delete, once=True)
