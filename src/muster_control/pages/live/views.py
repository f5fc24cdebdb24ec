"""The pages `/live` and `/live/{run}`.

The view of a run as an element of NiceGUI: the browser reads the run's stream, and sends commands to Python.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from typing import Any

from nicegui import ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments

from muster.mission.errors import MusterError
from muster_control.contract import OVER, Run, User
from muster_control.pages.frame import frame
from muster_control.pages.map.ground import TILES, image_of
from muster_control.pages.notices import errors_shown, words_of
from muster_control.pages.tables import table
from muster_control.pages.visitor import PATIENCE_S, is_seen, on_the_wall, the_services, the_user

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


KEYS = {
    "space": "pause, go on",
    "+ and -": "faster, slower (with the map in focus: nearer, farther)",
    "1 to 9": "choose a robot",
    "up, down": "choose the robot before, after (with the map in focus: move it)",
    "n": "add a task by a click on the map, or by Enter in the middle of it",
    ". and ,": "with the map in focus: the next robot or task, the one before",
    "v": "seen in space, and from above",
    "Ctrl+Z": "take the last command back",
    "Escape": "choose nothing, leave it",
}
_HEADS = ("run", "mission", "state", "clock", "speed", "world", "started by", "at")
_REFRESH_S = 2.0
_ENDED = 10  # runs that are over and still listed


@ui.page("/live", response_timeout=PATIENCE_S)
async def runs_page() -> None:
    """The runs under way, and the last ones that ended."""
    with frame("Live"):

        @ui.refreshable
        async def listed() -> None:
            with errors_shown():
                _under_way(the_services().runs.present())
                _over(await the_services().runs.over(_ENDED))

        if await is_seen():
            await listed()
            ui.timer(_REFRESH_S, listed.refresh, immediate=False)


def _under_way(runs: Sequence[Run]) -> None:
    _heading("Under way")
    if runs:
        table(_HEADS, [((f"Run {run.id}", f"/live/{run.id}"), *_facts(run)) for run in runs], label="Runs under way")
    else:
        ui.label("Nothing is being carried out. Open a mission in Plan, plan it, and start it from there.").classes(
            "quiet"
        )


def _over(runs: Sequence[Run]) -> None:
    if not runs:
        return
    _heading("Ended")
    table(_HEADS, [((f"Run {run.id}", f"/records/{run.id}"), *_facts(run)) for run in runs], label="Runs that are over")


def _heading(words: str) -> None:
    ui.html(f"<h2>{words}</h2>", sanitize=False)


def _facts(run: Run) -> tuple[str, ...]:
    speed = "as fast as it goes" if run.speed is None else f"{run.speed:g} times"
    state = run.state if run.share is None else f"{run.state} ({run.share:.0%})"
    state = f"{state}: {run.remark}" if run.remark else state
    return run.mission, state, f"{run.time_s:.0f} s", speed, run.world, run.author, f"{run.at:%Y-%m-%d %H:%M} UTC"


@ui.page("/live/{run}", response_timeout=PATIENCE_S)
async def run_page(run: int) -> None:
    """One run as it is carried out."""
    services, who, wall = the_services(), the_user(), on_the_wall()
    try:
        entry = await services.runs.get(run)
    except MusterError as error:
        with frame("Live"), ui.element("p"):
            ui.label(words_of(error))
        return
    if entry.state in OVER:
        ui.navigate.to(f"/records/{run}{'?wall=1' if wall else ''}")
        return
    with frame("Live", title=f"{entry.mission}, run {run}", keys=KEYS) as content:
        content.classes("live-view")
        view = RunView(services.runs, run, who, wall=wall)
    if await is_seen():  # robots come first: stopping them needs neither database nor workers
        with errors_shown():
            view.lay(**await _ground(entry))


async def _ground(run: Run) -> dict[str, Any]:
    """The floor plan and the map tiles of a run's mission; without either there is a plain grid."""
    services = the_services()
    version = await services.missions.get(run.mission, run.mission_version)
    found = await services.missions.floor_plan(version)
    earth = found["earth"]
    tiles = (
        {"url": TILES, "origin": [earth["lat_deg"], earth["lon_deg"]]} if services.settings.tiles and earth else None
    )
    return {"image": image_of(found["floor"], version), "tiles": tiles}
