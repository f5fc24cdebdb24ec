"""Comparisons: many allocators on many missions, judged runs kept as they come, and what statistics say of them."""
