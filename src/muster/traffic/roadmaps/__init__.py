"""Roadmaps: points and lanes that robots share, from free space or from the lanes of a mission, and their doors."""
