"""The view of a run as an element of NiceGUI: the browser reads the run's stream, and sends commands to Python."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from typing import Any

from nicegui import ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments

from muster.mission.errors import MusterError
from muster_control.contract import User
from muster_control.pages.notices import words_of

for _scripts in ("muster_control.pages.map", "nicegui.elements.scene"):  # the latter's have three.js
    import_module(_scripts)  # so that those of this view find them
ui.add_css(Path(__file__).with_name("live.css"), shared=True)
_log = logging.getLogger("muster_control.pages")


class RunView(
    Element,
    component="live.js",
    esm={"muster-live": "js", "muster-record": str(files("muster") / "report" / "page" / "modules")},
    default_classes="muster-live-frame",
):
    """Map, robots, events and commands of one run.

    Parameters
    ----------
    runs
        the service of runs, whose `act` receives commands.
    who
        the user; without the role `command` there are no controls.
    wall
        whether the view is large and without controls.
    """

    def __init__(self, runs: Any, run: int, who: User, *, wall: bool) -> None:
        super().__init__()
        self._runs, self._run, self._who = runs, run, who
        self.props["path"] = f"/api/v1/runs/{run}/stream"
        self.props["may"] = who.role == "command"
        self.props["wall"] = wall
        self.props["ground"] = {"image": None, "tiles": None}
        self.on("act", self._act)

    def lay(self, *, image: Mapping[str, Any] | None, tiles: Mapping[str, Any] | None) -> None:
        """Set the floor plan and map tiles, as in `map.scene_of`."""
        self.props["ground"] = {"image": image, "tiles": tiles}

    async def _act(self, event: GenericEventArguments) -> None:
        token = event.args.get("token")
        try:
            action = await self._runs.act(self._who, self._run, str(event.args["verb"]), dict(event.args["data"]))
            told = {"action": action.id, "outcome": action.outcome, "kept": action.kept}
        except MusterError as error:
            told = {"error": words_of(error)}
        except Exception:
            _log.exception("a command failed")
            told = {"error": "that went wrong inside Muster; the server's log says more"}
        self.run_method("answer", {"token": token, **told})
