"""Blockages: proofs that robots cannot get past each other, and rings of robots at rest that close others out."""
