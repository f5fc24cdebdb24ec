"""Pictures from above: the map, routes of a plan, tracks of a recorded mission, one path, a roadmap."""
