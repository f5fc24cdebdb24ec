"""Doors to real robots and their tools. Each asks for its own extra when it is used; `fleet` has what all are."""
