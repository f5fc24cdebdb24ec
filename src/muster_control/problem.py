"""Problem JSON (RFC 9457): the errors of every part of the server."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus
from typing import Any

from muster.mission.errors import Finding

MEDIA_TYPE = "application/problem+json"
_TYPE = "urn:muster:problem:"
_KINDS = {
    400: "wrong-input",
    401: "not-authenticated",
    403: "not-allowed",
    404: "not-found",
    405: "method-not-allowed",
    408: "body-too-slow",
    409: "conflict",
    413: "too-large",
    421: "wrong-host",
    422: "wrong-form",
    428: "base-version-missing",
    429: "busy",
    500: "internal-error",
    501: "extra-missing",
    503: "database-unavailable",
}
"""What programs tell problems apart by; a status stands for one kind."""


def problem_content(status: int, error: str, findings: Sequence[Finding] = ()) -> dict[str, Any]:
    """`type`, `title`, `status` of RFC 9457, and `error` and `findings`, which say what was wrong this time."""
    kind = _KINDS.get(status)
    return {
        "type": "about:blank" if kind is None else f"{_TYPE}{kind}",
        "title": HTTPStatus(status).phrase if kind is None else kind.replace("-", " ").capitalize(),
        "status": status,
        "error": error,
        "findings": [finding.as_dict() for finding in findings],
    }
