"""What agreeing without a centre costs, how good its plans are, and how long it takes after faults."""
