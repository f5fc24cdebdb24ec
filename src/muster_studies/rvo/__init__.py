"""Collision avoidance of [tcf-thesis], appendices A3 and A6.2, with RVO, HRVO, ORCA and AVO side by side."""
