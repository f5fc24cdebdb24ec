"""Profiles: the topics, actions and frames of robots as they are sold and installed, as named values of settings.

A profile gives values to settings of the fleets `ros1` and `ros2`; what is said beside it comes first. A robot's
namespace is before all topics but those that begin with `/`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Ros = Literal["ros1", "ros2"]


@dataclass(frozen=True)
class Profile:
    """One kind of robot.

    Parameters
    ----------
    robots : str
        Which robots it is for.
    ros1, ros2 : Mapping[str, Any]
        The settings on ROS 1 and ROS 2; empty where there are no such robots.
    """

    robots: str
    ros1: Mapping[str, Any] = field(default_factory=dict)
    ros2: Mapping[str, Any] = field(default_factory=dict)

    def sets(self, ros: Ros) -> Mapping[str, Any]:
        """Return the settings on one of the two."""
        return self.ros1 if ros == "ros1" else self.ros2


_ON_THE_MAP = {"frame": "map", "odometry": "map", "poses": ""}
PROFILES: Mapping[str, Profile] = {
    "move_base": Profile("navigation by move_base, localisation by amcl", ros1={"drive": "move_base", **_ON_THE_MAP}),
    "nav2": Profile("navigation by Nav2, localisation by its amcl", ros2={"give": "nav2", **_ON_THE_MAP}),
    "amcl": Profile(
        "localisation by amcl, without navigation",
        ros1={"drive": "cmd_vel", **_ON_THE_MAP},
        ros2={"give": "goals", **_ON_THE_MAP},
    ),
    "mocap": Profile(
        "poses by motion capture (vrpn_client_ros, vrpn_mocap)",
        ros1={"drive": "cmd_vel", "frame": "world", "odometry": "map", "poses": "/vrpn_client_node/{robot}/pose"},
        ros2={"give": "goals", "frame": "world", "odometry": "map", "poses": "/vrpn_mocap/{robot}/pose"},
    ),
}


def profiles_of(ros: Ros) -> tuple[str, ...]:
    """Return the names of the profiles of robots on one of the two."""
    return tuple(name for name, profile in PROFILES.items() if profile.sets(ros))


def profile_help(ros: Ros) -> str:
    """Return what each profile sets, in words."""
    told = (f"{name}: {_settings(PROFILES[name].sets(ros))}" for name in profiles_of(ros))
    return f"robots of a known kind, whose settings are used where none is given: {'; '.join(told)}"


def _settings(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in values.items() if value != "")
