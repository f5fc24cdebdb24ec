"""Runs with real robots whose Muster is killed at random moments, in simulated time, and goes on by its journal."""
