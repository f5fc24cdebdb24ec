"""The tables of docs/estimation.md: how far robots are off as they say and fused, in both worlds; means of five seeds.

Printed by `python -m tests.fused_poses`.
"""

import tempfile
from pathlib import Path

import click
import numpy as np

from muster.perception.errors import AirErrors, GroundErrors
from muster.perception.pose_tracking import AirTracker, GroundTracker
from tests.perception.test_pose_tracking import flown, mission
from tests.running.test_state_estimation import watched

SEEDS = range(5)
ROVER = "position: [0, 0], kinematics: differential-drive, speed_mps: 0.26, yaw_rate_radps: 1.82"
SQUARE = [(3, 0, 0), (3, 3, 0), (0, 3, 0), (0, 0, 0)] * 2
DRONE = "position: [0, 0, 1], kind: air, kinematics: quadcopter, speed_mps: 1"
TRIANGLE = [(10, 0, 3), (10, 10, 3), (0, 0, 1)] * 2


def by_reports(folder):
    """Of reports that are 0.1, 0.5 and 1 s apart."""
    for steps in (1, 5, 10):
        rows = []
        for seed in SEEDS:
            ground = GroundTracker(GroundErrors(position_m=0.1, heading_rad=0.05, odometry_share=0.05))
            air = AirTracker(AirErrors(position_m=0.1, acceleration_mps2=1.0, odometry_slip=0.05))
            rows.append(
                [
                    *flown(mission(folder, ROVER), ground, SQUARE, steps, seed),
                    *flown(mission(folder, DRONE), air, TRIANGLE, steps, seed),
                ]
            )
        click.echo(" | ".join([f"{steps / 10} s", *(f"{metres:.3f} m" for metres in np.mean(rows, axis=0))]))


def by_missions():
    """Of missions carried out: places, headings, and the normalised innovation squared by degree of freedom."""
    for name in ("6T-2R", "11T-2R", "16T-3R-actions", "auction-1"):
        for world in ("kinematic", "physics"):
            rows = []
            for seed in SEEDS:
                team, hearing = watched(name, world, seed=seed)
                places = np.sqrt((np.array(hearing.places) ** 2).sum(axis=3).mean(axis=(0, 2)))
                headings = np.sqrt((np.array(hearing.headings) ** 2).mean(axis=(0, 2)))
                nis = np.concatenate(list(hearing.innovations.values())).mean() / team.dimensions
                rows.append([*places, *headings, nis])
            said, fused, turned, facing, nis = np.mean(rows, axis=0)
            figures = [f"{said:.3f} m", f"{fused:.3f} m", f"{turned:.3f}", f"{facing:.4f}", f"{nis:.2f}"]
            click.echo(" | ".join([name, world, *figures]))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        by_reports(Path(folder))
    by_missions()
