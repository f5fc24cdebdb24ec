"""Ways over areas beside a lower bound, beside spanning trees, and shared among robots."""

from muster_studies.areas.study import AREAS

__all__ = ["AREAS"]
