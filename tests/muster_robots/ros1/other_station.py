"""Another station, by rospy: sends a robot to X Y, TOPIC of `action` or `topic` as the next word says, and ends."""

import sys
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy
from geometry_msgs.msg import PoseStamped

from muster_robots.ros1.action_types import move_base_types

topic, by, x, y = sys.argv[1:]
rospy.init_node("rviz", disable_signals=True)
kind = move_base_types().goal if by == "action" else PoseStamped
publisher = rospy.Publisher(topic, kind, queue_size=1)
while publisher.get_num_connections() < 1:
    time.sleep(0.05)
time.sleep(0.5)  # its other subscribers may connect a little later
place = PoseStamped()
place.header.frame_id, place.pose.orientation.w = "map", 1.0
place.pose.position.x, place.pose.position.y = float(x), float(y)
message = place
if by == "action":
    message = kind()
    message.goal_id.id, message.goal.target_pose = "/rviz-1-12.5", place
publisher.publish(message)
time.sleep(0.5)
