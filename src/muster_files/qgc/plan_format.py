"""The keys and numbers of QGroundControl's plan files.

Source: QGroundControl developer guide, "Plan File Format"; numbers are MAVLink's MAV_CMD, MAV_FRAME, MAV_AUTOPILOT and
MAV_TYPE.
"""

from __future__ import annotations

NAV_WAYPOINT = 16
NAV_LOITER_TIME = 19
NAV_RETURN_TO_LAUNCH = 20
NAV_LAND = 21
NAV_TAKEOFF = 22
NAV_VTOL_TAKEOFF = 84
NAV_VTOL_LAND = 85
NAV_DELAY = 93
CONDITION_YAW = 115
DO_JUMP = 177
DO_CHANGE_SPEED = 178

SET_TRIGGER_DISTANCE = 206

FRAME_GLOBAL = 0
FRAME_MISSION = 2
FRAME_GLOBAL_RELATIVE_ALT = 3
FRAME_GLOBAL_INT = 5
FRAME_GLOBAL_RELATIVE_ALT_INT = 6

QUADROTOR = 2
GROUND_ROVER = 10

FIRMWARE = {"px4": 12, "ardupilot": 3}

RELATIVE_TO_HOME = 1
"""AltitudeMode, and globalPlanAltitudeMode: heights above home."""
AIR_SPEED = 0
GROUND_SPEED = 1
CLIMB_SPEED = 2
DESCENT_SPEED = 3
"""First parameter of DO_CHANGE_SPEED."""

WAY_POINTS_HEAD = "QGC WPL"
"""Begins a file of way points as text; a version follows."""
