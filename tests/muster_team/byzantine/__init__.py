"""One robot of a team states, well sealed, what is not so: mutated messages of its own, and lies of all kinds."""
