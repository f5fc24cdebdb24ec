"""All allocators on all shipped missions and all objectives."""

from muster_studies.allocators.study import ALLOCATORS_STUDY

__all__ = ["ALLOCATORS_STUDY"]
