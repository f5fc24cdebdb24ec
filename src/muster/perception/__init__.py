"""What robots see: cameras, tags, points of interest, laser landmarks, filters."""
