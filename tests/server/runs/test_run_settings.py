"""What may be asked of a run is checked before anything is started."""

from dataclasses import fields

import pytest

from muster.cli import fly, ros, ros2, simulate
from muster.mission.errors import ParameterError
from muster.server.runs.run_settings import CHOICES, NOISE, require_world
from muster.simulation.noise import Noise

BRIDGES = ("ros1", "mavlink")


@pytest.mark.parametrize(
    ("world", "settings", "wrong"),
    [
        ("moon", {}, "world: moon; expected kinematic, physics, ros1, mavlink"),
        ("ros2", {}, "world: ros2; expected kinematic, physics, ros1, mavlink"),
        (
            "kinematic",
            {"drive": "goals"},
            "drive: no setting of world kinematic; expected seed, ignore, planning, stay, until_s, traffic, dt_s",
        ),
        ("kinematic", {"seed": -1}, "seed: -1; expected a whole number, 0 to"),
        ("kinematic", {"seed": True}, "seed: true; expected a whole number"),
        ("kinematic", {"noise": [1]}, "noise: [1]; expected a mapping"),
        ("kinematic", {"noise": {"position_m": -1.0}}, "position_m: -1.0; expected a number, 0 to inf"),
        ("kinematic", {"noise": {"positon_m": 1.0}}, "noise: positon_m; expected velocity, slip, "),
        ("kinematic", {"noise": {"slip": 1.5}}, "slip: 1.5; expected a number, 0 to 1"),
        (
            "physics",
            {"avoidance": "orcas"},
            "avoidance: orcas; expected auto, orca, rvo, hrvo, avo, none; did you mean 'orca'?",
        ),
        ("physics", {"law": "thesiss"}, "law: thesiss; expected profile, thesis, trajectory; did you mean 'thesis'?"),
        ("kinematic", {"planning": {"alocator": "greedy"}}, '"alocator": unknown; expected allocator'),
        ("kinematic", {"planning": "greedy"}, 'planning: "greedy"; expected a mapping'),
        ("mavlink", {"local_frame": "east"}, "local_frame: east; expected north, forward"),
        ("mavlink", {"at_end": "fly"}, "at_end: fly; expected hold, return, land"),
        ("ros1", {"drive": "WP"}, "drive: WP; expected cmd_vel, goals"),
        ("ros1", {"known_only": "yes"}, 'known_only: "yes"; expected true or false'),
        ("mavlink", {"endpoints": {"r_0": 14550}}, "endpoints.r_0: 14550; expected a text"),
    ],
)
def test_what_no_world_can_be_told(world, settings, wrong):
    with pytest.raises(ParameterError) as refused:
        require_world(world, BRIDGES, settings)
    assert str(refused.value).startswith(wrong)


def test_what_worlds_can_be_told():
    require_world("physics", (), {"seed": 3, "dt_s": 0.05, "avoidance": "orca", "noise": {"position_m": 0}})
    require_world("ros1", BRIDGES, {"planning": {"allocator": "greedy", "rewire": True}, "odometry": "start"})
    require_world("mavlink", BRIDGES, {"endpoints": {"r_0": "udp:0.0.0.0:14550"}, "arm": True, "height_m": 10})


def test_the_words_are_those_that_worlds_understand():
    assert tuple(field.name for field in fields(Noise)) == NOISE
    verbs = (simulate, ros, ros2, fly)
    options = {option.name: option.type for verb in verbs for option in verb.command.params}
    assert {name: tuple(options[name].choices) for name in CHOICES} == dict(CHOICES)
