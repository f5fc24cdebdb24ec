"""Values beside the plain types: times, batteries by time or length, arrays; checks of what callers give, and help."""
