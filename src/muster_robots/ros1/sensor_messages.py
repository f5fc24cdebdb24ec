"""The imports of sensor_msgs and visualization_msgs, which not every node needs; see `ros`."""

from muster_robots.ros1.extra import require_rospy

require_rospy(("sensor_msgs", "visualization_msgs"))

from sensor_msgs.msg import CameraInfo, Image, LaserScan  # noqa: E402
from visualization_msgs.msg import Marker, MarkerArray  # noqa: E402

__all__ = ["CameraInfo", "Image", "LaserScan", "Marker", "MarkerArray"]
