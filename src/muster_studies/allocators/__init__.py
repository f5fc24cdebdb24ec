"""All allocators on all shipped missions and all objectives."""
