"""The bridge to robots on ROS 1 (Noetic): ports over topics, nodes of the high-level controller, a simulated robot.

After [tcf-thesis], sections 5.2 and 5.3. `odometer`, `follower`, `steering`, `clock` and `discovery` know nothing of
ROS.
"""
