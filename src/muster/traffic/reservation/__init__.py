"""Traffic by reservation: robots pass in the order of one plan, each sent by its port as far as it may go."""
