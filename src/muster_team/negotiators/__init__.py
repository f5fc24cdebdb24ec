"""One robot's part in the protocol, sans-I/O: the negotiator, the methods that make it, and the plan that follows."""
