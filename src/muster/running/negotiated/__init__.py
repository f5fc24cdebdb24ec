"""A mission carried out without a centre: each robot is a process that agrees with the others, and acts for itself.

Here negotiation, execution and simulation meet, which do not know each other.
"""
