"""What processes that read the missions of strangers may know of the server's environment: no secrets."""

from __future__ import annotations

import re
from collections.abc import Mapping

_SECRET = re.compile(r"(?!ROS_)(MUSTER_DB|PG.*|.*(PASS|TOKEN|SECRET|CREDENTIAL|KEY).*|.*_(URL|DSN))")


def without_secrets(environment: Mapping[str, str]) -> dict[str, str]:
    """The environment without what is, or may hold, a secret: by its name; what robots need (ROS_*) stays."""
    return {name: value for name, value in environment.items() if not _SECRET.fullmatch(name.upper())}
