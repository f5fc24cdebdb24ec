"""Real sealed messages of every kind, mutated and sealed anew, at robots in every phase, through the real entrance."""
