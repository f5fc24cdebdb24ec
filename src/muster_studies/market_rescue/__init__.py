"""[market-paper], sections 4 and 5: its search and rescue scenario, and a richer one."""
