"""A request that is refused, and why."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from starlette.exceptions import HTTPException

from muster_control.problem import problem_content


class RefusalError(HTTPException):
    """A refused request; `detail` is one line for a person.

    Parameters
    ----------
    status
        of HTTP.
    why
        one line that names what was found and what was expected.
    retry_s
        seconds until the request may be repeated.
    """

    def __init__(self, status: int, why: str, *, retry_s: float | None = None) -> None:
        headers = {} if retry_s is None else {"retry-after": str(max(1, math.ceil(retry_s)))}
        super().__init__(status, printable(why), headers)

    def as_problem(self) -> Mapping[str, Any]:
        """The refusal as problem JSON."""
        return problem_content(self.status_code, self.detail)


def printable(text: str, most: int = 200) -> str:
    """Text from a client for one line of a log: shortened, without control characters."""
    cut = text if len(text) <= most else text[: most - 3] + "..."
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "backslashreplace").decode() for c in cut)
