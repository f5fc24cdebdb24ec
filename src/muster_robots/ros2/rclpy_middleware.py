"""rclpy as a middleware: a node in the ROS 2 installation whose environment this is, with Nav2's action.

Polled: a single-threaded executor spins in the thread that waits (docs.ros.org, "rclpy": Executor.spin_once). A
context of our own leaves Ctrl-C to us. By the documentation of rclpy and Nav2; tested against neither: docs/ros2.md.
"""

from __future__ import annotations

import importlib
import time
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Generic, TypeVar

from muster.mission.errors import MissingExtraError, NetworkError
from muster_robots.navigation import Navigation, Outcome
from muster_robots.ros2.description import Message, from_foreign, to_foreign
from muster_robots.ros2.message_types import PoseStamped
from muster_robots.ros2.middleware import KEPT, domain_or_own, is_latched, line_of

M = TypeVar("M", bound=Message)
_LEAST_S = 0.005
"""For what has come meanwhile, however short a wait is: a spin takes one message."""
_STATUS = {4: "succeeded", 5: "canceled", 6: "aborted"}  # action_msgs/GoalStatus
_HOW = "source the setup file of a ROS 2 installation of this Python"


class RclpyMiddleware:
    """A node named `muster` in a domain: a `Middleware`.

    Raises
    ------
    MissingExtraError
        if rclpy cannot be imported.
    ParameterError
        if the domain, or ROS_DOMAIN_ID, is no number from 0 to 232.
    NetworkError
        if ROS 2 cannot start a node.
    """

    def __init__(self, domain: int | None = None) -> None:
        number = domain_or_own(domain)
        context, executors, node, qos = (_module(f"rclpy.{name}") for name in ("context", "executors", "node", "qos"))
        self._context = context.Context()
        try:
            self._context.init(args=[], domain_id=number)
            self._node = node.Node("muster", context=self._context, start_parameter_services=False)
        except RuntimeError as error:  # of which rclpy's RCLError is one
            if self._context.ok():
                self._context.try_shutdown()
            raise NetworkError(f"ROS 2 domain {number}: {line_of(error)}; see RMW_IMPLEMENTATION") from None
        self._executor = executors.SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._reliable = qos.QoSProfile(depth=KEPT, reliability=qos.ReliabilityPolicy.RELIABLE)
        self._any = qos.QoSProfile(depth=KEPT, reliability=qos.ReliabilityPolicy.BEST_EFFORT)
        durability = getattr(qos, "DurabilityPolicy", None)  # before Foxy rclpy had another name for it
        lasting = {} if durability is None else {"durability": durability.TRANSIENT_LOCAL}
        self._latched = qos.QoSProfile(depth=KEPT, reliability=qos.ReliabilityPolicy.RELIABLE, **lasting)

    def writer(self, topic: str, message: type[M]) -> RclpyWriter[M]:
        """See `Middleware`."""
        return RclpyWriter(topic, self._node.create_publisher(_class_of(message), topic, self._reliable))

    def reader(self, topic: str, message: type[M], *, latched: bool = False) -> RclpyReader[M]:
        """See `Middleware`."""
        reader = RclpyReader(message)
        quality = self._latched if latched or is_latched(topic) else self._any
        self._node.create_subscription(_class_of(message), topic, reader.hear, quality)
        return reader

    def others(self, topic: str, message: type[M]) -> None:
        """See `Middleware`: rclpy gives a node its own messages, too."""

    def navigator(self, action: str) -> RclpyNavigator:
        """See `Middleware`."""
        kind = _module("nav2_msgs.action", "install nav2_msgs").NavigateToPose
        return RclpyNavigator(_module("rclpy.action").ActionClient(self._node, kind, action), kind)

    def topics(self) -> Iterable[tuple[str, str]]:
        """See `Middleware`."""
        for topic, kinds in self._node.get_topic_names_and_types():
            if self._node.count_publishers(topic):
                for kind in kinds:
                    yield topic, kind.replace("/msg/", "/")

    def wait(self, seconds: float) -> None:
        """See `Middleware`."""
        until = time.monotonic() + max(seconds, _LEAST_S)
        while (rest := until - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=rest)

    def close(self) -> None:
        """See `Middleware`."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()


class RclpyWriter(Generic[M]):
    """See `middleware.Writer`."""

    def __init__(self, topic: str, publisher: Any) -> None:
        self._topic, self._publisher = topic, publisher

    def write(self, message: M) -> None:
        try:
            self._publisher.publish(to_foreign(message, _class_of))
        except RuntimeError as error:
            raise NetworkError(f"{self._topic}: ROS 2: {line_of(error)}") from None

    @property
    def listeners(self) -> int:
        return int(self._publisher.get_subscription_count())


class RclpyReader(Generic[M]):
    """See `middleware.Reader`."""

    def __init__(self, message: type[M]) -> None:
        self._message = message
        self._heard: deque[M] = deque(maxlen=KEPT)

    def hear(self, theirs: Any) -> None:
        """Keep a message of rclpy."""
        self._heard.append(from_foreign(self._message, theirs))

    def take(self) -> list[M]:
        heard = list(self._heard)
        self._heard.clear()
        return heard


class RclpyNavigator:
    """See `navigation.Navigator`. The goals of others are not known here: rclpy's client is told of its own alone."""

    unfit = foreign = ""

    def __init__(self, client: Any, kind: Any) -> None:
        self._client, self._kind = client, kind

    @property
    def ready(self) -> bool:
        return bool(self._client.server_is_ready())

    def go(self, goal: PoseStamped) -> Navigation[PoseStamped]:
        """Ask Nav2 to go there, by the behaviour tree that it has by default."""
        theirs = self._kind.Goal()
        theirs.pose = to_foreign(goal, _class_of)
        return _Navigation(self._client, theirs)


