"""The deviation of robots from a recorded reference trajectory: (7) and (8) of [market-paper]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.values.arrays import Floats
from muster.motion.metrics import TrajectoryError, path_length, risk_factor, trajectory_error
from muster.report.record import Recording
from muster_robots.recordings.poses import PoseTrack
from muster_robots.ros2.names import ros_name

_CLOCK_S = 1e-6
"""To so much seconds since 1970 are exact."""


@dataclass(frozen=True)
class Reference:
    """The reference trajectories of robots.

    Parameters
    ----------
    tracks
        by robot, in metres of the map frame.
    begins_s
        the time on the tracks' clock at which the mission's clock is 0.
    """

    tracks: Mapping[str, PoseTrack]
    begins_s: float

    @classmethod
    def of(
        cls,
        recording: Recording,
        tracks: Mapping[str, PoseTrack],
        topics: Mapping[str, str],
        begins_s: float | None = None,
    ) -> Reference:
        """The tracks of robots.

        Parameters
        ----------
        tracks
            of a recording, by topic.
        topics
            of a robot; of one that is not named `/<robot>/odom`, or `/<robot>/pose`, where there is such.
        begins_s
            None: the first pose of all chosen tracks is at the first pose of their robots.

        Raises
        ------
        ParameterError
            if there is no such robot or topic, or no robot has a topic.
        """
        chosen = {robot: tracks[topic] for robot, topic in _topics(recording, tracks, topics).items()}
        if begins_s is None:
            begins_s = min(float(track.times_s[0]) for track in chosen.values()) - _first_s(recording, chosen)
        return cls(chosen, begins_s)


def _topics(recording: Recording, tracks: Mapping[str, PoseTrack], topics: Mapping[str, str]) -> Mapping[str, str]:
    chosen = {}
    for robot, topic in topics.items():
        if robot not in recording.tracks.robots:
            hint = did_you_mean(robot, recording.tracks.robots)
            raise ParameterError(f"--topic: no robot {robot!r} in the record{hint}")
        if topic not in tracks:
            raise ParameterError(f"--topic: no poses on {topic!r}; expected one of {', '.join(tracks)}")
        chosen[robot] = topic
    for robot in recording.tracks.robots:
        usual = [f"/{ros_name(robot)}/{word}" for word in ("odom", "pose")]
        there = [topic for topic in usual if topic in tracks]
        if robot not in chosen and there:
            chosen[robot] = there[0]
    if not chosen:
        raise ParameterError(f"--reference: no topic of a robot; expected --topic ROBOT=TOPIC of {', '.join(tracks)}")
    return chosen


def _first_s(recording: Recording, chosen: Mapping[str, PoseTrack]) -> float:
    columns = [recording.tracks.robots.index(robot) for robot in chosen]
    there = np.flatnonzero(np.isfinite(recording.tracks.positions[:, columns, 0]))
    if not len(there):
        raise ParameterError(f"{recording.file}: no poses of {', '.join(chosen)}; expected where they were")
    return float(recording.tracks.times_s[there[0] // len(columns)])


@dataclass(frozen=True)
class Deviation:
    """The deviation of a robot from its reference.

    Parameters
    ----------
    samples
        moments of the record that lie within the reference.
    error
        (7): total, mean, most, in metres.
    risk
        (8), 1/m, over the same moments, by the distance to the map's obstacles; None in a mission without a map.
    travelled_m, reference_m
        the length of both over these moments.
    """

    robot: str
    topic: str
    samples: int
    error: TrajectoryError
    risk: float | None
    travelled_m: float
    reference_m: float


def deviations(recording: Recording, reference: Reference) -> list[Deviation]:
    """Each robot of a reference beside it, at the moments of the record; in a plane mission heights do not count.

    Between its poses the reference goes straight and evenly.

    Raises
    ------
    ParameterError
        if no moment of a robot lies within its reference.
    """
    return [_deviation(recording, robot, track, reference.begins_s) for robot, track in reference.tracks.items()]


def _deviation(recording: Recording, robot: str, track: PoseTrack, begins_s: float) -> Deviation:
    actual, size = recording.tracks, recording.mission.dimensions
    places = actual.positions[:, actual.robots.index(robot)]
    times = track.times_s - begins_s
    since, until = times[0] - _CLOCK_S, times[-1] + _CLOCK_S
    within = np.isfinite(places).all(axis=1) & (actual.times_s >= since) & (actual.times_s <= until)
    if not within.any():
        span = f"{times[0]:.1f} to {times[-1]:.1f} s of the mission"
        raise ParameterError(f"{track.topic}: {span}; expected a time in which the record has poses of {robot!r}")
    there = places[within]
    wanted = np.column_stack([np.interp(actual.times_s[within], times, column) for column in track.positions.T])
    return Deviation(
        robot=robot,
        topic=track.topic,
        samples=int(within.sum()),
        error=trajectory_error(wanted[:, :size], there[:, :size]),
        risk=_risk(recording, robot, there),
        travelled_m=path_length(there[:, :size]),
        reference_m=path_length(wanted[:, :size]),
    )


def _risk(recording: Recording, robot: str, places: Floats) -> float | None:
    if recording.mission.map is None:
        return None
    from muster.motion.map_world import World

    kind = next(one for one in recording.robots if one.id == robot)
    world = World.of(recording.mission, recording.image)
    return risk_factor(world.clearance(places[:, : recording.mission.dimensions], kind.kind, kind.radius_m))
