"""rclpy as far as the bridge uses it, without ROS: its modules by their names, in one process, without a network.

By the documentation and source of rclpy (docs.ros.org; ros2/rclpy: action/client.py, executors.py, task.py, qos.py)
and the messages that rosidl generates: fields check their types, publishers and subscriptions match by quality of
service, nothing is called back but in `spin_once`, which takes one callback, and futures end there.
"""

import array
import sys
import time
import types
from collections import deque
from types import SimpleNamespace

from muster_robots.ros2.description import ROS2, fields_of
from muster_robots.ros2.message_types import MESSAGES


class Graph:
    """All nodes; `pending` callbacks of each context are run by its executor."""

    def __init__(self):
        self.topics = {}  # name -> [(kind, publishers, subscriptions)]
        self.servers = {}  # of actions, by name
        self.robots = []
        self.contexts = []

    def serve(self):
        """Robots go on as often as nothing else is done."""
        for robot in self.robots:
            robot.look()

    def topic(self, name, kind):
        return self.topics.setdefault((name, kind), ([], []))


class Context:
    graph = None  # of the test

    def __init__(self):
        self.domain, self.pending, self.up = None, deque(), False

    def init(self, args=None, *, initialize_logging=True, domain_id=None):
        if self.domain is not None:
            raise RuntimeError("Context.init() must only be called once")
        assert args == []  # those of the process are not ROS'
        self.domain, self.up = domain_id, True
        self.graph.contexts.append(self)

    def ok(self):
        return self.up

    def try_shutdown(self):
        self.up = False


class SingleThreadedExecutor:
    def __init__(self, *, context=None):
        self._context, self._nodes = context, []

    def add_node(self, node):
        self._nodes.append(node)
        return True

    def spin_once(self, timeout_sec=None):
        """Wait for and execute a single callback."""
        until = time.monotonic() + timeout_sec
        while not self._context.pending:
            self._context.graph.serve()
            if time.monotonic() >= until:
                return
            time.sleep(0.001)
        self._context.pending.popleft()()

    def shutdown(self, timeout_sec=None):
        self._nodes = []
        return True


class ReliabilityPolicy:
    RELIABLE, BEST_EFFORT = 1, 2


class DurabilityPolicy:
    TRANSIENT_LOCAL, VOLATILE = 1, 2


class QoSProfile:
    def __init__(self, **kwargs):
        assert "history" in kwargs or "depth" in kwargs, "History and/or depth settings are required."
        self.depth = kwargs.pop("depth", 0)
        self.reliability = kwargs.pop("reliability", ReliabilityPolicy.RELIABLE)
        self.durability = kwargs.pop("durability", DurabilityPolicy.VOLATILE)
        assert not kwargs, kwargs


class Publisher:
    def __init__(self, graph, kind, topic, qos):
        self._kind, self._qos = kind, qos
        self._others = graph.topic(topic, kind)[1]

    def _matched(self):
        """Best effort is not enough for who wants reliability."""
        asked = [other for other in self._others if other.context.up]
        return [other for other in asked if self._qos.reliability <= other.qos.reliability]

    def publish(self, message):
        if not isinstance(message, self._kind):
            raise TypeError
        for other in self._matched():
            other.hear(message)

    def get_subscription_count(self):
        return len(self._matched())


class Subscription:
    def __init__(self, context, callback, qos):
        self.context, self._callback, self.qos, self._heard = context, callback, qos, deque(maxlen=qos.depth)

    def hear(self, message):
        self._heard.append(message)
        self.context.pending.append(self._take)

    def _take(self):
        if self._heard:
            self._callback(self._heard.popleft())


class Node:
    def __init__(self, node_name, *, context=None, start_parameter_services=True):
        assert context.ok()
        self.name, self.context = node_name, context

    def create_publisher(self, msg_type, topic, qos_profile):
        publisher = Publisher(self.context.graph, msg_type, topic, qos_profile)
        self.context.graph.topic(topic, msg_type)[0].append(publisher)
        return publisher

    def create_subscription(self, msg_type, topic, callback, qos_profile):
        subscription = Subscription(self.context, callback, qos_profile)
        self.context.graph.topic(topic, msg_type)[1].append(subscription)
        return subscription

    def get_topic_names_and_types(self, no_demangle=False):
        return [(name, [kind.NAME]) for name, kind in self.context.graph.topics]

    def count_publishers(self, topic_name):
        return sum(len(found[0]) for (name, _), found in self.context.graph.topics.items() if name == topic_name)

    def destroy_node(self):
        self.name = None