class _Navigation:
    """See `navigation.Navigation`: two answers are awaited, that the goal is accepted and how it ended."""

    def __init__(self, client: Any, goal: Any) -> None:
        self.outcome: Outcome | None = None
        self._poses: list[PoseStamped] = []
        self._handle: Any = None
        self._cancelled = False
        with self._failing():
            client.send_goal_async(goal, feedback_callback=self._hear).add_done_callback(self._begin)

    def take(self) -> list[PoseStamped]:
        poses, self._poses = self._poses, []
        return poses

    def cancel(self) -> None:
        self._cancelled = True
        if self._handle is not None and self.outcome is None:
            self._ask_to_cancel()

    def _hear(self, message: Any) -> None:
        self._poses.append(from_foreign(PoseStamped, message.feedback.current_pose))

    def _ask_to_cancel(self) -> None:
        try:
            self._handle.cancel_goal_async()
        except RuntimeError as error:
            raise NetworkError(f"a goal cannot be cancelled: ROS 2: {line_of(error)}") from None

    def _begin(self, future: Any) -> None:
        with self._failing():
            handle = future.result()
            if not handle.accepted:
                self.outcome = Outcome("rejected")
                return
            self._handle = handle
            handle.get_result_async().add_done_callback(self._end)
        if self._cancelled and self._handle is not None:  # before it was known by which name
            self._ask_to_cancel()

    def _end(self, future: Any) -> None:
        """Nav2 gives the reason as a number since ROS 2 Iron, as text since Kilted."""
        with self._failing():
            answer = future.result()
            code, words = getattr(answer.result, "error_code", 0), getattr(answer.result, "error_msg", "")
            status: Any = _STATUS.get(answer.status, "aborted")
            self.outcome = Outcome(status, words or (f"error {code}" if code else ""))

    @contextmanager
    def _failing(self) -> Iterator[None]:
        """What fails in rclpy, or on the way to the server, ends the goal and nothing else."""
        try:
            yield
        except Exception as error:
            self.outcome = Outcome("aborted", line_of(error))


def _module(name: str, how: str = _HOW) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise MissingExtraError("ros2", "ROS 2 by rclpy", f"{how}, or use DDS ({error})") from None


def _class_of(message: type[Message]) -> Any:
    package, _, name = message.NAME.partition("/")
    return getattr(_module(f"{package}.msg", f"install {package}"), name)
