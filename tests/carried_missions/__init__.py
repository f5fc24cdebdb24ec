"""Missions with goods and energy, and the best of all their plans, without muster's own planner and judge."""
