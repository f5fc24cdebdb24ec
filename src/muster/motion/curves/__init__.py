"""Curves of cubic Bezier segments, and corners of a path rounded into them ([market-paper], section 3.2.3)."""
