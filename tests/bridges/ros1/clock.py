"""A simulator's clock that knows nothing of Muster: TIMES real time, said on /clock 100 times a second.

With BACK it stands for a second when robot r_0 is that far east, and begins again at 100: a world that is reset.
"""

import math
import sys
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock

rospy.init_node("simulator")
said = rospy.Publisher("/clock", Clock, queue_size=1)
times, back = float(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else math.inf
east = [0.0]
rospy.Subscriber("/r_0/odom", Odometry, lambda message: east.append(message.pose.pose.position.x))
at, last = 1000.0, time.monotonic()
while not rospy.is_shutdown():
    time.sleep(0.01)
    now = time.monotonic()
    at, last = at + times * (now - last), now
    said.publish(Clock(rospy.Time.from_sec(at)))
    if east[-1] > back:
        time.sleep(1.0)
        at, back, last = 100.0, math.inf, time.monotonic()
