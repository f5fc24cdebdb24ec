"""Explanations: which tasks can never be done, why tasks are left out, why a robot does a task."""

from muster.planning.explaining.explanations import (
    EXPLAIN_TIME_LIMIT_S,
    LeftOut,
    OneTask,
    left_out,
    one_task,
    require_fit,
)
from muster.planning.explaining.impossible import Possible, possible
from muster.planning.explaining.unseen_searches import unseen_findings, unseen_in_plan

__all__ = [
    "EXPLAIN_TIME_LIMIT_S",
    "LeftOut",
    "OneTask",
    "Possible",
    "left_out",
    "one_task",
    "possible",
    "require_fit",
    "unseen_findings",
    "unseen_in_plan",
]
