"""Where a robot may be that is no longer heard."""

from types import SimpleNamespace

import pytest

from muster.mission.model import Robot
from muster.motion.port import Telemetry
from muster.traffic.reservation.part import Part

ROBOT = Robot(id="r_0", position=(0.0, 0.0), radius_m=0.3, speed_mps=1.0, acceleration_mps2=1.0, kinematics="holonomic")


def part(speed_mps, *ahead):
    said = Telemetry(5.0, (0.0, 0.0, 0.0), 0.0, (speed_mps, 0.0, 0.0), 0.0, 1, 0)
    return Part(ROBOT, SimpleNamespace(heard=said, sent_ahead=ahead), 0)


@pytest.mark.parametrize(
    ("speed_mps", "now", "farthest_m"),
    [
        (1.0, 5.0, 0.5),  # braking at once
        (1.0, 5.1, 0.6),
        (0.0, 5.0, 0.0),  # it stood
        (0.0, 5.1, 0.1 * 0.1 + 0.1**2 / 2),  # it may have set out since
        (0.0, 60.0, 1.0),  # all of its way
    ],
)
def test_it_is_on_its_way_as_far_as_it_can_have_come(speed_mps, now, farthest_m):
    places = list(part(speed_mps, (0.4, 0.0, 0.0), (0.4, 0.6, 0.0)).gone_on(now))
    lengths = [x + y for x, y in places]
    assert max(lengths, default=0.0) == pytest.approx(farthest_m)
    assert lengths == sorted(lengths)
    assert all(b - a <= ROBOT.radius_m + 1e-9 for a, b in zip([0.0, *lengths], lengths, strict=False))
