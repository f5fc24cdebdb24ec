"""Missions of the field's benchmarks: published instances, and random ones after published generators."""
