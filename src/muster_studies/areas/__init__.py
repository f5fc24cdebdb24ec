"""Ways over areas beside a lower bound, beside spanning trees, and shared among robots."""
