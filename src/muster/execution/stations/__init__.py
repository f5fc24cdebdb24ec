"""Energy and stations: who runs low, which station serves whom, and the queue for its slots."""
