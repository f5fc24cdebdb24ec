"""Files of ground stations: QGroundControl plans, read and written, and way points as text, read."""
