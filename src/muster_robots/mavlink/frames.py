"""The map frame (ENU) in the frames of a drone: WGS84 with heights above home, and its local frame (NED).

Heights. A drone is told heights above home (MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, GLOBAL_POSITION_INT.relative_alt), and
home is as high as its start in the mission. Altitudes above the sea (AMSL) are neither read nor written, so that the
geoid, tens of metres from the ellipsoid, comes in nowhere. The map is flat and Earth is not: both are respected.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from muster.mission.geodesy import enu_to_wgs84, wgs84_to_enu
from muster.mission.model import Origin
from muster.motion.frames import FLU_ENU, body_in_global, enu_to_ned, goal_for_autopilot, pose_of, yaw_enu_to_ned
from muster.motion.port import Place

DEGREES_E7 = 1e7


@dataclass(frozen=True)
class GlobalFrame:
    """The map frame on Earth, for one drone.

    Parameters
    ----------
    origin
        where the map frame's origin is.
    start
        where the drone stands when it is armed, in the map frame: home is as high.
    """

    origin: Origin
    start: Place

    def to_drone(self, place: Place) -> tuple[int, int, float]:
        """Latitude and longitude in degrees times 1e7, and metres above home."""
        lat, lon, alt = enu_to_wgs84([place], self._origin)[0].tolist()
        return round(lat * DEGREES_E7), round(lon * DEGREES_E7), alt - self._home_alt

    def to_map(self, lat_e7: int, lon_e7: int, above_home_m: float) -> Place:
        """The inverse of `to_drone`."""
        place = (lat_e7 / DEGREES_E7, lon_e7 / DEGREES_E7, self._home_alt + above_home_m)
        east, north, up = wgs84_to_enu([place], self._origin)[0].tolist()
        return east, north, up

    @property
    def _origin(self) -> tuple[float, float, float]:
        return self.origin.lat_deg, self.origin.lon_deg, self.origin.alt_m

    @cached_property
    def _home_alt(self) -> float:
        """Of home above the ellipsoid, metres; by how the map is laid, not by what any sensor says."""
        return float(enu_to_wgs84([self.start], self._origin)[0][2])


@dataclass(frozen=True)
class LocalFrame:
    """The map frame beside the drone's own local frame, which has axes to north, east, down, and another origin.

    Parameters
    ----------
    zero
        where the local frame's origin is in the map frame.
    """

    zero: Place

    @classmethod
    def matched(cls, place: Sequence[float], local: Sequence[float]) -> LocalFrame:
        """The local frame of a drone that is at `place` in the map frame and says that it is at `local` (NED)."""
        east, north, up = enu_to_ned(local).tolist()
        return cls((place[0] - east, place[1] - north, place[2] - up))

    def to_drone(self, place: Place) -> Place:
        """North, east, down in the local frame."""
        north, east, down = enu_to_ned([a - b for a, b in zip(place, self.zero, strict=True)]).tolist()
        return north, east, down

    def to_map(self, ned: Sequence[float]) -> Place:
        """The inverse of `to_drone`."""
        east, north, up = enu_to_ned(ned).tolist()
        return self.zero[0] + east, self.zero[1] + north, self.zero[2] + up

    def velocity_to_map(self, ned: Sequence[float]) -> Place:
        """A velocity north, east, down as one of the map."""
        moved, still = self.to_map(ned), self.to_map((0.0, 0.0, 0.0))
        return moved[0] - still[0], moved[1] - still[1], moved[2] - still[2]

    def heading_to_drone(self, heading: float) -> float:
        """From east anticlockwise in the map as from north clockwise in the local frame, radians."""
        return float(yaw_enu_to_ned(heading))

    def heading_to_map(self, yaw: float) -> float:
        """The inverse of `heading_to_drone`."""
        return float(yaw_enu_to_ned(yaw))


@dataclass(frozen=True)
class StartFrame(LocalFrame):
    """The local frame of a drone without a compass, which calls north what is ahead of it at power-up.

    [tcf-thesis] (5.1)-(5.6) there, and (4.2)-(4.4) back.

    Parameters
    ----------
    heading
        of the drone at power-up in the map, radians from east.
    """

    heading: float

    def to_drone(self, place: Place) -> Place:
        """See `LocalFrame`."""
        north, east, down = enu_to_ned(goal_for_autopilot(self._start, [*place, 0.0])[:3]).tolist()
        return north, east, down

    def to_map(self, ned: Sequence[float]) -> Place:
        """See `LocalFrame`."""
        since_start = FLU_ENU.T @ enu_to_ned(ned)
        x, y, z = body_in_global(self._start, [*since_start, 0.0, 0.0, 0.0])[:3, 3].tolist()
        return x, y, z

    def heading_to_drone(self, heading: float) -> float:
        """See `LocalFrame`."""
        return float(yaw_enu_to_ned(goal_for_autopilot(self._start, [*self.zero, heading])[3]))

    def heading_to_map(self, yaw: float) -> float:
        """See `LocalFrame`."""
        since_start = float(yaw_enu_to_ned(yaw)) - math.pi / 2
        return float(pose_of(body_in_global(self._start, [0.0, 0.0, 0.0, 0.0, 0.0, since_start]))[5])

    @property
    def _start(self) -> tuple[float, ...]:
        return (*self.zero, 0.0, 0.0, self.heading)
