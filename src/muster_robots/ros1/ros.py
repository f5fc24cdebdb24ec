"""All imports of ROS 1 packages, in one place, after the system's packages were found."""

from muster_robots.ros1.extra import require_rospy

require_rospy()

import rosgraph  # noqa: E402
import rospy  # noqa: E402
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray  # noqa: E402
from genpy.dynamic import generate_dynamic  # noqa: E402
from geometry_msgs.msg import Point, PoseStamped, PoseWithCovarianceStamped, TransformStamped, Twist  # noqa: E402
from nav_msgs.msg import OccupancyGrid, Odometry  # noqa: E402
from std_msgs.msg import String  # noqa: E402
from std_srvs.srv import Trigger, TriggerResponse  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

__all__ = [
    "GoalID",
    "GoalStatus",
    "GoalStatusArray",
    "OccupancyGrid",
    "Odometry",
    "Point",
    "PoseStamped",
    "PoseWithCovarianceStamped",
    "String",
    "TFMessage",
    "TransformStamped",
    "Trigger",
    "TriggerResponse",
    "Twist",
    "generate_dynamic",
    "rosgraph",
    "rospy",
]
