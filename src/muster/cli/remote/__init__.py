"""Verbs that a server does (`--server URL`): a file a verb, each with a `run`.

The mission is read here, as without a server, and sent with the files that it names; what comes back is printed by the
functions that print it without one.
"""
