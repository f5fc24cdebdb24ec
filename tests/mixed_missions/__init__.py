"""Tiny missions with rules of every kind at once, and the best of all their plans by the independent judge."""
