"""Conformance of fleets: whether an adapter does what Muster expects of robots, clause by clause.

`python -m muster_robots.conformance MODULE[:NAME]` tests an adapter; see docs/your-own-robots.md.
"""
