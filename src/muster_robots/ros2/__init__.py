"""The bridge to robots on ROS 2, with or without an installed ROS: over rclpy or DDS."""
