"""Which robots take part: their identities, the failure detector, stalled members, and how far each has come."""
