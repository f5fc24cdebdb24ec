"""A simulator's clock that knows nothing of Muster: TIMES BACK LATER; said on /clock 100 times a second.

It goes TIMES real time until robot r_0 is BACK far east, stands for a second, and begins again at 100, a world that is
reset; from there it goes LATER times real time.
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
times, back, later = map(float, sys.argv[1:])
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
        at, times, back, last = 100.0, later, math.inf, time.monotonic()
