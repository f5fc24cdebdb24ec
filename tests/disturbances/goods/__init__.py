"""Disturbed missions with goods, batteries and stations, in the kinematic world."""
