"""Drones on PX4 or ArduPilot as robots, over MAVLink (extra `mavlink`). See docs/mavlink.md."""

from muster_robots.mavlink.faults import Fault, Kind
from muster_robots.mavlink.fleet import MavlinkFleet

__all__ = ["Fault", "Kind", "MavlinkFleet"]
