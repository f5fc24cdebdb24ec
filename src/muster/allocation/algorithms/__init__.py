"""Published ways to make routes: greedy, genetic, hill climbing and their combinations, re-wiring and insertion."""
