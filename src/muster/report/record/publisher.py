"""Publishes a mission that is carried out as messages on topics: to a file, or to viewers.

An observer: the code that carries the mission out calls `on_step`, `on_event`, `on_plan` and `on_report`, and knows
nothing of files and viewers.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Point
from muster.mission.plan import Plan
from muster.mission.values.arrays import Floats
from muster.report.record import json_messages, scene
from muster.report.record.routes import RouteLines
from muster.state import MissionState, event_of


class Publisher(ABC):
    """Makes messages of a mission; subclasses deliver them.

    Parameters
    ----------
    rate_hz
        the largest number of published steps per second of the mission.
    """

    def __init__(self, mission: Mission, rate_hz: float) -> None:
        if not rate_hz > 0:
            raise ParameterError(f"rate_hz: {rate_hz}; expected a number above 0")
        self._mission_state = MissionState(mission)
        self._routes = RouteLines(mission)
        self._places: dict[str, Point] = {}
        self._period_s, self._next_s = 1.0 / rate_hz, 0.0

    @abstractmethod
    def _add(self, topic: str, now: float, data: bytes) -> None:
        """Deliver a message of a time of the mission's clock."""

    @abstractmethod
    def _flush(self) -> None:
        """Ensure that the messages so far arrive."""

    def _write(self, topic: str, now: float, message: Mapping[str, Any]) -> None:
        self._add(topic, now, json_messages.json_bytes(message))

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """Publish the robots' states, unless a step was published less than a period ago.

        Parameters
        ----------
        now
            seconds of the mission's clock.
        positions, headings, velocities
            (n, 3) metres, (n,) radians, (n, 3) m/s in the map frame; a row for each robot: those of the mission, then
            those that joined. An absent robot has NaN.
        """
        names = list(self._mission_state.robots)
        if len(positions) != len(names):
            raise ParameterError(f"positions: {len(positions)} rows; expected one for each of {len(names)} robots")
        if now < self._next_s - 1e-9:
            return
        self._next_s = max(self._next_s + self._period_s, now + self._period_s / 2)
        self._write_step(float(now), names, np.column_stack([positions, headings, velocities]))

    def _write_step(self, now: float, names: Sequence[str], states: Floats) -> None:
        there: list[int] = np.flatnonzero(np.isfinite(states).all(axis=1)).tolist()
        present = [names[k] for k in there]
        rows = states[there].tolist()
        self._places = {name: tuple(row[:3]) for name, row in zip(present, rows, strict=True)}
        texts = json_messages.place_texts(rows)
        self._add("/tf", now, json_messages.transforms_text(now, present, texts))
        self._add("/poses", now, json_messages.poses_text(now, texts))
        self._add("/muster/state", now, json_messages.state_text(now, present, rows))

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """Publish an event; `muster.state` defines the meaning of each kind."""
        event = event_of(now, kind, data)
        self._add("/muster/event", now, json_messages.json_bytes({"time_s": now, "kind": kind, "data": data}))
        level = json_messages.WARNING if event.alarming else json_messages.INFO
        self._write("/log", now, json_messages.log(now, level, event.line))
        entities = scene.changed_entities(now, self._mission_state, event)
        if entities:
            self._write("/scene", now, scene.update(entities))

    def on_telemetry(self, now: float, robot: str, telemetry: object) -> None:  # noqa: B027 - nobody has to hear it
        """Telemetry is not published: the steps contain the robots' states."""

    def on_plan(self, now: float, plan: Plan) -> None:
        """Publish a plan, with the bids that led to it where they are known, and the routes as lines."""
        lines = self._routes.of(plan, self._mission_state, self._places)
        self._write("/muster/plan", now, {"time_s": now, **self._plan_data(plan, lines)})
        for award in plan.book.awards if plan.book is not None else ():
            self._write("/muster/bid", now, {"time_s": now, **award.as_dict()})
        order = list(self._mission_state.robots)
        routes = [scene.route_entity(now, robot, order.index(robot), line) for robot, line in lines.items()]
        self._write("/scene", now, scene.update(routes))
        self._flush()

    def _plan_data(self, plan: Plan, lines: Mapping[str, Sequence[Point]]) -> Mapping[str, Any]:
        """Return what is published of a plan: all of it, for viewers that come late."""
        return {"plan": plan.as_dict(), "lines": lines}

    def on_report(self, report: Mapping[str, Any]) -> None:
        """Publish the report at the mission's end."""
        now = float(report.get("mission_time_s") or 0.0)
        self._write("/muster/report", now, {"time_s": now, "report": report})
        self._flush()

    def _tell_mission(self) -> None:
        """The map, if it is an image, and the scene as it is in the beginning."""
        mission = self._mission_state.mission
        if mission.map is not None and mission.map.boundary is None:
            from muster.motion.map_world import World

            image = World.of(mission).image
            if image is not None:
                self._write("/map", 0.0, json_messages.grid_message(image))
        robots = [scene.robot_entity(0.0, robot, k) for k, robot in enumerate(mission.robots)]
        tasks = [scene.task_entity(0.0, task, self._mission_state.stage(task.id)) for task in mission.tasks]
        stations = [scene.station_entity(station) for station in mission.stations]
        self._write("/scene", 0.0, scene.update([*scene.map_entities(mission.map), *stations, *tasks, *robots]))
        self._flush()
