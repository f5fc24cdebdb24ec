"""Robots that hold each other up: waits in traffic, jams, teams that stand still, detours, and the last resorts."""
