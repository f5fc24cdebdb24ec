"""A robot that knows nothing of Muster: NAME X Y; does as cmd_vel says.

`pose`: it says PoseStamped instead of Odometry. `frame=NAME`: its poses are in that frame, whose origin is at (10, -5)
of the map, turned by a right angle. `tied`: it tells tf so. `namespace=NAME`: in which its own is. `topic=NAME`: where
it says its pose, in place of its own. `up=Z`: how high it begins. `by_hand=SPEED`: a person drives it ahead, m/s, until
it is told a velocity.
"""

import math
import sys
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

name, x, y, *words = sys.argv[1:]
given = dict(word.partition("=")[::2] for word in words)
frame, own = given.get("frame", "map"), "/".join(["", *filter(None, [given.get("namespace")]), name])
x, y, z, heading = float(x), float(y), float(given.get("up", 0)), 0.0
told = [Twist()]
told[0].linear.x = float(given.get("by_hand", 0))
rospy.init_node(name)
rospy.Subscriber(f"{own}/cmd_vel", Twist, lambda twist: told.append(twist))
kind = PoseStamped if "pose" in given else Odometry
poses = rospy.Publisher(given.get("topic", own + ("/pose" if "pose" in given else "/odom")), kind, queue_size=1)
tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
while not rospy.is_shutdown():
    time.sleep(0.05)
    twist = told[-1]
    heading += 0.05 * twist.angular.z
    x += 0.05 * (math.cos(heading) * twist.linear.x - math.sin(heading) * twist.linear.y)
    y += 0.05 * (math.sin(heading) * twist.linear.x + math.cos(heading) * twist.linear.y)
    z += 0.05 * twist.linear.z
    message = PoseStamped() if "pose" in given else Odometry()
    message.header.frame_id, message.header.stamp = frame, rospy.Time.now()
    pose, yaw = (message.pose if "pose" in given else message.pose.pose), heading
    pose.position.x, pose.position.y, pose.position.z = x, y, z
    if frame != "map":
        pose.position.x, pose.position.y, yaw = y + 5, 10 - x, heading - math.pi / 2
    pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    if "pose" not in given:
        message.twist.twist = twist
    poses.publish(message)
    if "tied" in given:
        tie = TransformStamped()
        tie.header.frame_id, tie.child_frame_id, tie.header.stamp = "map", frame, rospy.Time.now()
        tie.transform.translation.x, tie.transform.translation.y = 10, -5
        tie.transform.rotation.z = tie.transform.rotation.w = math.sqrt(0.5)
        tf.publish(TFMessage([tie]))
