"""Agreement without a centre: its cost, the quality of its plans, and its time after faults."""
