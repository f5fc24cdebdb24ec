"""Bridges to real robots, as fleets. Each has its own extra, needed when it is used; `opening` opens each of them."""
