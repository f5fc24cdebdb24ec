"""Teams without a map: ways that they find, tasks that they do, and how fast they explore."""

from muster_studies.unknown.study import UNKNOWN

__all__ = ["UNKNOWN"]
