"""Replanning: the mission as it stands becomes a problem, and its solution replaces the routes under way."""
