"""The door to robots on ROS 1 (Noetic): ports over topics, the high-level controller's nodes, a simulated robot's node.

After [tcf-thesis], sections 5.2 and 5.3. `odometer`, `follower`, `steering`, `clock` and `discovery` know nothing of
ROS.
"""
