"""Names of the ways in which traffic is managed."""

AUTO, FREE, RESERVE = TRAFFIC = ("auto", "free", "reserve")
"""`reserve` where the map has passages for one, else `free`; as robots meet; in the order of one plan for all."""
DEFAULT = AUTO
