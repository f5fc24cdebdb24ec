"""The dialog that starts a run: its world, its speed, and the settings of real robots."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from nicegui import ui

from muster.cli.options.request import settings_from
from muster.mission.errors import ParameterError
from muster.mission.records import Settings, key_of, required, specified
from muster.running.fleet_registry import FLEETS
from muster.running.worlds import WORLDS
from muster_control.contract import PlanEntry
from muster_control.pages.buttons import once
from muster_control.pages.visitor import the_services, the_user

_SPEEDS = {
    "0.5": "half as fast",
    "1": "as in reality",
    "2": "twice as fast",
    "5": "5 times",
    "10": "10 times",
    "": "as fast as it goes",
}
_SIMULATED = {"kinematic": "simulated", "physics": "simulated with physics"}  # others by their names
_AVOIDANCE = {"auto": "default", "orca": "ORCA", "rvo": "RVO", "hrvo": "HRVO", "avo": "AVO", "none": "not at all"}
_TRAFFIC = {
    "auto": "in planned order where there is room for one",
    "reserve": "in planned order",
    "free": "as robots meet",
}
_LAWS = {
    "profile": "speed profiles, turns on the spot",
    "thesis": "control laws of the thesis",
    "trajectory": "smooth trajectories",
}
_DRIVES = {"cmd_vel": "velocities (cmd_vel)", "goals": "goals (WP)"}
_GIVES = {"goals": "goals (goal_pose)", "nav2": "Nav2's action"}
_ENDS = {"hold": "hover where they are", "return": "return and land", "land": "land where they are"}

Reading = Callable[[], dict[str, Any]]


def open_start(entry: PlanEntry, dimensions: int) -> None:
    """Ask how to carry out a plan, and open the run when it has started."""
    bridges = {name: f"real robots ({name})" for name in the_services().settings.bridges}
    with ui.dialog() as dialog, ui.card().classes("making"):
        ui.label("Carry this plan out").classes("dialog-title")
        simulated = {name: _SIMULATED.get(name, f"simulated ({name})") for name in WORLDS}
        world = _choice("In which world", simulated | bridges, "kinematic").props('id="world"')
        speed = _choice("How fast", _SPEEDS, "1").bind_visibility_from(world, "value", simulated.__contains__)
        form = ui.element("div").classes("full")
        now = ui.checkbox("Starts now: all times of the mission are shifted").props('id="starts-now"')
        now.bind_visibility_from(world, "value", lambda name: name not in simulated)
        in_part = ui.checkbox("Planning was cut short: carry out what is planned").props('id="accept-partial"')
        in_part.set_visibility(bool(entry.plan.get("cut_short")))
        reading: list[Reading] = []

        def ask() -> None:
            form.clear()
            with form:
                reading[:] = [_form_of(world.value)(entry, dimensions)]

        world.on_value_change(ask)
        ask()

        async def begin() -> None:
            pace, settings = float(speed.value) if speed.value else None, reading[0]()
            if in_part.value:
                settings["accept_partial"] = True
            if world.value not in simulated:
                pace = 1.0
                settings |= {"starts": "now"} if now.value else {}
            run = await the_services().runs.start(the_user(), entry.id, world.value, pace, settings)
            ui.navigate.to(f"/live/{run.id}")

        with ui.element("div").classes("dialog-buttons"):
            ui.button("Cancel", on_click=dialog.close).props("flat")
            ui.button("Start", icon="play_arrow", on_click=once(begin)).props('unelevated id="start"')
    dialog.open()


def _choice(label: str, options: Mapping[str, str], value: str) -> ui.select:
    return ui.select(dict(options), value=value, label=label).props("outlined dense").classes("full")


def _text(label: str, value: str = "") -> ui.input:
    return ui.input(label, value=value).props("outlined dense").classes("full")


def _simulated(_: PlanEntry, __: int) -> Reading:
    with ui.expansion("More").classes("full"):
        avoidance = _choice("How robots pass each other", _AVOIDANCE, "auto")
        traffic = _choice("Who passes first", _TRAFFIC, "auto")
        law = _choice("How robots move", _LAWS, "profile")
        seed = ui.number("Seed", value=0, min=0, precision=0).props("outlined dense").classes("full")
        unknown = ui.checkbox("Robots have no map, and build it as they go")
        explore = ui.checkbox("They explore all of it: frontiers become tasks").bind_visibility_from(unknown, "value")
    return lambda: {
        "avoidance": avoidance.value,
        "traffic": traffic.value,
        "law": law.value,
        "seed": int(seed.value or 0),
        "unknown": unknown.value,
        "explore": unknown.value and explore.value,
    }


def _declared(settings: type[Settings], _: PlanEntry, __: int) -> Reading:
    """A text for each setting of a fleet; one that is empty keeps its default."""
    texts = {}
    for f in specified(settings):
        texts[key_of(f)] = _text(key_of(f))
        texts[key_of(f)].props(f'id="setting-{key_of(f)}"').props["hint"] = f.metadata["doc"] + (
            "" if required(f) else f"; {f.default} without it"
        )

    def read() -> dict[str, Any]:
        given = {key: (text.value or "").strip() for key, text in texts.items()}
        return settings_from(settings, [f"{key}={value}" for key, value in given.items() if value])

    return read


def _ros1(_: PlanEntry, __: int) -> Reading:
    drive = _choice("What robots take", _DRIVES, "cmd_vel")
    namespace, known = _on_ros()
    return lambda: {"drive": drive.value, "namespace": namespace.value.strip(), "known_only": known.value}


def _ros2(_: PlanEntry, __: int) -> Reading:
    give = _choice("What robots are given", _GIVES, "goals")
    namespace, known = _on_ros()
    return lambda: {"give": give.value, "namespace": namespace.value.strip(), "known_only": known.value}


def _on_ros() -> tuple[ui.input, ui.checkbox]:
    return _text("Namespace, if any"), ui.checkbox("Robots that the mission does not name stay out")


def _mavlink(entry: PlanEntry, dimensions: int) -> Reading:
    robots = "\n".join(f"{route['robot']}=" for route in entry.plan["routes"])
    lines = ui.textarea("How each robot is reached", value=robots).classes("full")
    lines.props(
        'outlined dense autogrow id="endpoints" hint="such as r_0=udp:0.0.0.0:14550 or r_1=serial:/dev/ttyUSB0"'
    )
    at_end = _choice("When all is done, drones", _ENDS, "hold")
    height = None if dimensions == 3 else ui.number("Height of flight above home, m", value=10, min=0.5, max=500)
    offboard = ui.checkbox("Say way points one by one (offboard, guided)")
    arm = ui.checkbox("Arm and fly: the airspace is free, somebody can take over by hand").props('id="arm"')

    def read() -> dict[str, Any]:
        settings = {"endpoints": _endpoints(lines.value or ""), "at_end": at_end.value, "offboard": offboard.value}
        if not arm.value:
            raise ParameterError("drones do not fly before they may be armed; expected the mark at the end of the form")
        return settings | {"arm": True} | ({} if height is None else {"height_m": float(height.value or 0)})

    return read


def _endpoints(text: str) -> dict[str, str]:
    found: dict[str, str] = {}
    for line in filter(None, map(str.strip, text.splitlines())):
        robot, given, endpoint = (part.strip() for part in line.partition("="))
        if not (robot and given and endpoint) or robot in found:
            raise ParameterError(f"{line}; expected each robot once, as r_0=udp:0.0.0.0:14550")
        found[robot] = endpoint
    return found


_FORMS: Mapping[str, Callable[[PlanEntry, int], Reading]] = {
    "kinematic": _simulated,
    "physics": _simulated,
    "ros1": _ros1,
    "ros2": _ros2,
    "mavlink": _mavlink,
}


def _form_of(world: str) -> Callable[[PlanEntry, int], Reading]:
    """Worlds of other packages are set as the simulated ones that ship, their fleets by what they declare."""
    return _FORMS.get(world) or (_simulated if world in WORLDS else partial(_declared, FLEETS[world].settings))
