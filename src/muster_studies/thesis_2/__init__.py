"""The alternatives that [tcf-thesis], section 2, reviews, measured beside its verdicts."""
