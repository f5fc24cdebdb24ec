"""What a robot's process knows and states: the protocol's messages, facts, declarations, and the base of an epoch."""
