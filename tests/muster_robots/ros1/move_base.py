"""A robot with move_base that knows nothing of Muster, by rospy alone: NAME X Y WORD...

The server of the action is as actionlib's simple server: it sends the states of its goals 5 times a second, and a new
goal preempts the one before. Its messages are made from the definitions of move_base_msgs, written out here. Odometry
begins where the robot starts, turned by a right angle, and amcl's tf ties it to the map (REP-105).

`abort=X,Y`, `reject=X,Y`: what it does with goals there. `simple`: it goes where move_base_simple/goal says, without
the action. `poses`: it says where it is, and nothing else. `untied`: nothing ties its odometry to the
map. `amcl`: amcl_pose does.
"""

import math
import sys
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from genpy.dynamic import generate_dynamic
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

LINE = "\n" + "=" * 80 + "\nMSG: "
POSE = LINE + "geometry_msgs/PoseStamped\n" + PoseStamped._full_text
STATUS = LINE + "actionlib_msgs/GoalStatus\n" + GoalStatus._full_text
HEADER = LINE + "std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id"


def made(name, text):
    return generate_dynamic(f"move_base_msgs/{name}", text)[f"move_base_msgs/{name}"]


ActionGoal = made(
    "MoveBaseActionGoal",
    f"Header header\nactionlib_msgs/GoalID goal_id\nMoveBaseGoal goal{LINE}actionlib_msgs/GoalID\ntime stamp\nstring id"
    f"{LINE}move_base_msgs/MoveBaseGoal\ngeometry_msgs/PoseStamped target_pose{POSE}",
)
ActionFeedback = made(
    "MoveBaseActionFeedback",
    f"Header header\nactionlib_msgs/GoalStatus status\nMoveBaseFeedback feedback{STATUS}"
    f"{LINE}move_base_msgs/MoveBaseFeedback\ngeometry_msgs/PoseStamped base_position{POSE}",
)
ActionResult = made(
    "MoveBaseActionResult",
    f"Header header\nactionlib_msgs/GoalStatus status\nMoveBaseResult result{STATUS}{HEADER}"
    f"{LINE}move_base_msgs/MoveBaseResult\n",
)
SPEED, DT = 3.0, 0.05
name, x, y, *words = sys.argv[1:]
given = dict(word.partition("=")[::2] for word in words)
place = start = complex(float(x), float(y))
rospy.init_node(name, disable_signals=True)


def point(word):
    return complex(*map(float, given[word].split(","))) if word in given else None


class Server:
    """`move_base`; what comes in threads of ROS is taken in by `look`."""

    def __init__(self):
        action = f"/{name}/move_base"
        self._new, self._cancels, self.goal, self._states = [], [], None, []
        self._status = rospy.Publisher(f"{action}/status", GoalStatusArray, queue_size=10)
        self._feedback = rospy.Publisher(f"{action}/feedback", ActionFeedback, queue_size=10)
        self._result = rospy.Publisher(f"{action}/result", ActionResult, queue_size=10)
        rospy.Subscriber(f"{action}/goal", ActionGoal, self._new.append)
        rospy.Subscriber(f"{action}/cancel", GoalID, self._cancels.append)
        self._said_s = 0.0

    def look(self):
        while self._new:
            self._take(self._new.pop(0))
        while self._cancels:
            cancel = self._cancels.pop(0)
            if self.goal is not None and cancel.id in ("", self.goal[0].goal_id.id):
                self._end(GoalStatus.PREEMPTED, "cancelled")
        if self.goal is not None and self.goal[1] == point("abort"):
            self._end(GoalStatus.ABORTED, "Failed to find a valid plan")
        elif self.goal is not None and abs(self.goal[1] - place) < 0.05:
            self._end(GoalStatus.SUCCEEDED, "Goal reached.")
        if time.monotonic() - self._said_s > 0.2:
            self._said_s = time.monotonic()
            self._status.publish(GoalStatusArray(status_list=list(self._states[-5:])))

    def _take(self, message):
        at = message.goal.target_pose
        assert at.header.frame_id == "map", at.header.frame_id
        if self.goal is not None:
            self._end(GoalStatus.PREEMPTED, "another goal")
        state = GoalStatus(goal_id=GoalID(message.goal_id.stamp, message.goal_id.id), status=GoalStatus.ACTIVE)
        self._states.append(state)
        self.goal = state, complex(at.pose.position.x, at.pose.position.y)
        if self.goal[1] == point("reject"):
            self._end(GoalStatus.REJECTED, "Quaternion has length close to zero")

    def _end(self, status, words):
        state, _ = self.goal
        state.status, state.text, self.goal = status, words, None
        result = ActionResult()
        result.header.stamp = rospy.Time.now()
        result.status.goal_id.id, result.status.status, result.status.text = state.goal_id.id, status, words
        self._result.publish(result)


def turned(pose, where, heading):
    pose.position.x, pose.position.y = where.real, where.imag
    pose.orientation.z, pose.orientation.w = math.sin(heading / 2), math.cos(heading / 2)


server = None if {"simple", "poses"} & set(given) else Server()
goals = []
if "simple" in given:
    rospy.Subscriber(f"/{name}/move_base_simple/goal", PoseStamped, goals.append)
odometry = rospy.Publisher(f"/{name}/odom", Odometry, queue_size=1)
fixes = rospy.Publisher(f"/{name}/amcl_pose", PoseWithCovarianceStamped, queue_size=1, latch=True)
tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
fixed_s = 0.0
while not rospy.is_shutdown():
    time.sleep(DT)
    goal = None
    if server is not None:
        server.look()
        goal = None if server.goal is None else server.goal[1]
    elif goals:
        goal = complex(goals[-1].pose.position.x, goals[-1].pose.position.y)
    if goal is not None and goal != place:
        rest = goal - place
        place += min(abs(rest), SPEED * DT) * rest / abs(rest)
    said = Odometry()
    said.header.frame_id, said.header.stamp, said.child_frame_id = f"{name}/odom", rospy.Time.now(), f"{name}/base_link"
    turned(said.pose.pose, (place - start) * -1j, -math.pi / 2)
    odometry.publish(said)
    if "amcl" in given and time.monotonic() - fixed_s > 1.0:
        fixed_s, fix = time.monotonic(), PoseWithCovarianceStamped()
        fix.header.frame_id = "map"
        turned(fix.pose.pose, place, 0.0)
        fixes.publish(fix)
    elif not {"untied", "amcl"} & set(given):
        tie = TransformStamped()
        tie.header.frame_id, tie.child_frame_id, tie.header.stamp = "map", f"{name}/odom", rospy.Time.now()
        tie.transform.translation.x, tie.transform.translation.y = start.real, start.imag
        tie.transform.rotation.z = tie.transform.rotation.w = math.sqrt(0.5)
        tf.publish(TFMessage([tie]))
