"""Cameras during a mission: what they find becomes tasks ([tcf-thesis] 4.3, 7.3).

Each camera looks at its own rate from where it truly is. Its robot takes itself to be where its estimate says, and
tilted as its inertial unit says, both with the world's noise. What it sees becomes part of its estimate, so that a tag
is as uncertain as the robot was, and a tag that is seen again corrects the robot. What a silent robot sees is lost.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from muster.execution.reports.report import FoundReport, Report
from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission, Robot
from muster.motion.frames import angles, wrapped
from muster.motion.grid import Floats
from muster.motion.port import Telemetry
from muster.perception.camera import View, intrinsics_of_mission, mount_of_mission
from muster.perception.camera_observer import CameraObserver
from muster.perception.found_tasks import FoundTasks
from muster.perception.ground_sightings import LevelCamera
from muster.perception.joint_estimate import JointEstimate
from muster.perception.localisation import Uncertainty
from muster.perception.point_search import FoundCriteria, FoundPoint
from muster.perception.points_of_interest import PointOfInterest, radius_95, remarks
from muster.perception.tag_map import TagMap
from muster.running.localisation import GivenPose, PoseEstimate
from muster.running.state_estimation import LocalisedPort, RobotsInWorld
from muster.simulation import Noise, SimulatedWorld
from muster.simulation.cameras import Cameras, Look, WithCameras, true_body

OnLook = Callable[[Look], None]


@dataclass
class _Eye:
    """One robot's camera: its number in the world, when it looks next, and its images that are still on the way.

    `images` are the times at which they arrive, the true poses (4, 4) from which they were taken, and where the robot
    took itself to be then.
    """

    number: int
    observer: CameraObserver
    level: LevelCamera
    pose: PoseEstimate
    period_s: float
    due_s: float
    images: deque[tuple[float, Floats, Telemetry | None]] = field(default_factory=deque)


class CameraSearch:
    """All cameras of a team, and what they find.

    Parameters
    ----------
    mission
        its tags are what there is to be found, its `found` what becomes of that.
    world, robots
        where bodies truly are, and where robots take themselves to be.
    noise
        how much robots err about that.
    seed
        of what is random.
    on_look
        receives every look.
    proof
        when a point of interest counts as found.

    Raises
    ------
    ParameterError
        if the world has no cameras.
    MissingExtraError
        if the world's cameras need an extra that is not installed.
    """

    def __init__(
        self,
        mission: Mission,
        world: SimulatedWorld,
        robots: RobotsInWorld,
        *,
        noise: Noise,
        seed: int,
        on_look: OnLook | None = None,
        proof: FoundCriteria | None = None,
    ) -> None:
        self._mission, self._world, self._robots, self._noise = mission, world, robots, noise
        self._random = np.random.default_rng((seed, 2))
        self._on_look = on_look or (lambda look: None)
        self._sight = _cameras_of(world, mission, seed)
        self._eyes: dict[str, _Eye] = {}
        self.tasks = FoundTasks(mission, world.ground_m)
        self._remarks: dict[tuple[str, str], str] = {}
        self.search = TagMap(proof)
        for robot in mission.robots:
            self.join(robot)

    @property
    def due_s(self) -> float:
        """When a camera looks next, or an image arrives."""
        looks = [eye.due_s for eye in self._eyes.values()]
        arrivals = [arrives_s for eye in self._eyes.values() for arrives_s, *_ in eye.images]
        return min([*looks, *arrivals], default=math.inf)

    @property
    def found(self) -> tuple[FoundReport, ...]:
        """What was found so far, by time."""
        return tuple(self._told(find) for find in self.search.finds)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks for people, for the report."""
        return (*self._remarks.values(), *remarks(tuple(find.point for find in self.search.finds), self.search.seen))

    def join(self, robot: Robot) -> None:
        """A robot that is in the world looks from now on, if it has a camera."""
        if robot.camera is None:
            return
        pixel_px = self._sight.pixel_px
        observer = CameraObserver(
            robot=robot.id,
            intrinsics=intrinsics_of_mission(robot.camera),
            mount=mount_of_mission(robot.camera),
            detector=self._sight.detector,
            uncertainty=Uncertainty(pixel_px=pixel_px),
            ground_m=self._world.ground_m,
        )
        level = LevelCamera(
            intrinsics=observer.intrinsics, mount=observer.mount, ground_m=observer.ground_m, pixel_px=pixel_px
        )
        number = list(self._world.ports).index(robot.id)
        port = self._robots.ports[robot.id]
        pose = port.estimate if isinstance(port, LocalisedPort) else GivenPose(self._world, robot.id)
        self._eyes[robot.id] = _Eye(number, observer, level, pose, 1 / robot.camera.rate_hz, self._world.time_s)

    def look(self, now: float, unheard: Collection[str] = ()) -> Iterator[tuple[dict[str, Any], Event | None]]:
        """Let those look whose time has come.

        Parameters
        ----------
        now
            the mission's clock, seconds.
        unheard
            robots that cannot tell what they see, beside those whose telemetry is old.

        Yields
        ------
        what was found, or found to lie elsewhere, as the data of a `found` event of a record, and the event of a
        mission that follows from that, if any.
        """
        for robot, eye in self._eyes.items():
            k = eye.number
            if eye.due_s <= now + 1e-9:
                eye.due_s += eye.period_s * max(1, math.ceil((now - eye.due_s) / eye.period_s - 1e-9))
                body = true_body(self._world.frames[k], self._world.axes[k])
                then = self._robots.ports[robot].telemetry()
                eye.images.append((now + self._noise.camera_delay_s, body, then))
            if not eye.images or eye.images[0][0] > now + 1e-9:
                continue
            _, body, then = eye.images.popleft()
            said = None if robot in unheard else self._robots.ports[robot].telemetry()
            if said is None or said.time_s < now - self._world.dt_s / 2:
                continue
            look, finds = self._seen(eye, body, then or said, said, now)
            self._on_look(look)
            for remark in look.observation.remarks:  # what is so in many images is said once
                self._remarks.setdefault((robot, remark.partition(": ")[2]), remark)
            for find in finds:
                event = self.tasks.event(find, now)  # first: it names the task
                yield {name: value for name, value in asdict(self._told(find)).items() if name != "found_s"}, event

    def _seen(
        self, eye: _Eye, body: Floats, then: Telemetry, said: Telemetry, now: float
    ) -> tuple[Look, tuple[FoundPoint, ...]]:
        """What is in a picture that was taken from a true pose (4, 4), and what is found by it.

        The robot took itself to be where it said `then`; it matches the picture with where it is now.
        """
        world, k, tilt_rad = self._world, eye.number, self._noise.attitude_rad
        roll, pitch = angles(world.axes[k])[:2] + self._random.normal(0.0, tilt_rad, 2)
        x, y, z = np.array(said.position) + world.frames[k] - world.positions[k]
        estimate = eye.pose.looking().with_new_picture(tilt_rad)
        observer = replace(eye.observer, uncertainty=_uncertainty(estimate, eye.level.pixel_px, tilt_rad))
        view = View.from_body(observer.intrinsics, body, observer.mount)
        look = self._sight.look(observer, view, [x, y, z, roll, pitch, said.heading], now)
        seen = eye.level.seen(look.observation.sightings.all, z, roll, pitch, _moved(then, said))
        estimate, finds = self.search.take(observer.robot, estimate, seen, look.observation.estimates, now)
        eye.pose.learn(estimate)
        return replace(look, finds=self.search.finds), finds

    def refused(self, task: str) -> None:
        """What was found did not become this task after all."""
        self.tasks.refused(task)

    def snapshot(self) -> list[dict[str, Any]]:
        """Return what was found so far, as plain data for `resume`."""
        return [
            {
                **asdict(self._told(find)),
                "number": find.number,
                "position": find.point.position.tolist(),
                "covariance": find.point.covariance.tolist(),
            }
            for find in self.search.finds
        ]

    def resume(self, snapshot: Iterable[Mapping[str, Any]]) -> None:
        """Take over what was found before a run was interrupted; what was seen and not found is to be seen again."""
        for row in snapshot:
            position, covariance = np.array(row["position"]), np.array(row["covariance"])
            point = PointOfInterest(position, covariance, row["sightings"], tuple(row["robots"]), row["tag"])
            find = FoundPoint(row["tag"], row["number"], row["found_s"], point)
            self.search.resume([find])
            if row["task"] is not None:
                self.tasks.resume(find, row["task"])

    def close(self) -> None:
        """Give back what cameras hold."""
        self._sight.close()

    def _told(self, find: FoundPoint) -> FoundReport:
        point = find.point
        place = tuple(float(value) for value in point.position)
        truth = [tag.position[:2] for tag in self._mission.tags if tag.id == find.tag]
        return FoundReport(
            tag=find.tag,
            position=place,
            deviation_m=math.sqrt(float(np.linalg.eigvalsh(point.covariance)[-1])),
            sure_to_m=radius_95(point.covariance),
            error_m=min((math.dist(place, true) for true in truth), default=None),
            sightings=point.sightings,
            robots=point.robots,
            found_s=find.at_s,
            task=self.tasks.task(find),
        )


