"""The compiled mission: what a plan must hold, as a few primitives that every interpreter reads; one rule a file."""
