"""Bridges to real robots. Each has its own extra, needed when it is used; `fleet` has the common interface."""
