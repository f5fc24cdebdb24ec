"""Maps: from an image, a ROS map file or polygons to the free space of a body of some radius."""

from muster.motion.maps.distances import clearance_to_blocked, inflated
from muster.motion.maps.free_points import free
from muster.motion.maps.raster import default_resolution, grid_of

__all__ = ["clearance_to_blocked", "default_resolution", "free", "grid_of", "inflated"]
