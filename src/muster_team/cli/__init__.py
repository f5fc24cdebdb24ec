"""The verb `auction`."""
