"""Drones flown rotor by rotor beside published parameters, and beside the published equations integrated apart."""
