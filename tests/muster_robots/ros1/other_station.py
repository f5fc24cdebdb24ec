"""Another station, by rospy: TOPIC `action` or `topic` X Y COUNT.

It says when it is there, and waits for a line; then it sends a robot to X Y once COUNT subscribers hear that. A goal of
an action is sent again until the robot says that it pursues it: one of Muster's that comes then takes its place.
"""

import itertools
import sys
import threading
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from geometry_msgs.msg import PoseStamped

from muster_robots.ros1.action_types import move_base_types

topic, by, x, y, count = sys.argv[1:]
rospy.init_node("rviz", disable_signals=True)
kind = move_base_types().goal if by == "action" else PoseStamped
publisher = rospy.Publisher(topic, kind, queue_size=1)
place = PoseStamped()
place.header.frame_id, place.pose.orientation.w = "map", 1.0
place.pose.position.x, place.pose.position.y = float(x), float(y)
message = place
if by == "action":
    message = kind()
    message.goal.target_pose = place
print("there", flush=True)  # noqa: T201 - to the test
sys.stdin.readline()
while publisher.get_num_connections() < int(count):
    time.sleep(0.02)
if by == "action":
    pursued = threading.Event()

    def hear(states):
        if any((it.goal_id.id, it.status) == (message.goal_id.id, GoalStatus.ACTIVE) for it in states.status_list):
            pursued.set()

    rospy.Subscriber(f"{topic.removesuffix('goal')}status", GoalStatusArray, hear)
    for number in itertools.count(1):
        message.goal_id.id = f"/rviz-{number}-12.5"
        publisher.publish(message)
        if pursued.wait(1.0):
            break
else:
    publisher.publish(message)
sys.stdin.readline()  # until the test ends
