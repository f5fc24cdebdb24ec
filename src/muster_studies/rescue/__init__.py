"""[market-paper], sections 4.2 to 6: its search and rescue scenario carried out."""