class Future:
    """rclpy.task.Future: callbacks are run by the executor."""

    def __init__(self, context):
        self._context, self._result, self._done, self._callbacks = context, None, False, []
        self._exception = None

    def done(self):
        return self._done

    def result(self):
        if self._exception is not None:
            raise self._exception
        return self._result

    def set_exception(self, exception):
        self._exception = exception
        self.set_result(None)

    def set_result(self, result):
        self._result, self._done = result, True
        for callback in self._callbacks:
            self._context.pending.append(lambda callback=callback: callback(self))

    def add_done_callback(self, callback):
        if self._done:
            self._context.pending.append(lambda: callback(self))
        else:
            self._callbacks.append(callback)


class ClientGoalHandle:
    def __init__(self, client, goal, accepted):
        self._client, self._goal, self.accepted = client, goal, accepted

    def get_result_async(self):
        return self._goal.result

    def cancel_goal_async(self):
        if self._goal.how == "deaf":
            raise RuntimeError("no client")
        self._goal.cancel_asked = True
        return Future(self._client.context)


class ActionClient:
    def __init__(self, node, action_type, action_name):
        self.context, self._type, self._name = node.context, action_type, action_name

    def server_is_ready(self):
        return self._name in self.context.graph.servers

    def send_goal_async(self, goal, feedback_callback=None, goal_uuid=None):
        if not isinstance(goal, self._type.Goal):
            raise TypeError
        future = Future(self.context)
        self.context.graph.servers[self._name].take(self, goal, future, feedback_callback)
        return future


class Nav2:
    """A server of the action and its robot, which goes straight at `speed` m a look, and says its pose.

    Parameters
    ----------
    script
        for each goal how it ends: `go` (it arrives), `abort`, `reject`, `hang`; `lose`, `break`: whether it is
        accepted, or how it ended, does not come through; `deaf`: it cannot be cancelled; the last holds for all
        that follow.
    brakes
        looks that it takes to end a goal that is cancelled.
    """

    def __init__(self, graph, name, place, *, script=("go",), speed=0.3, brakes=1, says="pose"):
        self.graph, self.place, self.speed, self.script = graph, place, speed, list(script)
        self.brakes = brakes
        self.goals, self.ended, self._under_way = [], [], None
        self._talks = says
        context = Context()
        context.init(args=[], domain_id=0)
        node, best = Node(name, context=context), QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        node.create_subscription(MODULES["geometry_msgs.msg"].PoseStamped, f"/{name}/goal_pose", lambda _: None, best)
        if says:
            self._said = node.create_publisher(MODULES["geometry_msgs.msg"].PoseStamped, f"/{name}/{says}", best)
        graph.servers[f"/{name}/navigate_to_pose"] = self
        graph.robots.append(self)

    def take(self, client, goal, answer, feedback):
        how = self.script.pop(0) if len(self.script) > 1 else self.script[0]
        at = goal.pose.pose.position
        goal = SimpleNamespace(at=(at.x, at.y), how=how, feedback=feedback, cancel_asked=False, braked=0, client=client)
        goal.result = Future(client.context)
        self.goals.append(goal)
        assert self._under_way is None, "two goals at once"
        if how == "lose":
            answer.set_exception(RuntimeError("no answer\nto the goal"))
            return
        handle = ClientGoalHandle(client, goal, how != "reject")
        if handle.accepted:
            self._under_way = goal
        answer.set_result(handle)

    def look(self):
        goal = self._under_way
        if goal is not None and goal.cancel_asked:
            goal.braked += 1
            if goal.braked >= self.brakes:
                self._end(goal, 5)
        elif goal is not None and goal.how == "abort":
            self._end(goal, 6, 9003, "no way")
        elif goal is not None and goal.how == "break":
            self._under_way = None
            goal.result.set_exception(RuntimeError("no result"))
        elif goal is not None and goal.how == "go":
            x, y = self.place
            way = ((goal.at[0] - x) ** 2 + (goal.at[1] - y) ** 2) ** 0.5
            share = min(1.0, self.speed / way) if way else 1.0
            self.place = (x + share * (goal.at[0] - x), y + share * (goal.at[1] - y))
            message = SimpleNamespace(feedback=SimpleNamespace(current_pose=self._pose()))
            goal.client.context.pending.append(lambda: goal.feedback(message))
            if way <= self.speed:
                self._end(goal, 4)
        if self._talks:
            self._said.publish(self._pose())

    def _end(self, goal, status, code=0, words=""):
        self._under_way = None
        self.ended.append(status)
        goal.result.set_result(SimpleNamespace(status=status, result=_result(code, words)))

    def _pose(self):
        messages = MODULES["geometry_msgs.msg"], MODULES["std_msgs.msg"]
        place = messages[0].Point(x=float(self.place[0]), y=float(self.place[1]))
        pose = messages[0].Pose(position=place, orientation=messages[0].Quaternion(w=1.0))
        return messages[0].PoseStamped(header=messages[1].Header(frame_id="map"), pose=pose)


