"""Disturbed traffic: robots that stop in narrow places and come back, while tasks come and go."""
