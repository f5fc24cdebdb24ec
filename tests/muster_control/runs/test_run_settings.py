"""What may be asked of a run is checked before anything is started."""

import pytest

from muster.mission.errors import ParameterError
from muster_control.runs.run_settings import MOST_ORDERS, new_request

BRIDGES = ("ros1", "mavlink")
HERE = {"endpoints": {"r_0": "udp:0.0.0.0:14550"}}
ORDER = {"at_s": 1.0, "cancel_task": "a"}


@pytest.mark.parametrize(
    ("world", "settings", "wrong"),
    [
        ("moon", {}, 'world: "moon"; expected kinematic or physics or ros1 or ros2 or mavlink'),
        ("ros2", {}, "world: ros2; expected kinematic, physics, ros1, mavlink: muster serve has no --bridge ros2"),
        ("kinematic", {"drive": "goals"}, "drive: unknown; did you mean 'drain'?"),
        ("kinematic", {"world": "physics"}, "settings: world; expected it beside settings, if at all"),
        ("kinematic", {"seed": -1}, "seed: -1; expected a whole number of at least 0"),
        ("kinematic", {"seed": True}, "seed: true; expected a whole number"),
        ("kinematic", {"noise": [1]}, "noise: [1]; expected a mapping"),
        ("kinematic", {"noise": {"position_m": -1.0}}, "noise.position_m: -1.0; expected a finite number, at least 0"),
        ("kinematic", {"noise": {"positon_m": 1.0}}, "noise.positon_m: unknown key; expected a known key; did you"),
        ("kinematic", {"noise": {"slip": 1.5}}, "noise.slip: 1.5; expected a finite number, at least 0 and at most 1"),
        ("physics", {"avoidance": "orcas"}, 'avoidance: "orcas"; expected auto or orca or rvo or hrvo or avo or none'),
        ("physics", {"law": "thesiss"}, 'law: "thesiss"; expected profile or thesis or trajectory; did you mean'),
        ("kinematic", {"planning": {"alocator": "greedy"}}, '"alocator": unknown; expected allocator'),
        ("kinematic", {"planning": "greedy"}, 'planning: "greedy"; expected a mapping'),
        ("kinematic", {"starts": "now"}, 'starts: "now"; expected none: a run of a simulated world has no starts'),
        ("kinematic", {"orders": [ORDER] * (MOST_ORDERS + 1)}, "orders: 1001; expected at most 1000 as settings"),
        ("ros1", {"orders": [ORDER]}, "orders: 1; expected at most 0 as settings; others by POST /runs/RUN/orders"),
        ("ros1", {"dt_s": 0.2}, "dt_s: 0.2; expected none: a run of real robots has no dt_s"),
        ("mavlink", HERE | {"local_frame": "east"}, 'local_frame: "east"; expected north or forward'),
        ("mavlink", HERE | {"at_end": "fly"}, 'at_end: "fly"; expected hold or return or land'),
        ("mavlink", {"arm": True}, "endpoints: missing; expected a mapping from each robot to its endpoint"),
        ("ros1", {"drive": "WP"}, 'drive: "WP"; expected cmd_vel or goals'),
        ("ros1", {"known_only": "yes"}, 'known_only: "yes"; expected true or false'),
        ("mavlink", {"endpoints": {"r_0": 1.5}}, "endpoints.r_0: 1.5; expected a text"),
    ],
)
def test_what_no_world_can_be_told(world, settings, wrong):
    with pytest.raises(ParameterError) as refused:
        new_request(world, BRIDGES, settings)
    assert str(refused.value).startswith(wrong)


def test_what_worlds_can_be_told():
    new_request("physics", (), {"seed": 3, "dt_s": 0.05, "avoidance": "orca", "noise": {"position_m": 0}})
    new_request("ros1", BRIDGES, {"planning": {"allocator": "greedy", "rewire": True}, "odometry": "start"})
    new_request("mavlink", BRIDGES, {**HERE, "arm": True, "height_m": 10}, 1.0)


def test_real_robots_have_their_own_speed():
    with pytest.raises(ParameterError, match=r"speed: 2\.0; expected 1: real robots have their own speed"):
        new_request("ros1", BRIDGES, {}, 2.0)