def _result(code, words):
    return SimpleNamespace(error_code=code, error_msg=words)


_WORDS = {"float64": float, "float32": float, "int32": int, "uint32": int, "bool": bool, "string": str}


def _generated(message):
    """The class that rosidl generates: keyword arguments, defaults, fields that check their types."""
    fields = {field.name: field for field in fields_of(message, ROS2)}

    def init(self, **kwargs):
        assert set(kwargs) <= set(fields), f"Invalid arguments passed to constructor: {set(kwargs) - set(fields)}"
        for name, field in fields.items():
            setattr(self, name, kwargs[name] if name in kwargs else _default(field))

    def setattr_(self, name, value):
        field = fields[name]
        kind = _WORDS.get(field.kind, object) if isinstance(field.kind, str) else GENERATED[field.kind]
        if field.is_list:
            assert isinstance(value, (list, tuple, array.array, bytes)), name
            assert not field.length or len(value) == field.length, name
            assert all(isinstance(one, kind) for one in value), name
        else:
            assert isinstance(value, kind), f"The '{name}' field must be of type '{kind.__name__}'"
        object.__setattr__(self, name, value)

    body = {"__init__": init, "__setattr__": setattr_, "NAME": message.NAME.replace("/", "/msg/")}
    return type(message.NAME.partition("/")[2], (), body)


def _default(field):
    if field.is_list:
        return [0.0] * field.length if field.length else []
    return _WORDS[field.kind]() if isinstance(field.kind, str) else GENERATED[field.kind]()


GENERATED = {message: _generated(message) for message in MESSAGES.values()}


class NavigateToPose:
    class Goal:
        def __init__(self):
            self.pose, self.behavior_tree = None, ""


def _modules():
    made = {
        "rclpy": {},
        "rclpy.action": {"ActionClient": ActionClient},
        "rclpy.context": {"Context": Context},
        "rclpy.executors": {"SingleThreadedExecutor": SingleThreadedExecutor},
        "rclpy.node": {"Node": Node},
        "rclpy.qos": {
            "QoSProfile": QoSProfile,
            "ReliabilityPolicy": ReliabilityPolicy,
            "DurabilityPolicy": DurabilityPolicy,
        },
        "nav2_msgs": {},
        "nav2_msgs.action": {"NavigateToPose": NavigateToPose},
    }
    for message, kind in GENERATED.items():
        package, _, name = message.NAME.partition("/")
        made.setdefault(package, {})
        made.setdefault(f"{package}.msg", {})[name] = kind
    modules = {name: types.ModuleType(name) for name in made}
    for name, body in made.items():
        modules[name].__dict__.update(body)
        modules[name].__spec__ = SimpleNamespace(name=name)
    return {name: SimpleNamespace(**body) if name.endswith(".msg") else modules[name] for name, body in made.items()}


MODULES = _modules()


def install(monkeypatch):
    """Let rclpy be importable; returns the graph of its nodes."""
    graph = Graph()
    monkeypatch.setattr(Context, "graph", graph)
    for name, module in MODULES.items():
        monkeypatch.setitem(sys.modules, name, module)
    return graph
