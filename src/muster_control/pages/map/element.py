"""The map of a mission as an element of NiceGUI. Movement is drawn by the browser without the server."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from nicegui.element import Element


class MissionMap(
    Element,
    component="map.js",
    esm={"muster-map": "modules"},
    default_classes="muster-map-frame",
):
    """A map that is panned, zoomed, pointed at, and edited where it is `editable`.

    Events (`.on(name, handler)`; `event.args` is plain data):

    | event | data |
    |---|---|
    | `choose` | `{what: robot, task, station or zone; id; corner of a zone}`, or null |
    | `move` | the same, with `x` and `y` in metres: dragged there, `from` [x, y]; `moves`: how many there were here |
    | `add` | `{what: the mode; x; y}`: clicked on free ground in the mode `task`, `robot` or `station` |
    | `zone` | `{corners: [[x, y], ...]}`: drawn in the mode `zone` |
    | `leave` | nothing: Escape, while nothing is being drawn |
    | `remove`, `ask` | what is chosen, at the keys Delete and Enter; a zone that is removed with its `corners` |

    Scripts of the page call `states`, `status`, `routes` and `clear` (messages of a run's stream) by
    `getElement(ID)`.
    """

    def __init__(
        self,
        scene: Mapping[str, Any] | None = None,
        *,
        plan: Mapping[str, Any] | None = None,
        editable: bool = False,
        group: str = "",
        label: str = "Map",
        waiting: str = "The mission is being read …",
    ) -> None:
        """Show a scene (`scene_of`) and the lines of a plan; maps of one `group` show the same part of the ground.

        `waiting` is said as long as there is no scene.
        """
        super().__init__()
        self.props["scene"] = scene
        self.props["plan"] = plan
        self.props["editable"] = editable
        self.props["mode"] = "select"
        self.props["label"] = label
        self.props["waiting"] = waiting
        if group:
            self.props["group"] = group

    def show(self, scene: Mapping[str, Any], moves: int = 0) -> None:
        """Show another state of the mission; the view stays where somebody moved it.

        A state that knows of fewer `moves` than there were is not shown: what was moved would jump back.
        """
        self.props["scene"] = {**scene, "moves": moves}

    def show_plan(self, plan: Mapping[str, Any] | None) -> None:
        """Show routes: `{routes: [{robot, tasks, order, lines}], left_out: [ids]}`, or none."""
        self.props["plan"] = plan

    def wait(self, words: str) -> None:
        """Set the text that is shown until there is a scene."""
        self.props["waiting"] = words

    def set_mode(self, mode: str) -> None:
        """Say what a click means: `select`, or to add a `task`, `robot` or `station`, or to draw a `zone`."""
        self.props["mode"] = mode

    def choose(self, what: str, name: str) -> None:
        """Mark a robot, task or station, and bring it into sight."""
        self.run_method("reveal", {"what": what, "id": name})

    def choose_none(self) -> None:
        """Remove the mark."""
        self.run_method("choose", None)
