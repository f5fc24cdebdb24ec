"""What robots see: cameras, tags, points of interest."""
