"""Chooses the middleware by which a domain of ROS 2 is reached: rclpy, or DDS without an installed ROS."""

from __future__ import annotations

import importlib.util

from muster_robots.ros2.middleware import By, Middleware


def open_middleware(by: By | None = None, domain: int | None = None) -> Middleware:
    """Take part in a domain, by rclpy where it can be imported and by DDS elsewhere, or as `by` says.

    Parameters
    ----------
    domain
        None: that of the environment's ROS_DOMAIN_ID.

    Raises
    ------
    MissingExtraError
        if rclpy, or the extra `ros2`, is not there.
    ParameterError
        if the domain is no number from 0 to 232.
    NetworkError
        if the network cannot be used.
    """
    if by == "rclpy" or (by is None and importlib.util.find_spec("rclpy") is not None):
        from muster_robots.ros2.rclpy_middleware import RclpyMiddleware

        return RclpyMiddleware(domain)
    from muster_robots.ros2.dds import DdsMiddleware

    return DdsMiddleware(domain)
