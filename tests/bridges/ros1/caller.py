"""A node that knows nothing of Muster: calls /SERVICE (Trigger), and publishes JSON, given as add_task=JSON."""

import sys
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy
from std_msgs.msg import String
from std_srvs.srv import Trigger

rospy.init_node("caller", anonymous=True)
tasks = rospy.Publisher("/command_interface/add_task", String, queue_size=10)
for asked in sys.argv[1:]:
    if asked.startswith("/"):
        rospy.wait_for_service(asked, timeout=15)
        sys.stdout.write(rospy.ServiceProxy(asked, Trigger)().message + "\n")
        time.sleep(1.0)  # so that something has begun
    else:
        while tasks.get_num_connections() == 0:
            time.sleep(0.02)
        tasks.publish(String(asked.partition("=")[2]))
