"""Random missions under all rules at once, planned, judged, bounded and, where they are small, planned in every way."""
