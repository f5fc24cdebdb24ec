"""All allocators on all shipped missions and all objectives."""

from muster_studies.allocators.study import Allocators

__all__ = ["Allocators"]
