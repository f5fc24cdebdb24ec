"""Allocators of the literature that others outrank, as docs/allocators.md reviews them; one algorithm a file."""
