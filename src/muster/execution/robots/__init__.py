"""One robot during execution: its state, energy, station visits and orders, the motion of its task, its monitor."""
