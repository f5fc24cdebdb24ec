"""ROS 2: its standard messages, without ROS and by DDS."""
