"""Carrying out a mission without a central planner: one process per robot, which negotiates and executes its tasks."""
