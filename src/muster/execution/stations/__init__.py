"""Energy and stations: low batteries, which station serves whom, and the queue for its slots."""
