"""Areas of tasks: their places, what is wrong with their polygons, and tasks whose area is split among robots."""
