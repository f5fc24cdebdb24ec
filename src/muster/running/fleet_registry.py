"""The registry of fleets of real robots, those of installed packages included; none is loaded before it is named."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

from muster.bridges.fleet import Fleet
from muster.mission.model import Mission
from muster.mission.plugins import Registry, function_expected

Opened = tuple[Fleet, Callable[[], None]]
"""Robots that are ready, and what to call when all is done."""
OpenFleet = Callable[[Mission, Mapping[str, Any], threading.Event, bool], Opened]
"""Opens a fleet: the mission, the settings of the run, an event that ends waiting, whether the run goes on."""

FLEETS: Registry[OpenFleet] = Registry(
    "fleet",
    "muster.fleets",
    {name: f"muster.running.fleets:open_{name}" for name in ("ros1", "ros2", "mavlink")},
    function_expected("a function that opens a fleet"),
)
