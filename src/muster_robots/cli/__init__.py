"""The verbs that move real robots, and recordings of ROS."""
