"""A simulated drone with an autopilot, sans-I/O: its motion, its position on Earth, its configurable faults."""
