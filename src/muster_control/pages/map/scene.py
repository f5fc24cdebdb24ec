"""The scene of a map: plain data for its scripts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any


def scene_of(
    mission: Mapping[str, Any],
    *,
    image: Mapping[str, Any] | None = None,
    tiles: str = "",
    impossible: Iterable[str] = (),
) -> dict[str, Any]:
    """The scene of a plain mission (as its file has it, defaults left out or not); places in metres.

    `image` is a floor plan: `url`, `resolution` in metres a pixel, `origin` [x, y, yaw]. `tiles` is the address of map
    tiles with `{z}`, `{x}` and `{y}`, which are drawn where the mission says where on the earth it is.
    """
    ground: Mapping[str, Any] = mission.get("map") or {}
    earth = mission.get("origin_wgs84")
    return {
        "robots": [_robot(robot) for robot in mission.get("robots") or ()],
        "tasks": [_task(task) for task in mission.get("tasks") or ()],
        "stations": [_station(station) for station in mission.get("stations") or ()],
        "boundary": [list(corner[:2]) for corner in ground["boundary"]] if ground.get("boundary") else None,
        "zones": [_zone(zone, k) for k, zone in enumerate(ground.get("zones") or ())],
        "areas": _areas(mission.get("tasks") or ()),
        "image": dict(image) if image else None,
        "tiles": {"url": tiles, "origin": [earth["lat_deg"], earth["lon_deg"]]} if tiles and earth else None,
        "impossible": list(impossible),
    }


def _robot(robot: Mapping[str, Any]) -> dict[str, Any]:
    x, y, *rest = robot["position"]
    return {
        "id": str(robot["id"]),
        "x": x,
        "y": y,
        "z": rest[0] if rest else None,
        "kind": robot.get("kind") or "ground",
        "type": robot.get("type") or "",
        "radius": robot.get("radius_m") or 0.0,
        "heading": (robot.get("heading_deg") or 0.0) * 0.017453292519943295,
    }


def _task(task: Mapping[str, Any]) -> dict[str, Any]:
    x, y, *rest = task["position"]
    action = task.get("action") or {}
    return {
        "id": str(task["id"]),
        "x": x,
        "y": y,
        "z": rest[0] if rest else None,
        "type": str(task.get("type") or action.get("name") or ""),
        "prerequisites": [
            str(before["task"] if isinstance(before, Mapping) else before) for before in task.get("prerequisites") or ()
        ],
        **({"fixed": True} if action.get("area") else {}),
        **({} if task.get("delivers") is None else {"delivers": str(task["delivers"])}),
    }


def _areas(tasks: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Each area that is to be covered once, however many tasks it is split into, with its holes."""
    found: list[dict[str, Any]] = []
    for action in (task.get("action") or {} for task in tasks):
        area = {"corners": action.get("area"), "holes": action.get("holes") or []}
        if area["corners"] and area not in found:
            found.append(area)
    return found


def _station(station: Mapping[str, Any]) -> dict[str, Any]:
    x, y, *rest = station["position"]
    services = [str(service) for service in station.get("services") or ()]
    return {
        "id": str(station["id"]),
        "x": x,
        "y": y,
        "z": rest[0] if rest else None,
        "services": services,
        "slots": station.get("slots") or 1,
    }


def _zone(zone: Mapping[str, Any], k: int) -> dict[str, Any]:
    forbidden = list(zone.get("forbidden_to") or ("ground", "air"))
    partly = len(forbidden) < 2 or zone.get("floor_m") is not None or zone.get("ceiling_m") is not None
    whom = " and ".join(f"{kind} robots" for kind in forbidden)
    heights = "".join(
        f", {word} {zone[key]:g} m"
        for word, key in (("from", "floor_m"), ("to", "ceiling_m"))
        if zone.get(key) is not None
    )
    return {
        "corners": [list(corner[:2]) for corner in zone["polygon"]],
        "partly": partly,
        "label": f"zone {k + 1}, closed to {whom}{heights}",
    }
