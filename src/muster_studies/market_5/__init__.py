"""[market-paper], sections 4.2, 4.3 and 5: three robots with lasers search an arena and track their paths."""
