"""Cameras at work: images from files and devices, their intrinsics, their messages in ROS, and the detector of tags."""
