"""Figures of docs/negotiation.md: time and cost of agreement in a simulated network, and false suspicions."""
