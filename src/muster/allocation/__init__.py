"""Allocation of tasks to robots, in an order: one algorithm a file, behind one interface."""
