"""How messages reach other robots: their encoding, encryption, replay protection, and the transports."""
