"""Reading of Muster's own files, missions, plans, orders and travel tables; plain data becomes a consistent mission."""
