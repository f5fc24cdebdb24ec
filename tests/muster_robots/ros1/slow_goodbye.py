"""The node /system_monitor, whose goodbye takes a second from when its topics are closed."""

import time

from muster_robots.ros1.node import become_node, leave
from muster_robots.ros1.ros import rospy
from muster_robots.ros1.system_monitor import SystemMonitor

become_node("system_monitor")
SystemMonitor(namespace="", topics="/{}".format, frame="map")
time.sleep(1.0)  # it has reported twice
rospy.core.add_preshutdown_hook(lambda _: time.sleep(1.5))  # after rospy's own, which closes all topics
leave(within_s=5.0)
