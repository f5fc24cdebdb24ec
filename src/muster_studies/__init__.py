"""Published experiments, repeated beside their published numbers; and benchmarks. Every own number is the judge's."""
