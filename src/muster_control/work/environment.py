"""The environment of processes that read missions of users: the server's environment without secrets."""

from __future__ import annotations

import re
from collections.abc import Mapping

_SECRET = re.compile(r"(?!ROS_)(MUSTER_DB|PG.*|.*(PASS|TOKEN|SECRET|CREDENTIAL|KEY).*|.*_(URL|DSN))")


def without_secrets(environment: Mapping[str, str]) -> dict[str, str]:
    """The environment without variables whose names tell of secrets; those of ROS (ROS_*) stay."""
    return {name: value for name, value in environment.items() if not _SECRET.fullmatch(name.upper())}