def _cameras_of(world: SimulatedWorld, mission: Mission, seed: int) -> Cameras:
    """Return the cameras of a world for a mission with tags."""
    if not isinstance(world, WithCameras):
        value = f"{len(mission.tags)} in mission {mission.name}"
        raise ParameterError(f"tags: {value}; expected none: {type(world).__name__} has no cameras")
    return world.cameras(mission.tags, seed)


def require_tags(mission: Mission, option: str) -> None:
    """Raise `ParameterError`, which names an option, if there is nothing to find in a mission."""
    if not mission.tags:
        expected = "a mission in which there is something to find"
        raise ParameterError(f"{option}: {mission.name} has no tags; expected {expected}")


def camera_search_for(
    mission: Mission, world: SimulatedWorld, robots: RobotsInWorld, **how: Any
) -> CameraSearch | None:
    """The cameras of a mission in which there is something to find; see `CameraSearch`."""
    return CameraSearch(mission, world, robots, **how) if mission.tags else None


def _uncertainty(estimate: JointEstimate, pixel_px: float, tilt_rad: float) -> Uncertainty:
    """What single sightings are uncertain by on the map."""
    x, y, _, heading = estimate.deviations
    return Uncertainty(pixel_px=pixel_px, position_m=math.hypot(x, y), angle_rad=max(tilt_rad, float(heading)))


def with_found(report: Report, camera_search: CameraSearch | None) -> Report:
    """A report with what cameras found."""
    if camera_search is None:
        return report
    return replace(report, found=camera_search.found, remarks=(*report.remarks, *camera_search.remarks))


def _moved(then: Telemetry, said: Telemetry) -> Floats:
    """How a robot has moved, (3,): metres ahead and to the left, in its axes now, and radians."""
    c, s = math.cos(said.heading), math.sin(said.heading)
    east, north = said.position[0] - then.position[0], said.position[1] - then.position[1]
    return np.array([c * east + s * north, c * north - s * east, float(wrapped(said.heading - then.heading))])
